//! The drone's control port, read beside the flight.

use std::net::SocketAddr;
use std::time::Duration;

use tokio::io::AsyncReadExt as _;
use tokio::sync::mpsc;

use crate::runtime::{Background, Runtime};

/// Reads the control port until this is dropped.
#[derive(Debug)]
pub(super) struct ControlPort {
    blocks: mpsc::Receiver<Vec<u8>>,
    _reading: Background,
}

/// Capacity of the channel for blocks of the configuration dump. The drone waits while it is full.
const BLOCKS: usize = 4;
/// Maximum blocks handled in a tick.
const BLOCKS_PER_TICK: usize = 2;
/// Interval between attempts to connect to the control port.
const CONTROL_RETRY: Duration = Duration::from_millis(500);

impl ControlPort {
    pub(super) fn read(runtime: &Runtime, address: SocketAddr) -> Self {
        let (sender, blocks) = mpsc::channel(BLOCKS);
        Self { blocks, _reading: runtime.spawn(pass_on(address, sender)) }
    }

    /// Bytes that have arrived, oldest first, at most as many as a tick has time for; never blocks.
    pub(super) fn poll(&mut self) -> impl Iterator<Item = Vec<u8>> + '_ {
        std::iter::from_fn(|| self.blocks.try_recv().ok()).take(BLOCKS_PER_TICK)
    }
}

/// Reads until the receiver is gone. A drone without a control port can be flown all the same.
async fn pass_on(address: SocketAddr, out: mpsc::Sender<Vec<u8>>) {
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
