//! Slow services beside the flight: signals and the control port.

use std::net::SocketAddr;
use std::task::{Context, Poll};
use std::thread::JoinHandle;
use std::time::Duration;

use rustix::process::Signal as Os;
use tokio::io::AsyncReadExt as _;
use tokio::signal::unix::{Signal, SignalKind, signal};
use tokio::sync::{mpsc, oneshot};

use super::{Controls, FlightError};

/// Signals and the control port, on a thread that ends with the flight.
#[derive(Debug)]
pub(super) struct Services {
    control: mpsc::Receiver<Vec<u8>>,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// Capacity of the channel for blocks of the configuration dump. The drone waits while it is full.
const BLOCKS: usize = 4;
/// Maximum blocks handled in a tick.
const BLOCKS_PER_TICK: usize = 2;
/// Interval between attempts to connect to the control port.
const CONTROL_RETRY: Duration = Duration::from_millis(500);

impl Services {
    /// Starts the services; signals are passed to `controls`.
    pub(super) fn start(address: SocketAddr, controls: Controls) -> Result<Self, FlightError> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(FlightError::Thread)?;
        let (sender, control) = mpsc::channel(BLOCKS);
        let (end, ended) = oneshot::channel();
        let thread = std::thread::Builder::new()
            .name("services".to_owned())
            .spawn(move || {
                runtime.block_on(async {
                    // In a task of its own, so that it cannot delay signals.
                    tokio::spawn(read_control_port(address, sender));
                    tokio::select! {
                        () = forward_signals(&controls) => {}
                        // The flight is over.
                        _ = ended => {}
                    }
                });
            })
            .map_err(FlightError::Thread)?;
        Ok(Self { control, end: Some(end), thread: Some(thread) })
    }

    /// Bytes received on the control port, oldest first, at most as many as a tick has time for; never
    /// blocks.
    pub(super) fn poll_control(&mut self) -> impl Iterator<Item = Vec<u8>> + '_ {
        std::iter::from_fn(|| self.control.try_recv().ok()).take(BLOCKS_PER_TICK)
    }
}

impl Drop for Services {
    fn drop(&mut self) {
        if let Some(end) = self.end.take() {
            // The thread may have ended by itself.
            _ = end.send(());
        }
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the services thread panicked");
        }
    }
}

/// Never returns. Without signals the flight goes on.
async fn forward_signals(controls: &Controls) {
    let mut signals = EndSignals::new();
    // With SIGXFSZ caught, exceeding the file size limit ends the log, not the process.
    let _too_large = signal(SignalKind::from_raw(Os::XFSZ.as_raw()));
    loop {
        signals.next().await;
        controls.stop();
    }
}

/// All signals that request the exit.
#[derive(Debug)]
pub(crate) struct EndSignals(Vec<Signal>);

impl EndSignals {
    /// Starts listening. Must be called within a tokio runtime.
    pub(crate) fn new() -> Self {
        let ends = [
            SignalKind::interrupt(),
            SignalKind::terminate(),
            SignalKind::hangup(),
            SignalKind::quit(),
            SignalKind::alarm(),
            SignalKind::user_defined1(),
            SignalKind::user_defined2(),
            SignalKind::io(),
        ];
        let others = [Os::VTALARM, Os::PROF, Os::XCPU, Os::SYS];
        let others = others.map(|other| SignalKind::from_raw(other.as_raw()));
        let ends = [&ends[..], &others[..]].concat();
        let signals: Vec<Signal> = ends.iter().filter_map(|kind| signal(*kind).ok()).collect();
        if signals.len() < ends.len() {
            tracing::warn!("not all signals can be caught: Ctrl-C may not land the drone");
        }
        Self(signals)
    }

    /// Waits for the next one.
    pub(crate) async fn next(&mut self) {
        std::future::poll_fn(|context| self.poll(context)).await;
    }

    /// Polls all of them, so that each wakes the task.
    fn poll(&mut self, context: &mut Context<'_>) -> Poll<()> {
        let mut came = Poll::Pending;
        for signal in &mut self.0 {
            if let Poll::Ready(Some(())) = signal.poll_recv(context) {
                came = Poll::Ready(());
            }
        }
        came
    }
}

/// Reads the control port until the receiver is gone. A drone without one can be flown all the same.
async fn read_control_port(address: SocketAddr, out: mpsc::Sender<Vec<u8>>) {
    let mut buffer = vec![0_u8; 4096];
    while !out.is_closed() {
        if let Ok(mut stream) = tokio::net::TcpStream::connect(address).await {
            while let Ok(length @ 1..) = stream.read(&mut buffer).await {
                let bytes = buffer.get(..length).unwrap_or_default().to_vec();
                if out.send(bytes).await.is_err() {
                    return;
                }
            }
        }
        tokio::time::sleep(CONTROL_RETRY).await;
    }
}
