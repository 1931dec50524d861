//! The ports of a drone that is examined: [`ardrone_link::selftest`] on sockets.

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use ardrone_link::selftest::{Contact, Heard, Refusal};
use ardrone_link::{DroneAddress, WAKE_UP};
use bytes::Bytes;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;
use tokio::io::{AsyncBufReadExt as _, AsyncReadExt as _, AsyncWriteExt as _, BufReader};
use tokio::net::{TcpStream, UdpSocket};
use tokio::runtime::{Builder, Runtime};
use tokio::time::{Instant, sleep_until, timeout};

/// Why a drone could not be examined.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SelfTestError {
    /// A socket could not be opened, or a signal not be awaited.
    #[error("network")]
    Socket(#[source] io::Error),
    /// The drone is not in a state in which it is examined.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// Exit status after a second signal.
const CALLED_OFF: i32 = 130;
/// How long a TCP port may take to be connected, and a line of FTP to come.
const PATIENCE: Duration = Duration::from_secs(2);
/// Longer than any datagram of the drone.
const BUFFER_BYTES: usize = 4096;
/// A version is shorter.
const VERSION_BYTES: u64 = 256;
/// Rest after an error of a socket: nobody may listen yet.
const REST: Duration = Duration::from_millis(20);

/// A drone's ports, on sockets.
#[derive(Debug)]
pub struct Sockets {
    runtime: Runtime,
    start: Instant,
    at: UdpSocket,
    navdata: UdpSocket,
    control: Option<TcpStream>,
    control_address: SocketAddr,
    /// A command has been sent: before, nothing is connected.
    asked: bool,
    video: Option<TcpStream>,
    video_address: SocketAddr,
    ftp_address: SocketAddr,
    stopped: Arc<AtomicBool>,
}

impl Sockets {
    /// Opens them for the drone at `ip`, with the ports of `address`. A TCP port that refuses is a finding, not an error. From
    /// now on the first signal that would end the process calls the examination off.
    ///
    /// # Errors
    /// [`SelfTestError::Socket`] if the system has no sockets, or a signal cannot be awaited.
    pub fn open(
        ip: IpAddr,
        address: &DroneAddress,
        video_port: u16,
        ftp_port: u16,
    ) -> Result<Self, SelfTestError> {
        let stopped = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            // The second one ends the process at once.
            flag::register_conditional_shutdown(signal, CALLED_OFF, Arc::clone(&stopped))
                .and_then(|_| flag::register(signal, Arc::clone(&stopped)))
                .map_err(SelfTestError::Socket)?;
        }
        let runtime =
            Builder::new_current_thread().enable_all().build().map_err(SelfTestError::Socket)?;
        let at = |port| SocketAddr::new(ip, port);
        let opened = runtime.block_on(async {
            let commands = datagrams(at(address.at_port)).await?;
            let navdata = datagrams(at(address.navdata_port)).await?;
            Ok((commands, navdata, Instant::now()))
        });
        let (commands, navdata, start) = opened.map_err(SelfTestError::Socket)?;
        Ok(Self {
            runtime,
            start,
            at: commands,
            navdata,
            control: None,
            control_address: at(address.control_port),
            asked: false,
            video: None,
            video_address: at(video_port),
            ftp_address: at(ftp_port),
            stopped,
        })
    }
}

impl Contact for Sockets {
    fn now(&self) -> Duration {
        self.start.elapsed()
    }

    fn send(&mut self, datagram: &[u8]) {
        if !std::mem::replace(&mut self.asked, true) {
            self.control = self.runtime.block_on(connect(self.control_address)).ok();
        }
        // A lost one is repeated by who asks, as on the air.
        _ = self.runtime.block_on(self.at.send(datagram));
    }

    fn wake(&mut self) {
        _ = self.runtime.block_on(self.navdata.send(&WAKE_UP));
    }

    fn next(&mut self, until: Duration) -> Option<Heard> {
        let Self { runtime, start, navdata, control, video, .. } = self;
        let end = *start + until;
        runtime.block_on(async {
            let [mut datagram, mut text, mut pictures] = [[0_u8; BUFFER_BYTES]; 3];
            loop {
                tokio::select! {
                    biased;
                    () = sleep_until(end) => return None,
                    received = navdata.recv(&mut datagram) => match received {
                        Ok(length) => return Some(Heard::Navdata(copied(&datagram, length))),
                        Err(_) => tokio::time::sleep(REST.min(end - Instant::now())).await,
                    },
                    length = read(control, &mut text) => match length {
                        0 => *control = None,
                        length => return Some(Heard::Control(copied(&text, length))),
                    },
                    length = read(video, &mut pictures) => match length {
                        0 => *video = None,
                        length => return Some(Heard::Video(copied(&pictures, length))),
                    },
                }
            }
        })
    }

