//! Parser of systems.

use diagnostic::Diagnostic;

use super::{Agent, AgentAction, AgentCause, Channels, Declared, ROOM, SystemFormula};
use crate::code::Code;
use crate::configuration::scanner::{Parsed, Scanner, advice, unknown_section};

/// The sections of a system.
pub const SECTIONS: [&str; 3] = ["agents", "channels", "properties"];
/// The settings of channels.
pub const CHANNELS: [&str; 3] = ["capacity", "losses", "delay"];
/// A model with more has too many states to be searched.
const MOST: u32 = 16;

/// Parses `text`. Returns what it declares and all errors.
pub(super) fn parse(text: &str) -> (Declared, Vec<Diagnostic>) {
    let mut parser = Parser {
        scanner: Scanner { text, position: 0 },
        declared: Declared::default(),
        seen: Vec::new(),
        diagnostics: Vec::new(),
    };
    parser.scanner.take("\u{feff}");
    if let Err(diagnostic) = parser.scanner.version() {
        return (parser.declared, vec![diagnostic]);
    }
    while let Err(diagnostic) = parser.sections() {
        parser.diagnostics.push(diagnostic);
        // Continues behind the section, or stops if no section ends.
        let Some(offset) = parser.scanner.rest().find('}') else { break };
        parser.scanner.position += offset + 1;
    }
    if parser.declared.agents.is_empty() && parser.diagnostics.is_empty() {
        let message = "a system without agents";
        parser.diagnostics.push(
            Code::MissingSetting
                .at(message, 0..0)
                .help("name each peer with its configuration: `agents { leader: pilot.conf; };`"),
        );
    }
    (parser.declared, parser.diagnostics)
}

/// Whether a text is that of a system, however wrong, and of no agent: it begins with a section, or with its version.
pub fn begins_system(text: &str) -> bool {
    let mut scanner = Scanner { text, position: 0 };
    scanner.take("\u{feff}");
    // A system of another version is one, too.
    _ = scanner.version();
    let section = scanner.word("a section name");
    section.is_ok_and(|section| SECTIONS.contains(&section.text.as_str()))
        && scanner.expect("{").is_ok()
}

struct Parser<'a> {
    scanner: Scanner<'a>,
    declared: Declared,
    /// Sections and settings of channels that are declared already.
    seen: Vec<String>,
    diagnostics: Vec<Diagnostic>,
}

