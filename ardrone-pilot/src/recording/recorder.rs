//! Records a flight while it lasts.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::vehicle::{Decision, FlightEvent, Operator, OperatorOrder};
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use mcap::McapError;

use super::messages::Timing;
use super::{Header, LogWriter, Record};

/// Entries that may wait for the disk: some seconds.
const WAITING: usize = 1024;
/// Buffers for packets and datagrams go round; each has room for any of them.
const BUFFERS: usize = 512;
const BUFFER_BYTES: usize = 4096;
/// After so long what was written is made safe.
const FLUSH: Duration = Duration::from_millis(500);

/// Why nothing is recorded, or not any more.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file cannot be made.
    #[error("cannot make the flight log {}", .path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// It cannot be written.
    #[error("cannot write the flight log {}: {}; the flight goes on without it", .path.display(), reason(.problem))]
    Write {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        problem: McapError,
    },
    /// The thread cannot be started.
    #[error("cannot start the thread of the flight log: {0}")]
    Thread(std::io::Error),
}

/// What the system says, where it says something.
fn reason(error: &McapError) -> String {
    match error {
        McapError::Io(error) => error.to_string(),
        other => other.to_string(),
    }
}

/// The end of the tick: takes entries and never waits, nor asks for memory in flight.
#[derive(Debug)]
pub struct Recorder {
    records: Sender<Record>,
    buffers: Receiver<Vec<u8>>,
    lost: u64,
}

/// The end of whoever watches.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    problems: Receiver<RecordingError>,
    thread: JoinHandle<Option<u64>>,
}

/// A log that was finished.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recorded {
    /// Its file.
    pub path: PathBuf,
    /// Its size.
    pub bytes: u64,
}

impl Recorder {
    /// Starts to record to a new file.
    ///
    /// # Errors
    /// [`RecordingError`] if the file cannot be made or written.
    pub fn start(path: &Path, header: &Header) -> Result<(Self, Recording), RecordingError> {
        let create = |source| RecordingError::Create { path: path.to_owned(), source };
        // A flight that is there already is not overwritten.
        let file = File::create_new(path).map_err(create)?;
        let problem = |source| RecordingError::Write { path: path.to_owned(), problem: source };
        let mut writer = LogWriter::new(BufWriter::new(file), header).map_err(problem)?;
        writer.flush().map_err(problem)?;
        let (records, received) = bounded(WAITING);
        let (give_back, buffers) = bounded(BUFFERS);
        for _ in 0..BUFFERS {
            // There is room for all of them.
            _ = give_back.try_send(Vec::with_capacity(BUFFER_BYTES));
        }
        let (report, problems) = bounded(1);
        let own = path.to_owned();
        let thread = std::thread::Builder::new()
            .name("flight log".to_owned())
            .spawn(move || write(writer, &own, &received, &give_back, &report))
            .map_err(RecordingError::Thread)?;
        let recording = Recording { path: path.to_owned(), problems, thread };
        Ok((Self { records, buffers, lost: 0 }, recording))
    }

    /// A recorder whose disk has stopped: nothing is ever written.
    #[cfg(test)]
    pub(crate) fn stalled() -> Self {
        let (records, waiting) = bounded(1);
        let (_, buffers) = bounded(0);
        // The writer hangs: it neither takes anything nor goes away.
        std::mem::forget(waiting);
        Self { records, buffers, lost: 0 }
    }

    /// Entries that the disk was too slow for.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// A datagram from the navdata port.
    pub fn navdata(&mut self, at: Duration, packet: &[u8]) {
        if let Some(packet) = self.filled(packet) {
            self.record(Record::Navdata { at, packet });
        }
    }

    /// Bytes from the control port.
    pub fn control(&mut self, at: Duration, bytes: &[u8]) {
        self.record(Record::Control { at, bytes: bytes.to_vec() });
    }

    /// An operator's order.
    pub fn order(&mut self, at: Duration, by: Operator, order: OperatorOrder) {
        self.record(Record::Order { at, by, order });
    }

    /// Something happened.
    pub fn event(&mut self, at: Duration, event: FlightEvent) {
        self.record(Record::Event { at, event });
    }

    /// How the flight ended.
    pub fn outcome(&mut self, at: Duration, outcome: Outcome) {
        self.record(Record::Outcome { at, outcome });
    }

    /// Something else to be read by people.
    pub fn note(&mut self, at: Duration, text: String) {
        self.record(Record::Note { at, text });
    }

    /// A tick.
    pub fn tick(&mut self, decision: Decision, timing: Timing, datagram: &[u8]) {
        if let Some(datagram) = self.filled(datagram) {
            self.record(Record::Tick { decision, timing, datagram });
        }
    }

    /// A buffer with this content, if one is free.
    fn filled(&mut self, content: &[u8]) -> Option<Vec<u8>> {
        let Ok(mut buffer) = self.buffers.try_recv() else {
            self.lost += 1;
            return None;
        };
        buffer.clear();
        buffer.extend_from_slice(content);
        Some(buffer)
    }

    fn record(&mut self, record: Record) {
        if self.records.try_send(record).is_err() {
            self.lost += 1;
        }
    }
}

impl Recording {
    /// What went wrong, told once.
    pub fn problem(&self) -> Option<RecordingError> {
        self.problems.try_recv().ok()
    }

    /// Waits for the end of the file, once the [`Recorder`] is gone; nothing if it has none.
    pub fn finish(self) -> Option<Recorded> {
        let bytes = self.thread.join().ok().flatten()?;
        Some(Recorded { path: self.path, bytes })
    }
}

/// Writes until there is nobody who records; returns the size of the file.
fn write(
    writer: LogWriter<BufWriter<File>>,
    path: &Path,
    records: &Receiver<Record>,
    give_back: &Sender<Vec<u8>>,
    report: &Sender<RecordingError>,
) -> Option<u64> {
    match write_all(writer, records, give_back) {
        Ok(bytes) => Some(bytes),
        Err(source) => {
            _ = report.try_send(RecordingError::Write { path: path.to_owned(), problem: source });
            // The flight goes on: its buffers must go round.
            for record in records {
                recycle(record, give_back);
            }
            None
        }
    }
}

fn write_all(
    mut writer: LogWriter<BufWriter<File>>,
    records: &Receiver<Record>,
    give_back: &Sender<Vec<u8>>,
) -> Result<u64, McapError> {
    let clock = std::time::Instant::now;
    let mut flushed = clock();
    loop {
        match records.recv_timeout(FLUSH) {
            Ok(record) => {
                writer.write(&record)?;
                recycle(record, give_back);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        if flushed.elapsed() >= FLUSH {
            writer.flush()?;
            flushed = clock();
        }
    }
    let file = writer.finish()?.into_inner().map_err(std::io::IntoInnerError::into_error)?;
    file.sync_all()?;
    Ok(file.metadata()?.len())
}

fn recycle(record: Record, give_back: &Sender<Vec<u8>>) {
    if let Record::Navdata { packet: buffer, .. } | Record::Tick { datagram: buffer, .. } = record {
        // There is room for all buffers.
        _ = give_back.try_send(buffer);
    }
}
