//! The true state as CSV: one row every 20 ms.

use std::io::{self, Write};
use std::time::Duration;

use crate::firmware::Phase;
use crate::world::World;

/// Time between two rows.
const PERIOD: Duration = Duration::from_millis(20);

/// Writes the true state of a world.
#[derive(Debug)]
#[must_use = "the log is written by `record`"]
pub struct TruthLog<W: Write> {
    writer: csv::Writer<W>,
    next: Duration,
}

impl<W: Write> TruthLog<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn new(writer: W) -> io::Result<Self> {
        let mut writer = csv::Writer::from_writer(writer);
        writer.write_record([
            "time_s",
            "phase",
            "x_m",
            "y_m",
            "z_m",
            "velocity_x_m_s",
            "velocity_y_m_s",
            "velocity_z_m_s",
            "yaw_deg",
            "odometry_x_m",
            "odometry_y_m",
            "battery_percent",
        ])?;
        Ok(Self { writer, next: Duration::ZERO })
    }

    /// Writes a row if one is due.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn record(&mut self, world: &World) -> io::Result<()> {
        let truth = world.truth();
        if truth.time < self.next {
            return Ok(());
        }
        self.next = truth.time + PERIOD;
        let phase = match truth.phase {
            Phase::Landed => "landed",
            Phase::TakingOff { .. } => "taking off",
            Phase::Flying => "flying",
            Phase::Landing => "landing",
            Phase::Emergency => "emergency",
        };
        let mut row = vec![format!("{:.4}", truth.time.as_secs_f64()), phase.to_owned()];
        let numbers = truth
            .position_m
            .iter()
            .chain(&truth.velocity_m_s)
            .chain(&[truth.yaw_deg])
            .chain(&truth.odometry_m)
            .chain(&[world.drone().battery_percent()])
            .map(|number| format!("{number:.4}"))
            .collect::<Vec<_>>();
        row.extend(numbers);
        self.writer.write_record(row)?;
        Ok(())
    }

    /// Flushes buffered rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::WorldConfig;

    #[test]
    fn rows_come_every_twenty_milliseconds() {
        let mut world = World::new(&WorldConfig::default());
        let mut log = TruthLog::new(Vec::new()).unwrap();
        for step in 0..=40 {
            world.advance(Duration::from_millis(5) * step);
            log.record(&world).unwrap();
        }
        log.flush().unwrap();
        let text = String::from_utf8(log.writer.into_inner().unwrap()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 12);
        assert!(lines[0].starts_with("time_s,phase,x_m"));
        assert_eq!(
            lines[2],
            "0.0200,landed,0.0000,0.0000,0.0000,0.0000,0.0000,0.0000,0.0000,0.0000,0.0000,90.0000"
        );
    }
}
