//! Video for clients: pictures are rendered and encoded on a thread of their own, and only while somebody watches.

use std::io;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use tokio::io::AsyncWriteExt as _;
use tokio::net::TcpStream;
use tokio::sync::broadcast;
use tokio::sync::broadcast::error::RecvError;
use tokio::time::Instant;
use tracing::{debug, info, warn};

use crate::lies::Lies;
use crate::scenario::VideoFault;
use crate::video::{EncodedPicture, Scene, Sent, Spoiler, VideoEncoder, View};

/// Interval of the pictures.
const INTERVAL: Duration = Duration::from_micros(33_333);
/// Maximum number of clients; further ones are refused.
const CLIENTS: usize = 4;
/// Pictures that a client may fall behind before it loses all up to the next key picture.
const BEHIND: usize = 8;
/// A client that reads nothing for this time is disconnected.
const PATIENCE: Duration = Duration::from_secs(5);
/// Content of a TCP segment on Wi-Fi, and the time after which a lost one is sent again: the least retransmission timeout
/// of Linux, which the drone runs.
const SEGMENT_BYTES: usize = 1400;
const SENT_AGAIN: Duration = Duration::from_millis(200);
/// Greater losses would stop the stream for good.
const MOST_LOSS: f64 = 0.9;
/// Interval at which a client looks whether the link is back.
const LOOK: Duration = Duration::from_millis(50);

/// What the camera sees now, and how good the link is.
#[derive(Debug, Clone)]
pub(super) struct Sight {
    pub(super) view: View,
    pub(super) scene: Scene,
    /// Bit rate of the video.
    pub(super) kbit_s: u32,
    /// Fraction of packets that are lost.
    pub(super) loss: f64,
    /// Nothing arrives.
    pub(super) is_out: bool,
    /// What is wrong with the stream.
    pub(super) fault: Option<VideoFault>,
    /// What is wrong with its headers, always.
    pub(super) lies: Lies,
}

/// A picture, and when it was ready.
#[derive(Debug)]
struct Filmed {
    picture: EncodedPicture,
    at: Instant,
}

/// Sends the video to its clients.
#[derive(Debug)]
pub(super) struct VideoServer {
    sight: Arc<Mutex<Sight>>,
    pictures: broadcast::Sender<Arc<Filmed>>,
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl VideoServer {
    /// Starts the thread; the stream's time stamps count from `start`.
    pub(super) fn start(start: Instant, sight: Sight, shows_clock: bool) -> io::Result<Self> {
        let mut encoder =
            VideoEncoder::new(shows_clock.then(|| unix_ms(start))).map_err(io::Error::other)?;
        let sight = Arc::new(Mutex::new(sight));
        let pictures = broadcast::Sender::new(BEHIND);
        let (stop, stopped) = channel();
        let (seen, sender) = (Arc::clone(&sight), pictures.clone());
        let film = move || {
            let mut due = start.elapsed();
            loop {
                due = (due + INTERVAL).max(start.elapsed());
                match stopped.recv_timeout(due.saturating_sub(start.elapsed())) {
                    Err(RecvTimeoutError::Timeout) => {}
                    Ok(()) | Err(RecvTimeoutError::Disconnected) => return,
                }
                if sender.receiver_count() == 0 {
                    continue;
                }
                let Sight { view, scene, kbit_s, .. } = lock(&seen).clone();
                encoder.set_rate(kbit_s);
                match encoder.encode(start.elapsed(), &scene, &view) {
                    // A client may have gone meanwhile.
                    Ok(picture) => {
                        _ = sender.send(Arc::new(Filmed { picture, at: Instant::now() }));
                    }
                    Err(error) => return warn!("no more video: {error}"),
                }
            }
        };
        let thread = std::thread::Builder::new().name("mock-video".to_owned()).spawn(film)?;
        Ok(Self { sight, pictures, stop: Some(stop), thread: Some(thread) })
    }

    /// Whether somebody watches, so that [`Self::see`] has to be called.
    pub(super) fn is_watched(&self) -> bool {
        self.pictures.receiver_count() > 0
    }

    /// What the camera sees from now on.
    pub(super) fn see(&self, sight: Sight) {
        *lock(&self.sight) = sight;
    }

    /// Takes a client, unless what the camera sees now is cut.
    pub(super) fn connect(&self, stream: TcpStream, sight: Sight) {
        let is_cut = sight.fault == Some(VideoFault::Cut);
        // Nobody may have watched until now, so that the last one is old.
        self.see(sight);
        if is_cut {
            return;
        }
        if self.pictures.receiver_count() >= CLIENTS {
            return info!("a video client is refused: there are {CLIENTS} already");
        }
        let (pictures, sight) = (self.pictures.subscribe(), Arc::clone(&self.sight));
        tokio::spawn(async move {
            if let Err(error) = send(stream, pictures, &sight).await {
                debug!("video client disconnected: {error}");
            }
        });
    }
}

impl Drop for VideoServer {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the thread of the mock video panicked");
        }
    }
}

