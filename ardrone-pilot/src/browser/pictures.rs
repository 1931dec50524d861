//! Pictures for one browser: it sees now, or nothing.

use std::sync::Arc;
use std::time::Duration;

use ardrone_link::video::{Picture, VideoEvent, Watching};
use axum::extract::ws::{Message, WebSocket};
use bytes::{BufMut as _, BytesMut};
use futures_util::{SinkExt as _, StreamExt as _};
use tokio::sync::broadcast::Receiver;
use tokio::sync::broadcast::error::{RecvError, TryRecvError};
use tokio::time::timeout;

use crate::video::{Shown, VideoFeed};

/// A browser that takes no picture for this time is disconnected.
const WRITE_TIME: Duration = Duration::from_secs(2);

/// Sends pictures until the flight ends or the page is gone.
///
/// Each message is binary: the drone's time stamp in milliseconds (32 bits, little-endian), whether a decoder can begin
/// with the picture (8 bits), and the picture. An empty message says that the stream is lost.
pub(super) async fn show(socket: WebSocket, feed: &VideoFeed) {
    let (mut sink, mut stream) = socket.split();
    let (mut receiver, mut watching) = (feed.subscribe(), Watching::default());
    loop {
        let message = tokio::select! {
            received = receiver.recv() => match next(&received, &mut receiver, &mut watching) {
                Ok(message) => message,
                Err(()) => break,
            },
            said = stream.next() => match said {
                // The page has nothing to say here.
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
                _ => break,
            },
        };
        let mut waiting = message;
        while let Some(message) = waiting {
            match timeout(WRITE_TIME, sink.send(message)).await {
                Ok(Ok(())) => {}
                Ok(Err(_)) | Err(_) => return,
            }
            // What came meanwhile may make the rest obsolete.
            drain(&mut receiver, &mut watching);
            waiting = watching.pop().as_ref().map(encoded);
        }
    }
    // The page may be gone already.
    _ = timeout(WRITE_TIME, sink.send(Message::Close(None))).await;
}

/// What to send after something was received; an error at the end of the flight.
fn next(
    received: &Result<Arc<Shown>, RecvError>,
    receiver: &mut Receiver<Arc<Shown>>,
    watching: &mut Watching,
) -> Result<Option<Message>, ()> {
    match received.as_deref() {
        Ok(Shown::Picture(picture)) => watching.push(picture.clone()),
        Ok(Shown::Event(VideoEvent::Lost)) => {
            return Ok(Some(Message::Binary(bytes::Bytes::new())));
        }
        Ok(Shown::Event(_)) => {}
        Err(RecvError::Lagged(_)) => watching.interrupt(),
        Err(RecvError::Closed) => return Err(()),
    }
    drain(receiver, watching);
    Ok(watching.pop().as_ref().map(encoded))
}

/// Takes everything that has come.
fn drain(receiver: &mut Receiver<Arc<Shown>>, watching: &mut Watching) {
    loop {
        match receiver.try_recv().as_deref() {
            Ok(Shown::Picture(picture)) => watching.push(picture.clone()),
            // A stream that was lost begins again with a picture that needs none before it.
            Ok(Shown::Event(_)) => {}
            Err(TryRecvError::Lagged(_)) => watching.interrupt(),
            Err(TryRecvError::Empty | TryRecvError::Closed) => return,
        }
    }
}

fn encoded(picture: &Picture) -> Message {
    let mut message = BytesMut::with_capacity(picture.payload.len() + 5);
    message.put_u32_le(u32::try_from(picture.header.time.as_millis()).unwrap_or(u32::MAX));
    message.put_u8(u8::from(picture.is_entry()));
    message.put_slice(&picture.payload);
    Message::Binary(message.freeze())
}
