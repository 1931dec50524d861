//! The live video.

use std::time::Duration;

use super::contact::{Contact, Examiner, Meanwhile};
use super::report::{Assumption, Findings, Outcome};
use crate::video::{Codec, Picture, Reader, Size};

/// How long pictures are watched.
const WATCHED: Duration = Duration::from_secs(4);
const EXPECTED: Size = Size { width: 640, height: 360 };

pub(super) fn pictures(drone: &mut Examiner<'_, impl Contact>, report: &mut Findings<'_>) {
    if !drone.contact.watch() {
        let why = "the video port is not reached".to_owned();
        return report.add(Assumption::Video, Outcome::NotAsked(why));
    }
    let window = drone.listen(WATCHED, Meanwhile::Present);
    let mut reader = Reader::default();
    let mut pictures: Vec<Picture> = Vec::new();
    for bytes in &window.video {
        reader.push(bytes);
        pictures.extend(std::iter::from_fn(|| reader.next()));
    }
    let mut wrong = Vec::new();
    let shown = pictures.iter().map(|picture| picture.header);
    if let Some(header) = shown.clone().find(|header| header.codec != Codec::H264) {
        wrong.push(format!("the codec is {:?}", header.codec));
    }
    if let Some(header) = shown.clone().find(|header| header.shown != EXPECTED) {
        wrong.push(format!("a picture has {} x {}", header.shown.width, header.shown.height));
    }
    if reader.garbage_bytes() > 0 {
        wrong.push(format!("{} bytes belong to no picture", reader.garbage_bytes()));
    }
    let times: Vec<f64> = shown.map(|header| header.time.as_secs_f64()).collect();
    let rate_hz = match (times.first(), times.last(), u32::try_from(times.len())) {
        (Some(first), Some(last), Ok(count)) if last > first => {
            f64::from(count - 1) / (last - first)
        }
        _ => 0.0,
    };
    if !pictures.iter().any(Picture::is_entry) {
        wrong.push(format!(
            "{} pictures came, none of which a decoder could begin with",
            pictures.len()
        ));
    } else if !(10.0..=35.0).contains(&rate_hz) {
        wrong.push(format!("{rate_hz:.1} pictures a second"));
    }
    report.judge_all(
        Assumption::Video,
        wrong,
        format!("{} pictures, {rate_hz:.1} a second", pictures.len()),
    );
}
