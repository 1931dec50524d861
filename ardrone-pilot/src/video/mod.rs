//! Live video beside a flight.
//!
//! It has a socket of its own and no access to the flight, so that nothing in the stream can affect the tick.
//! Nothing is decoded: browsers and the flight log take the pictures as the drone encoded them. The drone is only asked to
//! stream while somebody watches or records.

mod export;

use std::sync::Arc;
use std::time::Duration;

use ardrone_link::video::{Picture, VideoEvent};
use ardrone_link::{VideoNews, VideoStream};
use tokio::sync::broadcast;

pub use self::export::{ExportError, Exported, export};
use crate::recording::VideoRecorder;
use crate::runtime::{Background, Runtime};

/// Pictures that a viewer may fall behind before it continues with the newest key picture: two seconds.
const BEHIND: usize = 64;
/// Interval at which a stream that nobody watches looks for viewers.
const LOOK: Duration = Duration::from_millis(100);

/// What viewers get.
#[derive(Debug, Clone)]
pub enum Shown {
    /// A picture.
    Picture(Picture),
    /// The stream began or was lost.
    Event(VideoEvent),
}

/// Gives viewers their pictures.
#[derive(Debug, Clone)]
pub struct VideoFeed {
    sender: broadcast::Sender<Arc<Shown>>,
}

impl VideoFeed {
    /// Everything from now on; the stream is kept up as long as somebody receives.
    pub fn subscribe(&self) -> broadcast::Receiver<Arc<Shown>> {
        self.sender.subscribe()
    }
}

/// Reads the video until this is dropped.
#[derive(Debug)]
pub struct Video {
    feed: VideoFeed,
    _reading: Background,
}

impl Video {
    /// Begins to read it from the drone at this address; with a recorder all pictures are recorded.
    pub fn start(
        runtime: &Runtime,
        host: &str,
        port: u16,
        recorder: Option<VideoRecorder>,
    ) -> Self {
        let feed = VideoFeed { sender: broadcast::Sender::new(BEHIND) };
        let (sender, host) = (feed.sender.clone(), host.to_owned());
        let reading = runtime.spawn(async move { pass_on(&host, port, &sender, recorder).await });
        Self { feed, _reading: reading }
    }

    /// For viewers.
    pub fn feed(&self) -> VideoFeed {
        self.feed.clone()
    }
}

/// Never returns.
async fn pass_on(
    host: &str,
    port: u16,
    viewers: &broadcast::Sender<Arc<Shown>>,
    mut recorder: Option<VideoRecorder>,
) {
    loop {
        if recorder.is_none() && viewers.receiver_count() == 0 {
            tokio::time::sleep(LOOK).await;
            continue;
        }
        let mut stream = VideoStream::new(host, port);
        while recorder.is_some() || viewers.receiver_count() > 0 {
            let Ok(news) = tokio::time::timeout(LOOK, stream.next()).await else { continue };
            let shown = match news {
                VideoNews::Picture(picture) => {
                    if let Some(recorder) = &mut recorder {
                        recorder.picture(&picture);
                    }
                    Shown::Picture(picture)
                }
                VideoNews::Event(event) => Shown::Event(event),
                // What may come later is nothing to show.
                _ => continue,
            };
            // Perhaps nobody watches.
            _ = viewers.send(Arc::new(shown));
        }
    }
}
