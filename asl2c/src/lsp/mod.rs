//! The language server: what editors ask about agents, their configurations and systems, over standard input and output.
//!
//! Everything that the answers say comes from the `translator`. Here are the protocol, the open texts, and the
//! configuration that belongs to an agent. The server is single-threaded but for the thread that reads: it handles
//! waiting messages first, and publishes diagnostics when none is left, so that of several keystrokes only the last is
//! analysed.

mod answers;
mod completion;
mod files;
mod findings;
mod formatting;
mod lifecycle;
mod navigation;
mod places;
mod positions;
mod rename;
mod requests;
mod server;
mod symbols;
mod token_lists;
mod tokens;
mod transport;
mod uri;

pub(crate) use lifecycle::serve;
