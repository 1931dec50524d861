//! `asl2c lsp`: sessions by the protocol.

mod client;
mod hostile;
mod same;
mod session;
mod speed;
mod systems;
