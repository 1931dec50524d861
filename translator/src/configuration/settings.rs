//! The section `settings`.

use super::Instance;
use super::parser::Parser;
use super::scanner::{Parsed, advice};
use crate::code::Code;
use crate::syntax::ast::Name;

/// The names of the settings of a configuration.
pub const SETTINGS: [&str; 11] = [
    "trace",
    "clock",
    "input",
    "output",
    "header",
    "basics",
    "rust",
    "matrix",
    "instance",
    "inbox",
    "max_events",
];
/// Maximum capacity of the inbox: each event costs memory, and a long queue makes commands stale.
const MAX_INBOX: u32 = 64;

impl Parser<'_> {
    /// `name = value;`
    pub(super) fn setting(&mut self) -> Parsed<()> {
        let key = self.scanner.word("a setting")?;
        self.scanner.expect("=")?;
        let value = self.setting_value()?;
        self.scanner.expect(";")?;
        let settings = &mut self.configuration.settings;
        if settings.places.contains_key(&key.text) {
            let message = format!("a second setting `{}`", key.text);
            return Err(Code::DeclaredTwice.at(message, key.span).help("a setting has one value"));
        }
        let same = |other: &str| settings.places.contains_key(other);
        if matches!(key.text.as_str(), "inbox" | "max_events")
            && (same("inbox") || same("max_events"))
        {
            return Err(Code::ExclusiveSettings
                .at("`inbox` and `max_events` exclude each other", key.span)
                .help("both set the capacity for external events"));
        }
        settings.places.insert(key.text.clone(), value.span.clone());
        match key.text.as_str() {
            "input" => settings.input = value.text,
            "output" => settings.output = value.text,
            "header" => settings.header = value.text,
            "basics" => settings.basics = value.text,
            "rust" => settings.rust = Some(value),
            "matrix" => settings.matrix = Some(value.text),
            "trace" => settings.trace = Some(value),
            "clock" => settings.clock = Some(value),
            "instance" => {
                settings.instance = match value.text.as_str() {
                    "static" => Instance::Static,
                    "context" => Instance::Context,
                    _ => {
                        return Err(Code::SettingValue
                            .at("unknown kind of instance", value.span)
                            .help("write `static` or `context`"));
                    }
                };
            }
            "inbox" | "max_events" => match value.text.parse() {
                Ok(inbox @ 1..=MAX_INBOX) => {
                    settings.inbox = inbox;
                    settings.queue |= key.text == "max_events";
                }
                _ => {
                    return Err(Code::SettingValue
                        .at(format!("`{}` out of range", key.text), value.span)
                        .help(format!("a whole number from 1 to {MAX_INBOX}")));
                }
            },
            other => {
                return Err(Code::UnknownSetting
                    .at(format!("unknown setting `{other}`"), key.span)
                    .help(advice(other, &SETTINGS)));
            }
        }
        Ok(())
    }

    /// A word, a number or a file name, optionally in quotes. Comments may follow.
    fn setting_value(&mut self) -> Parsed<Name> {
        self.scanner.skip_blanks()?;
        let rest = self.scanner.rest();
        let start = self.scanner.position;
        let (text, length) = if let Some(quoted) = rest.strip_prefix('"') {
            match quoted.find(['"', '\n']).filter(|end| quoted[*end..].starts_with('"')) {
                Some(end) => (&quoted[..end], end + 2),
                None => {
                    return Err(Code::SettingValue
                        .at("value with a quote or backslash", start..start + 1)
                        .help("close the quote on the same line"));
                }
            }
        } else {
            let end = rest.find([';', '\n', '}']).unwrap_or(rest.len());
            let comment = ["/*", "//"].iter().filter_map(|open| rest[..end].find(open)).min();
            let text = rest[..comment.unwrap_or(end)].trim_end();
            (text, text.len())
        };
        let span = start..start + length;
        self.scanner.position = span.end;
        if text.is_empty() {
            return Err(Code::SettingValue.at("setting without a value", start..start + 1));
        }
        if text.contains(['"', '\\']) || text.chars().any(char::is_control) {
            return Err(Code::SettingValue
                .at("value with a quote or backslash", span)
                .help("generated C includes files by these names"));
        }
        Ok(Name { text: text.to_owned(), span })
    }

    /// Reports the settings that are missing and have no default.
    pub(super) fn check_settings(&mut self) {
        let settings = &self.configuration.settings;
        for (key, value) in [
            ("input", &settings.input),
            ("output", &settings.output),
            ("header", &settings.header),
            ("basics", &settings.basics),
        ] {
            if value.is_empty() {
                self.diagnostics.push(
                    Code::MissingSetting
                        .at(format!("the setting `{key}` is missing"), self.settings.clone())
                        .help(format!("add `{key} = FILE;` to the section `settings`")),
                );
            }
        }
    }
}
