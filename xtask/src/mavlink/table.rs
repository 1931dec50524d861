//! Reads the messages out of the generated code: what its encoders write, in their order.

use std::collections::BTreeMap;

use super::MavlinkError;

#[derive(Debug, Default)]
struct Message {
    name: String,
    id: u32,
    crc_extra: u8,
    length: usize,
    fields: Vec<String>,
    extensions: Vec<String>,
}

/// One line for each message, by number: number, name, `CRC_EXTRA`, longest payload in bytes, fields in the order of the
/// wire, extension fields; separated by tabs.
pub(super) fn table(code: &str) -> Result<String, MavlinkError> {
    let mut messages: BTreeMap<u32, Message> = BTreeMap::new();
    let mut open: Option<(Message, Encoder<'_>)> = None;
    let mut lengths = BTreeMap::new();
    for line in code.lines() {
        let trimmed = line.trim();
        if line.starts_with("pub struct ") {
            lengths.clear();
        } else if let Some((name, length)) = array(trimmed) {
            lengths.insert(name, length);
        } else if line.starts_with("impl MessageData for ") {
            open = Some(Default::default());
        } else if line == "}" {
            if let Some((message, _)) = open.take() {
                messages.insert(message.id, message);
            }
        } else if let Some((message, encoder)) = &mut open {
            read_line(message, encoder, &lengths, trimmed)
                .ok_or_else(|| MavlinkError::Table(line.to_owned()))?;
        }
    }
    Ok(messages.values().map(row).collect())
}

/// A field of a struct that is an array, and how many elements it has.
fn array(line: &str) -> Option<(&str, &str)> {
    let (name, kind) = line.strip_prefix("pub ")?.split_once(": ")?;
    let chars = kind.strip_prefix("CharArray<").and_then(|rest| rest.strip_suffix(">,"));
    let others = || kind.strip_prefix('[')?.strip_suffix("],")?.split_once("; ");
    let length = chars.or_else(|| others().map(|(_, length)| length))?;
    Some((name, length.trim_end_matches("usize")))
}

/// Where in an encoder the reader is.
#[derive(Debug, Default)]
struct Encoder<'a> {
    extensions: bool,
    array: Option<&'a str>,
}

fn read_line<'a>(
    message: &mut Message,
    encoder: &mut Encoder<'a>,
    lengths: &BTreeMap<&str, &str>,
    line: &'a str,
) -> Option<()> {
    if let Some(value) = constant(line, "const ID: u32 = ") {
        message.id = value.trim_end_matches("u32").parse().ok()?;
    } else if let Some(value) = constant(line, "const NAME: &'static str = ") {
        value.trim_matches('"').clone_into(&mut message.name);
    } else if let Some(value) = constant(line, "const EXTRA_CRC: u8 = ") {
        message.crc_extra = value.trim_end_matches("u8").parse().ok()?;
    } else if let Some(value) = constant(line, "const ENCODED_LEN: usize = ") {
        message.length = value.trim_end_matches("usize").parse().ok()?;
    } else if line.starts_with("if matches!(version, MavlinkVersion::V2)") {
        encoder.extensions = true;
    } else if let Some(rest) = line.strip_prefix("for val in &self.") {
        encoder.array = Some(rest.strip_suffix(" {")?);
    } else if let Some(put) = line.strip_prefix("__tmp.put_") {
        let (kind, value) = put.split_once('(')?;
        let kind = kind.trim_end_matches("_le");
        let name = match encoder.array.take() {
            Some(name) => name,
            None => value.strip_prefix("self.")?.split(['.', ' ', ')']).next()?,
        };
        // The generator cannot call a field `type`.
        let wire = if name == "mavtype" { "type" } else { name };
        let count = lengths.get(name).map(|length| format!("[{length}]")).unwrap_or_default();
        let fields = if encoder.extensions { &mut message.extensions } else { &mut message.fields };
        fields.push(format!("{wire}:{kind}{count}"));
    }
    Some(())
}

fn constant<'a>(line: &'a str, before: &str) -> Option<&'a str> {
    line.strip_prefix(before)?.strip_suffix(';')
}

fn row(message: &Message) -> String {
    let Message { name, id, crc_extra, length, fields, extensions } = message;
    let [fields, extensions] = [fields, extensions].map(|fields| fields.join(" "));
    format!("{id}\t{name}\t{crc_extra}\t{length}\t{fields}\t{extensions}\n")
}
