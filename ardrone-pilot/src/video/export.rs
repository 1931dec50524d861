//! A recorded flight's video as a file that any player shows, without encoding it again.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;

use muxide::api::{MuxerBuilder, MuxerError, VideoCodec};

use crate::recording::{LogError, RecordedPicture, pictures};
use crate::whole_file;

/// Why there is no file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The log cannot be read.
    #[error(transparent)]
    Log(#[from] LogError),
    /// It has no video, or only one picture.
    #[error("the flight log has no video: record one with --record-video")]
    NoVideo,
    /// The ending says no format that is known.
    #[error("{path}: unknown format; write to a file that ends in .mp4 or .h264")]
    Format {
        /// The file.
        path: String,
    },
    /// The file cannot be written.
    #[error("cannot write {path}")]
    Write {
        /// The file.
        path: String,
        /// The system's error.
        source: std::io::Error,
    },
    /// The pictures do not make a film.
    #[error("the video cannot be written as MP4")]
    Mp4(#[source] MuxerError),
}

/// What was written.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Exported {
    /// Number of pictures.
    pub pictures: usize,
    /// Time from the first to the last.
    pub seconds: f64,
}

/// Writes the video of a log, given as bytes, to a file: MP4, or H.264 alone, by its ending.
///
/// # Errors
/// [`ExportError`]; a file that was begun is removed.
pub fn export(log: &[u8], path: &Path) -> Result<Exported, ExportError> {
    let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_lowercase);
    let write = match ending.as_deref() {
        Some("mp4") => write_mp4,
        Some("h264" | "264") => write_stream,
        _ => return Err(ExportError::Format { path: path.display().to_string() }),
    };
    let pictures = pictures(log)?;
    let [first, .., last] = pictures.as_slice() else { return Err(ExportError::NoVideo) };
    let exported = Exported {
        pictures: pictures.len(),
        seconds: last.at.saturating_sub(first.at).as_secs_f64(),
    };
    let failed = |source| ExportError::Write { path: path.display().to_string(), source };
    let draft = whole_file::draft(path).map_err(failed)?;
    write(BufWriter::new(draft.as_file()), &pictures, &failed)?;
    draft.persist(path).map_err(|error| failed(error.error))?;
    Ok(exported)
}

type Failed<'a> = &'a dyn Fn(std::io::Error) -> ExportError;

fn write_stream(
    mut file: BufWriter<&File>,
    pictures: &[RecordedPicture],
    failed: Failed<'_>,
) -> Result<(), ExportError> {
    for picture in pictures {
        file.write_all(&picture.data).map_err(failed)?;
    }
    file.flush().map_err(failed)
}

/// The time of a picture in the file is that of its arrival.
fn write_mp4(
    file: BufWriter<&File>,
    pictures: &[RecordedPicture],
    failed: Failed<'_>,
) -> Result<(), ExportError> {
    /// The drone's pictures as they are shown.
    const SIZE: (u32, u32) = (640, 360);
    /// Used for the last picture only.
    const RATE: f64 = 30.0;
    /// Two pictures cannot have the same time.
    const LEAST_APART_S: f64 = 1e-3;
    let mp4 = |error| match error {
        MuxerError::Io(source) => failed(source),
        other => ExportError::Mp4(other),
    };
    let mut muxer = MuxerBuilder::new(file)
        .video(VideoCodec::H264, SIZE.0, SIZE.1, RATE)
        .with_fast_start(true)
        .build()
        .map_err(mp4)?;
    let start = pictures.first().map(|picture| picture.at).unwrap_or_default();
    let mut last: Option<f64> = None;
    for picture in pictures {
        let at = picture.at.saturating_sub(start).as_secs_f64();
        let at = last.map_or(at, |last| at.max(last + LEAST_APART_S));
        last = Some(at);
        muxer.write_video(at, &picture.data, picture.is_entry).map_err(mp4)?;
    }
    muxer.finish_in_place().map_err(mp4)?;
    // It does not flush what it was given.
    muxer.into_writer().flush().map_err(failed)
}
