//! What is slow and goes on beside the flight: signals and the control port.

use std::net::SocketAddr;
use std::thread::JoinHandle;
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded};
use tokio::io::AsyncReadExt as _;
use tokio::sync::oneshot;

use super::FlightError;
use crate::pilot::PilotOrder;

/// What the slow side brings.
#[derive(Debug)]
pub(super) enum Input {
    /// Bytes from the control port.
    Control(Vec<u8>),
    /// The person at the controls wants something.
    Order(PilotOrder),
    /// Ctrl-C, SIGTERM, or a terminal that is gone.
    Stop,
}

/// Signals and the control port, on a thread of their own; it ends with the flight.
pub(super) struct Services {
    inputs: Receiver<Input>,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// Orders and blocks of the configuration dump that may wait for the tick.
const INPUTS: usize = 64;
/// The control port is tried again after this time.
const CONTROL_RETRY: Duration = Duration::from_millis(500);

impl Services {
    /// The services, and the way to them for whoever else has something to say.
    pub(super) fn start(control: SocketAddr) -> Result<(Self, Sender<Input>), FlightError> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(FlightError::Thread)?;
        let (sender, inputs) = bounded(INPUTS);
        let others = sender.clone();
        let (end, ended) = oneshot::channel();
        let thread = std::thread::Builder::new()
            .name("services".to_owned())
            .spawn(move || {
                runtime.block_on(async {
                    tokio::select! {
                        () = forward_signals(&sender) => {}
                        () = read_control_port(control, &sender) => {}
                        // The flight is over.
                        _ = ended => {}
                    }
                });
            })
            .map_err(FlightError::Thread)?;
        Ok((Self { inputs, end: Some(end), thread: Some(thread) }, others))
    }

    /// What came in, oldest first; never waits.
    pub(super) fn poll(&self) -> Option<Input> {
        self.inputs.try_recv().ok()
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

/// Never returns: without signals the flight goes on.
async fn forward_signals(inputs: &Sender<Input>) {
    use tokio::signal::unix::{SignalKind, signal};
    let interrupt = signal(SignalKind::interrupt());
    let terminate = signal(SignalKind::terminate());
    let hang_up = signal(SignalKind::hangup());
    let (Ok(mut interrupt), Ok(mut terminate), Ok(mut hang_up)) = (interrupt, terminate, hang_up)
    else {
        tracing::warn!("signals cannot be caught: Ctrl-C will not land the drone");
        return std::future::pending().await;
    };
    loop {
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
            _ = hang_up.recv() => {}
        }
        if inputs.try_send(Input::Stop).is_err() {
            tracing::warn!("the flight is too busy to be told to land");
        }
    }
}

/// Never returns: a drone without control port can be flown all the same.
async fn read_control_port(address: SocketAddr, inputs: &Sender<Input>) {
    let mut buffer = vec![0_u8; 4096];
    loop {
        if let Ok(mut stream) = tokio::net::TcpStream::connect(address).await {
            while let Ok(length @ 1..) = stream.read(&mut buffer).await {
                let bytes = buffer.get(..length).unwrap_or_default().to_vec();
                // A full channel loses the dump; the session asks again.
                _ = inputs.try_send(Input::Control(bytes));
            }
        }
        tokio::time::sleep(CONTROL_RETRY).await;
    }
}
