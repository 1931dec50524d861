//! Live video beside a flight.
//!
//! It has a thread and a socket of its own and no access to the flight, so that nothing in the stream can affect the tick.
//! Nothing is decoded: browsers and the flight log take the pictures as the drone encoded them. The drone is only asked to
//! stream while somebody watches or records.

mod export;

use std::io;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use ardrone_link::video::{Picture, VideoEvent};
use ardrone_link::{VideoNews, VideoStream};
use tokio::sync::{broadcast, oneshot};

pub use self::export::{ExportError, Exported, export};
use crate::recording::VideoRecorder;

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

/// The video's thread, which ends when this is dropped.
#[derive(Debug)]
pub struct Video {
    feed: VideoFeed,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Video {
    /// Starts the thread for the drone at this address; with a recorder all pictures are recorded.
    ///
    /// # Errors
    /// The system's error if there can be no thread.
    pub fn start(host: &str, port: u16, recorder: Option<VideoRecorder>) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let feed = VideoFeed { sender: broadcast::Sender::new(BEHIND) };
        let (end, ended) = oneshot::channel();
        let (sender, host) = (feed.sender.clone(), host.to_owned());
        let thread = std::thread::Builder::new().name("video".to_owned()).spawn(move || {
            runtime.block_on(async {
                tokio::select! {
                    () = pass_on(&host, port, &sender, recorder) => {}
                    // The flight has ended.
                    _ = ended => {}
                }
            });
        })?;
        Ok(Self { feed, end: Some(end), thread: Some(thread) })
    }

    /// For viewers.
    pub fn feed(&self) -> VideoFeed {
        self.feed.clone()
    }
}

impl Drop for Video {
    fn drop(&mut self) {
        if let Some(end) = self.end.take() {
            // The thread may have ended already.
            _ = end.send(());
        }
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the thread of the video panicked");
        }
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
