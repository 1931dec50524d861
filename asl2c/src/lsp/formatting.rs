//! Formatting, as `asl2c fmt` does it.

use gen_lsp_types::{DocumentFormattingParams, TextEdit};
use serde_json::Value;

use super::answers::{Answer, parameters, result};
use super::files::Content;
use super::server::Server;

/// The difference between a text and its formatted form, as one edit. A text with errors, or one that is formatted
/// already, is not changed.
pub(super) fn format(server: &mut Server, params: Value) -> Answer {
    let params: DocumentFormattingParams = parameters(params)?;
    let (_, file) = server.file(&params.text_document.uri.0)?;
    let text = file.text();
    let formatted = match &file.content {
        Content::Agent(_) => translator::format("", text),
        Content::System(_) => translator::format_system("", text),
        Content::Configuration(_) => return result(Value::Null),
    };
    let Ok(mut formatted) = formatted else { return result(Value::Null) };
    if text.contains("\r\n") {
        formatted = formatted.replace("\r\n", "\n").replace('\n', "\r\n");
    }
    if formatted == text {
        return result([(); 0]);
    }
    let start = text.floor_char_boundary(common(text.bytes(), formatted.bytes()));
    let (old, new) = (&text[start..], &formatted[start..]);
    let ending = common(old.bytes().rev(), new.bytes().rev());
    // The same bytes may end different characters.
    let end = old.ceil_char_boundary(old.len() - ending);
    let replacement = &new[..new.len() - (old.len() - end)];
    let range = file.place(&(start..start + end));
    result([TextEdit { range, new_text: replacement.to_owned() }])
}

/// Length of the common begin.
fn common(one: impl Iterator<Item = u8>, other: impl Iterator<Item = u8>) -> usize {
    one.zip(other).take_while(|(one, other)| one == other).count()
}
