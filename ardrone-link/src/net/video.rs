//! The video stream on a socket.

use std::io;
use std::time::Duration;

use tokio::net::TcpStream;
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep};

use crate::video::{Input, Output, Picture, VideoEvent, VideoSession};

/// Time between two looks at the clock.
const LOOK: Duration = Duration::from_millis(100);
/// Bytes read at once: several pictures.
const READ_BYTES: usize = 64 << 10;

/// What comes from the stream.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum VideoNews {
    /// A picture that can be shown after all those before it.
    Picture(Picture),
    /// The stream began, or was lost; it is tried again for ever.
    Event(VideoEvent),
}

/// The drone's live video: connects, reconnects and resynchronises by itself.
///
/// Whoever falls behind should keep what waits in a [`Watching`](crate::video::Watching): nothing is left out here.
#[derive(Debug)]
pub struct VideoStream {
    host: String,
    port: u16,
    session: VideoSession,
    start: Instant,
    connection: Connection,
    buffer: Vec<u8>,
}

#[derive(Debug)]
enum Connection {
    None,
    Opening(JoinHandle<io::Result<TcpStream>>),
    Open(TcpStream),
}

impl VideoStream {
    /// A stream of the drone at this host; the usual port is [`VIDEO_PORT`](crate::VIDEO_PORT). It connects in
    /// [`Self::next`].
    pub fn new(host: impl Into<String>, port: u16) -> Self {
        Self {
            host: host.into(),
            port,
            session: VideoSession::default(),
            start: Instant::now(),
            connection: Connection::None,
            buffer: vec![0; READ_BYTES],
        }
    }

    /// What comes next. Nothing is lost if the future is dropped.
    ///
    /// # Panics
    /// Outside of a tokio runtime.
    pub async fn next(&mut self) -> VideoNews {
        loop {
            while let Some(output) = self.session.poll() {
                match output {
                    Output::Open => self.open(),
                    Output::Close => self.close(),
                    Output::Picture(picture) => return VideoNews::Picture(picture),
                    Output::Event(event) => return VideoNews::Event(event),
                }
            }
            self.wait().await;
        }
    }

    /// Pictures that could not be shown, because one that they depend on is missing.
    pub fn left_out(&self) -> u64 {
        self.session.left_out()
    }

    fn open(&mut self) {
        let (host, port) = (self.host.clone(), self.port);
        let opening = async move { TcpStream::connect((host, port)).await };
        self.connection = Connection::Opening(tokio::spawn(opening));
    }

    fn close(&mut self) {
        if let Connection::Opening(opening) = &self.connection {
            opening.abort();
        }
        self.connection = Connection::None;
    }

    /// Waits for the connection or for the time, and tells the session.
    async fn wait(&mut self) {
        let opened = match &mut self.connection {
            Connection::None => {
                sleep(LOOK).await;
                None
            }
            Connection::Opening(opening) => tokio::select! {
                opened = opening => Some(opened),
                () = sleep(LOOK) => None,
            },
            Connection::Open(stream) => {
                // An error is seen when reading.
                _ = tokio::time::timeout(LOOK, stream.readable()).await;
                None
            }
        };
        let now = self.start.elapsed();
        match opened {
            Some(Ok(Ok(stream))) => {
                self.connection = Connection::Open(stream);
                self.session.handle(now, Input::Opened);
            }
            // Refused, or the task ended.
            Some(_) => self.closed(now),
            None => self.read(now),
        }
    }

    fn read(&mut self, now: Duration) {
        let Connection::Open(stream) = &self.connection else {
            return self.session.handle(now, Input::Tick);
        };
        match stream.try_read(&mut self.buffer) {
            Ok(0) => self.closed(now),
            Ok(length) => {
                let bytes = self.buffer.get(..length).unwrap_or_default();
                self.session.handle(now, Input::Received(bytes));
            }
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                self.session.handle(now, Input::Tick);
            }
            Err(_) => self.closed(now),
        }
    }

    fn closed(&mut self, now: Duration) {
        self.connection = Connection::None;
        self.session.handle(now, Input::Closed);
    }
}

impl Drop for VideoStream {
    fn drop(&mut self) {
        self.close();
    }
}

#[cfg(test)]
mod tests {
    use tokio::io::AsyncWriteExt as _;
    use tokio::net::TcpListener;

    use super::*;

    const LONG: &[u8] = include_bytes!("../../../tests/fixtures/video/pave.bin");

    async fn numbers(stream: &mut VideoStream, count: usize) -> Vec<u32> {
        let mut found = Vec::new();
        while found.len() < count {
            if let VideoNews::Picture(picture) = stream.next().await {
                found.push(picture.header.number);
            }
        }
        found
    }

    #[tokio::test]
    async fn a_stream_is_read_and_read_again_after_its_end() {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        let server = tokio::spawn(async move {
            for _ in 0..2 {
                let (mut stream, _) = listener.accept().await.unwrap();
                for part in LONG.chunks(1000) {
                    stream.write_all(part).await.unwrap();
                }
            }
        });
        let mut stream = VideoStream::new("127.0.0.1", port);
        let expected: Vec<u32> = (17_565..=17_581).collect();
        assert_eq!(stream.next().await, VideoNews::Event(VideoEvent::Begun));
        assert_eq!(numbers(&mut stream, 17).await, expected);
        assert_eq!(stream.next().await, VideoNews::Event(VideoEvent::Lost));
        assert_eq!(stream.next().await, VideoNews::Event(VideoEvent::Begun));
        assert_eq!(numbers(&mut stream, 17).await, expected);
        assert_eq!(stream.left_out(), 6);
        server.await.unwrap();
    }

    #[tokio::test]
    async fn a_drone_that_is_not_there_is_waited_for() {
        // A port that was free a moment ago.
        let port = TcpListener::bind("127.0.0.1:0").await.unwrap().local_addr().unwrap().port();
        let mut stream = VideoStream::new("127.0.0.1", port);
        let next = tokio::time::timeout(Duration::from_millis(300), stream.next());
        assert!(next.await.is_err());
    }
}