impl Parser<'_> {
    fn sections(&mut self) -> Parsed<()> {
        loop {
            self.scanner.skip_blanks()?;
            while self.scanner.take(";") {
                self.scanner.skip_blanks()?;
            }
            if self.scanner.rest().is_empty() {
                return Ok(());
            }
            let section = self.scanner.word("a section name")?;
            if !SECTIONS.contains(&section.text.as_str()) {
                return Err(unknown_section(section, &SECTIONS));
            }
            if self.is_second(&section.text) {
                return Err(Code::DeclaredTwice
                    .at(format!("a second section `{}`", section.text), section.span)
                    .help("put its entries into the first one"));
            }
            self.scanner.expect("{")?;
            self.scanner.skip_blanks()?;
            while !self.scanner.take("}") {
                if self.scanner.rest().is_empty() {
                    return Err(self.scanner.unexpected("`}`"));
                }
                let entry = match section.text.as_str() {
                    "agents" => self.agent(),
                    "channels" => self.channel(),
                    _ => self.property(),
                };
                if let Err(diagnostic) = entry {
                    self.diagnostics.push(diagnostic);
                    self.scanner.skip_entry();
                }
                self.scanner.skip_blanks()?;
            }
        }
    }

    fn is_second(&mut self, word: &str) -> bool {
        let is_known = self.seen.iter().any(|seen| seen == word);
        self.seen.push(word.to_owned());
        is_known
    }

    /// `leader: pilot.conf;`
    fn agent(&mut self) -> Parsed<()> {
        let peer = self.scanner.word("a peer")?;
        self.scanner.expect(":")?;
        self.scanner.skip_blanks()?;
        let rest = self.scanner.rest();
        let end = rest.find([';', '}', '\n']).unwrap_or(rest.len());
        let configuration = rest[..end].trim_end().to_owned();
        if configuration.is_empty() {
            return Err(self.scanner.unexpected("the path of a configuration"));
        }
        let start = self.scanner.position;
        self.scanner.position += configuration.len();
        let place = start..self.scanner.position;
        self.scanner.expect(";")?;
        if self.declared.agents.iter().any(|other| other.peer.text == peer.text) {
            let message = format!("a second agent `{}`", peer.text);
            return Err(Code::DeclaredTwice.at(message, peer.span).help("a peer is one agent"));
        }
        self.declared.agents.push(Agent { peer, configuration, place });
        Ok(())
    }

    /// `capacity = 2;`, `losses = any;`, `delay = 0;`
    fn channel(&mut self) -> Parsed<()> {
        let setting = self.scanner.word("`capacity`, `losses` or `delay`")?;
        if !CHANNELS.contains(&setting.text.as_str()) {
            return Err(Code::UnknownSetting
                .at(format!("unknown setting `{}`", setting.text), setting.span)
                .help(advice(&setting.text, &CHANNELS)));
        }
        self.scanner.expect("=")?;
        self.scanner.skip_blanks()?;
        let start = self.scanner.position;
        let is_capacity = setting.text == "capacity";
        let number = if !is_capacity && self.scanner.take("any") {
            None
        } else {
            let rest = self.scanner.rest();
            let length = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
            let number = rest[..length].parse().ok();
            let least = u32::from(is_capacity);
            let Some(number) = number.filter(|number| (least..=MOST).contains(number)) else {
                let or_any = if is_capacity { "" } else { ", or `any`" };
                return Err(Code::SettingValue
                    .at(format!("`{}` out of range", setting.text), start..start + length.max(1))
                    .help(format!("a whole number from {least} to {MOST}{or_any}")));
            };
            self.scanner.position += length;
            Some(number)
        };
        self.scanner.expect(";")?;
        if self.is_second(&setting.text) {
            return Err(Code::DeclaredTwice
                .at(format!("a second setting `{}`", setting.text), setting.span)
                .help("a setting has one value"));
        }
        let Channels { capacity, losses, delay } = &mut self.declared.channels;
        match setting.text.as_str() {
            "capacity" => *capacity = number.unwrap_or(*capacity),
            "losses" => *losses = number,
            _ => *delay = number,
        }
        Ok(())
    }

    /// `name [TAG]: formula;`
    fn property(&mut self) -> Parsed<()> {
        let head = self.scanner.property_head()?;
        if head.name.text == ROOM {
            let message = format!("`{ROOM}` is a property that systems have themselves");
            return Err(Code::ReservedName
                .at(message, head.name.span)
                .help("give it another name"));
        }
        let formula = self.formula()?;
        let property = self.scanner.property_end(head, formula)?;
        property.add_to(&mut self.declared.properties)
    }

    fn formula(&mut self) -> Parsed<SystemFormula> {
        const FORMULAS: &str = "`never_together` or `within`";
        let name = self.scanner.word(FORMULAS)?;
        if !["never_together", "within"].contains(&name.text.as_str()) {
            return Err(Code::UnknownFormula
                .at(format!("unknown formula `{}`", name.text), name.span)
                .help(format!(
                    "of a system they are {FORMULAS}; one agent's are in its configuration"
                )));
        }
        self.scanner.expect("(")?;
        if name.text == "never_together" {
            let first = self.action()?;
            self.scanner.expect(",")?;
            let mut actions = self.actions()?;
            actions.insert(0, first);
            return Ok(SystemFormula::NeverTogether(actions));
        }
        let rounds = self.scanner.steps()?;
        self.scanner.expect(",")?;
        let agent = self.scanner.word("an agent")?;
        self.scanner.expect(".")?;
        let cause = if self.scanner.rest().starts_with(['+', '-']) {
            AgentCause::Event(agent, self.scanner.trigger()?)
        } else {
            let action = self.scanner.word("an action, a class of actions or an event")?;
            AgentCause::Action(AgentAction { agent, action })
        };
        self.scanner.expect(",")?;
        Ok(SystemFormula::Within { rounds, cause, answers: self.actions()? })
    }

    /// `a.x, b.y)`
    fn actions(&mut self) -> Parsed<Vec<AgentAction>> {
        let mut actions = vec![self.action()?];
        self.scanner.skip_blanks()?;
        while self.scanner.take(",") {
            actions.push(self.action()?);
            self.scanner.skip_blanks()?;
        }
        self.scanner.expect(")")?;
        Ok(actions)
    }

    fn action(&mut self) -> Parsed<AgentAction> {
        let agent = self.scanner.word("an agent")?;
        self.scanner.expect(".")?;
        let action = self.scanner.word("an action or a class of actions")?;
        Ok(AgentAction { agent, action })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(text: &str) -> Vec<String> {
        parse(text).1.into_iter().map(|diagnostic| diagnostic.message).collect()
    }

    #[test]
    fn everything_is_read() {
        let text = "agents { a: one.conf; b : two words.conf ; };
            channels { capacity = 3; losses = any; delay = 0; }
            properties {
              p [R-1, R-2]: never_together(a.x, b.y, b.z); // three
              q: within(5, a.+!go, b.x); r: within(1, b.x, a.y, b.z);
            };";
        let (declared, errors) = parse(text);
        assert!(errors.is_empty(), "{errors:?}");
        assert_eq!(declared.agents[1].configuration, "two words.conf");
        assert_eq!(declared.channels, Channels { capacity: 3, losses: None, delay: Some(0) });
        let actions: Vec<usize> =
            declared.properties.iter().map(|property| property.formula.actions().len()).collect();
        assert_eq!(actions, [3, 1, 3]);
        assert_eq!(declared.properties[0].requirements, ["R-1", "R-2"]);
    }

    #[test]
    fn a_system_may_name_its_version() {
        let system = "agents { a: one.conf; };";
        assert_eq!(messages(&format!("version 1;\n{system}")), [""; 0]);
        let (_, found) = parse(&format!("version 2;\nagent {{ }}; {system}"));
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!((found[0].span.clone(), found[0].code), (8..9, "other-version"));
        assert_eq!(found[0].help.as_deref(), Some("this program reads version 1"));
        assert_eq!(messages(&format!("{system} version 1;")), ["unknown section `version`"]);
    }

    #[test]
    fn a_system_is_known_by_its_begin() {
        for text in [
            "version 1; agents {",
            "version 9;\nagents{",
            "agents {",
            "\u{feff}// b.\n properties /* c */ { p",
            "channels{capacity=9;}",
        ] {
            assert!(begins_system(text), "{text}");
        }
        for text in ["", "agents.", "agents(1). +!go.", "settings {", "/* agents {"] {
            assert!(!begins_system(text), "{text}");
        }
    }

    #[test]
    fn every_error_is_reported_with_what_was_expected() {
        let text = "agents { a one.conf; a: ; a: x.conf; a: y.conf; };
            channels { size = 1; capacity = any; capacity = 0; losses = 17; delay = 1; delay = 1; };
            properties {
              p: never(a.x); p: never_together(a.x); p: never_together(a, b.x); p: within(0, a.x, b.y);
              p: within(1, a.-!g, b.y); p: within(2, a.x, b.y); p: within(3, a.x, b.y);
              channels_suffice: within(1, a.x, b.y);
            };
            agents { }; agent { };";
        insta::assert_snapshot!(messages(text).join("\n"));
        for text in
            ["", "agents", "agents {", "agents { a", "/* open", "\0\u{fffd}}}{{", "channels { };"]
        {
            assert!(!messages(text).is_empty(), "{text:?}");
        }
    }
}
