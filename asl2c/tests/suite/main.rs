//! The compiler's command line: what it prints, writes and proves.
#![forbid(unsafe_code)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::format_collect, reason = "tests build texts, and read better so")]
#![allow(clippy::disallowed_methods, reason = "tests wait for programs and time them")]

mod breaches;
mod certified;
mod current;
mod edited;
mod environment;
mod files;
mod first_agent;
mod floats;
mod fmt;
mod gallery;
mod guide;
mod harness;
mod headers;
mod heard;
mod lsp;
mod on_target;
mod prove;
mod proved;
mod rounded;
mod run;
#[cfg(target_os = "linux")]
mod stopped;
mod systems;
mod systems_proved;
mod tool;
mod tricks;
mod validated;
mod verification;
