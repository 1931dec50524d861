//! The way that a drone needs to come to rest: computed once, for whoever asks.

/// How a drone comes to rest: it goes on for a while, then decelerates evenly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stopping {
    /// Time before it brakes.
    pub(crate) delay_s: f64,
    /// Its deceleration, positive.
    pub(crate) braking_m_s2: f64,
}

impl Stopping {
    /// What every airframe reaches, also against the wind: for orders that have time to stop early.
    pub(crate) const CAUTIOUS: Self = Self { delay_s: super::REACTION_S, braking_m_s2: 0.6 };

    /// The way to rest from this speed, in its direction.
    pub(crate) fn way_m(self, speed_m_s: f64) -> f64 {
        speed_m_s * self.delay_s + speed_m_s * speed_m_s.abs() / (2.0 * self.braking_m_s2)
    }

    /// The largest speed from which it comes to rest within a distance.
    pub(crate) fn speed_m_s(self, room_m: f64) -> f64 {
        let delay_m_s = self.braking_m_s2 * self.delay_s;
        (delay_m_s * delay_m_s + 2.0 * self.braking_m_s2 * room_m.max(0.0)).sqrt() - delay_m_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_speed_needs_the_whole_room() {
        for room_m in [0.0, 0.1, 2.0] {
            let speed_m_s = Stopping::CAUTIOUS.speed_m_s(room_m);
            assert!((Stopping::CAUTIOUS.way_m(speed_m_s) - room_m).abs() < 1e-9);
            assert!((Stopping::CAUTIOUS.way_m(-speed_m_s) + room_m).abs() < 1e-9);
        }
    }
}
