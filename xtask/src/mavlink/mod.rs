//! The MAVLink dialect: generates its code, which is checked in, and reads that code's messages as a table.

mod code;
mod table;

use std::path::PathBuf;

use crate::files::{FileError, read, root, write};

/// Why the code cannot be generated or read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum MavlinkError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("the dialect cannot be read: {0}")]
    Dialect(#[from] mavlink_bindgen::BindGenError),
    #[error("rustfmt refuses the generated code: {0}")]
    Format(String),
    #[error("no message can be read from the line `{0}` of the generated code")]
    Table(String),
}

/// What to do.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Only tell whether the code is up to date; fails if it is not
    #[arg(long, conflicts_with = "table")]
    check: bool,
    /// Instead, print the messages of the code that is checked in: number, name, `CRC_EXTRA`, length, fields
    #[arg(long)]
    table: bool,
}

/// Where the code is checked in.
fn checked_in() -> PathBuf {
    root().join("mavlink-vehicle/src/dialect.rs")
}

/// Writes the code, or looks at what is there. Returns what to print, and whether it is good.
pub(crate) fn run(arguments: &Arguments) -> Result<(String, bool), MavlinkError> {
    let path = checked_in();
    if arguments.table {
        return Ok((table::table(&read(&path)?)?, true));
    }
    let code = code::generate()?;
    if !arguments.check {
        write(&path, &code)?;
        return Ok((format!("{} lines\n", code.lines().count()), true));
    }
    let good = read(&path)? == code;
    let text = if good { "up to date\n" } else { "not up to date: run `cargo xtask mavlink`\n" };
    Ok((text.to_owned(), good))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checked_in_code_is_up_to_date() {
        let (text, good) = run(&Arguments { check: true, table: false }).unwrap();
        assert!(good, "{text}");
    }

    #[test]
    fn the_table_has_every_message() {
        let (table, _) = run(&Arguments { check: false, table: true }).unwrap();
        assert_eq!(table.lines().count(), 71);
        let heartbeat = "0\tHEARTBEAT\t50\t9\tcustom_mode:u32 type:u8 autopilot:u8 base_mode:u8 system_status:u8 \
                         mavlink_version:u8\t\n";
        assert!(table.contains(heartbeat), "{table}");
        let ack = "77\tCOMMAND_ACK\t143\t10\tcommand:u16 result:u8\tprogress:u8 result_param2:i32 target_system:u8 \
                   target_component:u8\n";
        assert!(table.contains(ack), "{table}");
        assert!(table.contains("text:u8[50]"), "{table}");
    }
}
