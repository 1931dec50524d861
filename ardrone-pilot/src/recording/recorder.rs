//! Records a flight in progress.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use ardrone_link::video::Picture;
use crossbeam_channel::{Receiver, Sender, bounded, never, select_biased};
use mcap::McapError;

use super::{Header, LogWriter, Record};
use crate::drive::Passed;

/// Capacity of the queue to the writer: some seconds.
const WAITING: usize = 1024;
/// Number of reusable buffers, each large enough for any packet or datagram.
const BUFFERS: usize = 512;
const BUFFER_BYTES: usize = 4096;
/// Interval of flushing to disk.
const FLUSH: Duration = Duration::from_millis(500);
/// Pictures that may wait for the writer: two seconds.
const PICTURES: usize = 64;

/// Why recording could not start, or has stopped.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file cannot be created.
    #[error("cannot make the flight log {}", .path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// Writing the file failed.
    #[error("cannot write the flight log {}: {}; the flight goes on without it", .path.display(), reason(.problem))]
    Write {
        /// The file.
        path: PathBuf,
        /// The error.
        problem: McapError,
    },
    /// The thread cannot be started.
    #[error("cannot start the thread of the flight log: {0}")]
    Thread(std::io::Error),
}

/// The system's error, if there is one.
fn reason(error: &McapError) -> String {
    match error {
        McapError::Io(error) => error.to_string(),
        other => other.to_string(),
    }
}

/// Tick-side handle: takes records without ever waiting, and without allocating in flight.
#[derive(Debug)]
pub struct Recorder {
    records: Sender<Record>,
    buffers: Receiver<Vec<u8>>,
    lost: u64,
}

/// UI-side handle: write errors and completion.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    problems: Receiver<RecordingError>,
    thread: JoinHandle<Option<u64>>,
    start: Instant,
    pictures: Sender<Record>,
}

/// Video-side handle. It has a queue of its own, so that pictures never take the place of what the tick records.
#[derive(Debug)]
pub struct VideoRecorder {
    pictures: Sender<Record>,
    start: Instant,
    /// A picture was lost, and the next ones depend on it.
    waits_for_entry: bool,
}

impl VideoRecorder {
    /// Records a picture, or leaves out all up to the next one that a decoder can begin with if the disk is too slow.
    pub fn picture(&mut self, picture: &Picture) {
        if self.waits_for_entry && !picture.is_entry() {
            return;
        }
        let record = Record::Picture { at: self.start.elapsed(), picture: picture.payload.clone() };
        self.waits_for_entry = self.pictures.try_send(record).is_err();
    }
}

/// A finished log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recorded {
    /// Its file.
    pub path: PathBuf,
    /// Its size in bytes.
    pub bytes: u64,
}

impl Recorder {
    /// Starts recording to a new file; one that exists is not overwritten.
    ///
    /// # Errors
    /// [`RecordingError`] if the file exists, cannot be created or written, or there can be no thread.
    pub fn start(path: &Path, header: &Header) -> Result<(Self, Recording), RecordingError> {
        let create = |source| RecordingError::Create { path: path.to_owned(), source };
        // An existing log is not overwritten.
        let file = File::create_new(path).map_err(create)?;
        let problem = |source| RecordingError::Write { path: path.to_owned(), problem: source };
        let mut writer = LogWriter::new(BufWriter::new(file), header).map_err(problem)?;
        writer.flush().map_err(problem)?;
        let (records, received) = bounded(WAITING);
        let (give_back, buffers) = bounded(BUFFERS);
        for _ in 0..BUFFERS {
            // The channel has room for all buffers.
            _ = give_back.try_send(Vec::with_capacity(BUFFER_BYTES));
        }
        let (pictures, received_pictures) = bounded(PICTURES);
        let (report, problems) = bounded(1);
        let own = path.to_owned();
        let thread = std::thread::Builder::new()
            .name("flight log".to_owned())
            .spawn(move || write(writer, &own, &received, received_pictures, &give_back, &report))
            .map_err(RecordingError::Thread)?;
        let start = Instant::now();
        let recording = Recording { path: path.to_owned(), problems, thread, start, pictures };
        Ok((Self { records, buffers, lost: 0 }, recording))
    }

    /// A recorder with a stalled disk: nothing is ever written.
    #[cfg(test)]
    pub(crate) fn stalled() -> Self {
        let (records, waiting) = bounded(1);
        let (_, buffers) = bounded(0);
        // Leaks the receiver, so that the writer neither takes records nor disconnects.
        std::mem::forget(waiting);
        Self { records, buffers, lost: 0 }
    }

    /// Number of records dropped because the disk was too slow, without pictures.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// What passes a vehicle.
    pub fn pass(&mut self, at: Duration, passed: &Passed<'_>) {
        let mut is_full = false;
        let record = Record::of(at, passed, |bytes| {
            let filled = self.filled(bytes);
            is_full = filled.is_none();
            filled
        });
        self.lost += u64::from(is_full);
        if let Some(record) = record {
            self.record(record);
        }
    }

    /// Another event, as text.
    pub fn note(&mut self, at: Duration, text: String) {
        self.record(Record::Note { at, text });
    }

    /// A free buffer filled with `content`, if there is one.
    fn filled(&self, content: &[u8]) -> Option<Vec<u8>> {
        let mut buffer = self.buffers.try_recv().ok()?;
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
    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The error that stopped the recording; returned once.
    pub fn problem(&self) -> Option<RecordingError> {
        self.problems.try_recv().ok()
    }

    /// Records the video of the flight, too.
    pub fn video(&self) -> VideoRecorder {
        let pictures = self.pictures.clone();
        VideoRecorder { pictures, start: self.start, waits_for_entry: false }
    }

    /// Waits until the file is complete, which requires that the [`Recorder`] was dropped; `None` if writing
    /// failed.
    pub fn finish(self) -> Option<Recorded> {
        let bytes = self.thread.join().ok().flatten()?;
        Some(Recorded { path: self.path, bytes })
    }
}

/// Writes until the recorder is dropped; returns the size of the file.
fn write(
    writer: LogWriter<BufWriter<File>>,
    path: &Path,
    records: &Receiver<Record>,
    pictures: Receiver<Record>,
    give_back: &Sender<Vec<u8>>,
    report: &Sender<RecordingError>,
) -> Option<u64> {
    match write_all(writer, records, pictures, give_back) {
        Ok(bytes) => Some(bytes),
        Err(source) => {
            _ = report.try_send(RecordingError::Write { path: path.to_owned(), problem: source });
            // After an error the records are still received, because their buffers must be returned.
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
    mut pictures: Receiver<Record>,
    give_back: &Sender<Vec<u8>>,
) -> Result<u64, McapError> {
    let clock = Instant::now;
    let mut flushed = clock();
    loop {
        select_biased! {
            recv(records) -> record => match record {
                Ok(record) => {
                    writer.write(&record)?;
                    recycle(record, give_back);
                }
                Err(_) => break,
            },
            recv(pictures) -> picture => match picture {
                Ok(picture) => writer.write(&picture)?,
                // No video, or no more.
                Err(_) => pictures = never(),
            },
            default(FLUSH) => {}
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
        // The channel has room for all buffers.
        _ = give_back.try_send(buffer);
    }
}