/// The time at `start` since 1970, of which a picture shows the lowest 32 bits.
#[allow(clippy::cast_possible_truncation, reason = "the highest bits are cut off")]
fn unix_ms(start: Instant) -> u32 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    now.saturating_sub(start.elapsed()).as_millis() as u32
}

fn lock(sight: &Mutex<Sight>) -> std::sync::MutexGuard<'_, Sight> {
    sight.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How many times in a row something of a picture is sent again, until all its segments have arrived.
///
/// With selective acknowledgement (SACK) the sender knows all gaps at once and fills them together: however many segments are
/// lost, the picture waits for one retransmission, and for another one only if one of those sent again is lost, too. It waits
/// from when the picture was first sent: later pictures are sent, and what they lost is sent again, while an earlier one is
/// awaited; TCP only delivers them in order.
///
/// The timeout is taken for all, which is the worst: a gap with three segments behind it is filled after a round trip, but
/// most pictures are hardly longer than that. That the timeout doubles when it is in vain, and that the window shrinks, is
/// left out: at 1 Mbit/s little more than a picture is on its way.
fn times_sent_again(segments: usize, loss: f64, random: &mut impl Rng) -> u32 {
    let loss = loss.clamp(0.0, MOST_LOSS);
    let mut lost = |sent: usize| (0..sent).filter(|_| random.random_bool(loss)).count();
    let mut missing = lost(segments);
    let mut times = 0;
    while missing > 0 {
        times += 1;
        missing = lost(missing);
    }
    times
}

/// Sends pictures from the next key picture on.
async fn send(
    mut stream: TcpStream,
    mut pictures: broadcast::Receiver<Arc<Filmed>>,
    sight: &Mutex<Sight>,
) -> io::Result<()> {
    let mut random = ChaCha8Rng::seed_from_u64(0);
    let mut spoiler = Spoiler::default();
    let mut joined = false;
    loop {
        let filmed = match pictures.recv().await {
            Ok(filmed) => filmed,
            Err(RecvError::Lagged(_)) => {
                joined = false;
                continue;
            }
            Err(RecvError::Closed) => return Ok(()),
        };
        let Filmed { picture, at } = &*filmed;
        joined |= picture.is_entry;
        if !joined {
            continue;
        }
        // TCP loses nothing: what is lost on the air comes late.
        let mut sent = *at;
        while lock(sight).is_out {
            tokio::time::sleep(LOOK).await;
            sent = Instant::now();
        }
        let segments = picture.bytes.len().div_ceil(SEGMENT_BYTES);
        let again = times_sent_again(segments, lock(sight).loss, &mut random);
        tokio::time::sleep_until(sent + SENT_AGAIN * again).await;
        let Sight { fault, lies, .. } = *lock(sight);
        match spoiler.spoil(picture, fault) {
            Sent::Bytes(bytes) => {
                let bytes = lies.spoil_picture(&bytes);
                tokio::time::timeout(PATIENCE, stream.write_all(&bytes)).await??;
            }
            Sent::Nothing => {}
            Sent::End => return Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean number of retransmissions in a row for pictures of this many segments.
    fn mean(segments: usize, loss: f64) -> f64 {
        const PICTURES: u32 = 20_000;
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let times = (0..PICTURES).map(|_| times_sent_again(segments, loss, &mut random));
        f64::from(times.sum::<u32>()) / f64::from(PICTURES)
    }

    #[test]
    fn the_losses_of_a_picture_are_made_up_for_together() {
        assert!(mean(10, 0.0) < 1e-9);
        // Of a single segment each loss follows the one before: p / (1 - p).
        assert!((mean(1, 0.1) - 1.0 / 9.0).abs() < 0.01);
        // The longest of ten such rows, which is the sum over n of 1 - (1 - p^n)^10; one after the other they would take 1.1.
        let expected: f64 = (1..20).map(|n| 1.0 - (1.0 - 0.1_f64.powi(n)).powi(10)).sum();
        assert!((mean(10, 0.1) - expected).abs() < 0.02, "{} {expected}", mean(10, 0.1));
        assert!(expected < 0.8);
        // Whatever is asked for, it ends.
        assert!(mean(1, 1.0).is_finite());
    }
}