    fn watch(&mut self) -> bool {
        self.video = self.runtime.block_on(connect(self.video_address)).ok();
        self.video.is_some()
    }

    fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    fn version(&mut self) -> Option<Result<String, String>> {
        let read = self.runtime.block_on(version(self.ftp_address));
        Some(read.map_err(|error| error.to_string()))
    }
}

fn copied(buffer: &[u8], length: usize) -> Bytes {
    Bytes::copy_from_slice(buffer.get(..length).unwrap_or_default())
}

/// Reads from a stream; 0 if it has ended. Pending for ever without one.
async fn read(stream: &mut Option<TcpStream>, buffer: &mut [u8]) -> usize {
    match stream {
        Some(stream) => stream.read(buffer).await.unwrap_or_default(),
        None => std::future::pending().await,
    }
}

async fn connect(address: SocketAddr) -> io::Result<TcpStream> {
    timeout(PATIENCE, TcpStream::connect(address)).await?
}

/// A connected socket: the system drops datagrams from any other address.
async fn datagrams(drone: SocketAddr) -> io::Result<UdpSocket> {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).await?;
    socket.connect(drone).await?;
    Ok(socket)
}

/// The content of `version.txt` on an FTP server.
async fn version(server: SocketAddr) -> io::Result<String> {
    let mut stream = BufReader::new(connect(server).await?);
    answer(&mut stream, "220").await?;
    // Some servers ask for no password.
    if ask(&mut stream, "USER anonymous", "").await?.starts_with("331") {
        ask(&mut stream, "PASS pilot", "230").await?;
    }
    let passive = ask(&mut stream, "PASV", "227").await?;
    let port = passive_port(&passive)
        .ok_or_else(|| io::Error::other(format!("no port in `{}`", passive.trim())))?;
    // The connection for the content is to the same host, whatever the server takes its own address for.
    let content = connect(SocketAddr::new(server.ip(), port)).await?;
    ask(&mut stream, "RETR version.txt", "150").await?;
    let mut text = String::new();
    timeout(PATIENCE, content.take(VERSION_BYTES).read_to_string(&mut text)).await??;
    Ok(text)
}

async fn ask(
    stream: &mut BufReader<TcpStream>,
    command: &str,
    expected: &str,
) -> io::Result<String> {
    stream.get_mut().write_all(format!("{command}\r\n").as_bytes()).await?;
    answer(stream, expected).await
}

/// A line of FTP, which must begin with this number.
async fn answer(stream: &mut BufReader<TcpStream>, expected: &str) -> io::Result<String> {
    let mut line = String::new();
    timeout(PATIENCE, stream.take(VERSION_BYTES).read_line(&mut line)).await??;
    if line.starts_with(expected) {
        return Ok(line);
    }
    Err(io::Error::other(format!("the FTP server says `{}`", line.trim())))
}

/// The port in `227 Entering Passive Mode (127,0,0,1,PORT / 256,PORT % 256)`.
fn passive_port(line: &str) -> Option<u16> {
    let (_, numbers) = line.split_once('(')?;
    let (numbers, _) = numbers.split_once(')')?;
    let mut numbers = numbers.split(',').skip(4).map(|number| number.trim().parse::<u8>().ok());
    let (Some(Some(high)), Some(Some(low)), None) =
        (numbers.next(), numbers.next(), numbers.next())
    else {
        return None;
    };
    Some(u16::from_be_bytes([high, low]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_port_of_a_passive_server_is_read() {
        assert_eq!(passive_port("227 Entering Passive Mode (192,168,1,1,20,10)\r\n"), Some(5130));
        for line in [
            "227 ok",
            "227 (1,2,3,4,5)",
            "227 (1,2,3,4,5,6,7)",
            "227 (1,2,3,4,500,6)",
            "227 (,,,,,)",
        ] {
            assert_eq!(passive_port(line), None, "{line}");
        }
    }
}
