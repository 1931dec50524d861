//! The version of what agents say to each other: one text for all ways to write the same sections `peers` and
//! `messages`, and its hash.

use std::fmt;

use super::{Configuration, Message};
use crate::types::{CType, TypeKind};

/// Stands before the sections. If the text form of messages or this canonical form changes, this does too: agents with
/// the same sections but another form do not understand each other either.
const FORM: &str = "messages of asl2c, form 1\n";

/// A number for the sections `peers` and `messages`, with the structs that messages have: agents with the same one understand
/// each other.
///
/// It finds agents that were translated from other sections by mistake. It is no proof of who has sent a message: 64 bits of
/// FNV-1a need no other crate, but somebody who wants to can find other sections with the same number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MessagesVersion(pub u64);

impl fmt::Display for MessagesVersion {
    /// Sixteen hexadecimal digits.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl Configuration {
    /// The version of the sections `peers` and `messages`; `None` if there are no messages.
    pub fn messages_version(&self) -> Option<MessagesVersion> {
        let is_silent = self.messages.is_empty();
        (!is_silent).then(|| MessagesVersion(fnv_1a(&self.canonical_messages())))
    }

    /// The sections `peers` and `messages`, the same text for all ways to write them: a line for the form, one for the peers,
    /// and one for each message.
    ///
    /// The order of the peers counts, because a peer is its number. The order of the messages and of their senders does
    /// not, nor `any` or the names of all, nor by which C name a type of numbers is called. Of a struct its name and its
    /// fields count.
    pub fn canonical_messages(&self) -> String {
        let mut lines: Vec<String> =
            self.messages.iter().map(|message| self.canonical_message(message)).collect();
        lines.sort_unstable();
        let peers: Vec<&str> = self.peers.iter().map(|peer| peer.text.as_str()).collect();
        format!("{FORM}peers {}\n{}", peers.join(", "), lines.concat())
    }

    /// `achieve inspect(f64, f64) from leader, 4`
    fn canonical_message(&self, message: &Message) -> String {
        let Message { performative, name, parameters, senders, room, .. } = message;
        let types: Vec<String> =
            parameters.iter().map(|ctype| self.canonical_type(ctype)).collect();
        let names = senders.iter().filter_map(|number| self.peers.get(*number));
        let names: Vec<&str> = names.map(|peer| peer.text.as_str()).collect();
        let (types, names) = (types.join(", "), names.join(", "));
        // What is told has one slot, however it is written.
        format!("{} {}({types}) from {names}, {room}\n", performative.name(), name.text)
    }

    /// What a value of the type can be: `int` and `int32_t` are one type, and structs with other fields are others.
    fn canonical_type(&self, ctype: &CType) -> String {
        match ctype.kind {
            TypeKind::Text => "string".to_owned(),
            TypeKind::Struct => {
                let fields = self.fields(&ctype.name).iter();
                let fields: Vec<String> = fields
                    .map(|(field, ctype)| format!("{} {}", self.canonical_type(ctype), field.text))
                    .collect();
                format!("{} {{ {} }}", ctype.name, fields.join(", "))
            }
            _ if ctype.is_peer() => "peer".to_owned(),
            _ => ctype.rust_name().unwrap_or(&ctype.name).to_owned(),
        }
    }
}

/// The hash FNV-1a of a text, in 64 bits.
fn fnv_1a(text: &str) -> u64 {
    const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0100_0000_01b3;
    text.bytes().fold(OFFSET, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::parse;

    const SETTINGS: &str =
        "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n";
    const SECTIONS: &str = "structs { place_t { double x; float y; }; };\n\
        peers { leader, wingman, scout };\n\
        messages {\n\
        tell at(double, place_t) from any;\n\
        tell low(const char *, peer) from wingman, scout;\n\
        achieve inspect(int32_t, uint8_t) from leader, 4;\n\
        achieve wait from leader;\n\
        };";

    fn parsed(sections: &str) -> Configuration {
        let (configuration, found) = parse(&format!("{SETTINGS}{sections}"));
        assert!(found.is_empty(), "{sections}\n{found:?}");
        configuration
    }

    fn changed(from: &str, to: &str) -> Configuration {
        assert_eq!(SECTIONS.matches(from).count(), 1, "{from}");
        parsed(&SECTIONS.replace(from, to))
    }

    #[test]
    fn the_canonical_form_says_it_all() {
        insta::assert_snapshot!(parsed(SECTIONS).canonical_messages(), @r"
        messages of asl2c, form 1
        peers leader, wingman, scout
        achieve inspect(i32, u8) from leader, 4
        achieve wait() from leader, 1
        tell at(f64, place_t { f64 x, f32 y }) from leader, wingman, scout, 1
        tell low(string, peer) from wingman, scout, 1
        ");
    }

    /// A version that changes with a new asl2c would part agents whose messages are the same.
    #[test]
    fn the_version_stays() {
        let version = parsed(SECTIONS).messages_version().map(|version| version.to_string());
        assert_eq!(version.as_deref(), Some("68bd5867752ce743"));
        // The hash's published values, and its width with leading zeros.
        assert_eq!(fnv_1a(""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv_1a("a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv_1a("foobar"), 0x8594_4171_f739_67e8);
        assert_eq!(MessagesVersion(0xabc).to_string(), "0000000000000abc");
        assert_eq!(parsed("peers { leader, wingman };").messages_version(), None);
        assert_eq!(parsed("").messages_version(), None);
    }

    #[test]
    fn how_it_is_written_does_not_change_the_version() {
        for (from, to) in [
            ("from any", "from leader, wingman, scout"),
            ("from any", "from scout, leader, wingman"),
            ("from wingman, scout", "from scout, wingman"),
            ("leader, wingman, scout };", "leader,\n  wingman , scout // all\n};"),
            ("tell at(double, place_t)", "tell  at ( double,place_t )"),
            ("achieve wait from leader", "achieve wait from leader, 1"),
            ("(int32_t, uint8_t)", "(int, unsigned char)"),
            ("const char *, peer", "char const *, peer_t"),
            (
                "tell at(double, place_t) from any;\ntell low(const char *, peer) from wingman, scout;\n",
                "tell low(const char *, peer) from wingman, scout;\ntell at(double, place_t) from any;\n",
            ),
            ("messages {\n", "types { go(int); inspect(int32_t, uint8_t); };\nmessages {\n"),
        ] {
            let (one, other) = (parsed(SECTIONS), changed(from, to));
            assert_eq!(one.canonical_messages(), other.canonical_messages(), "{from} -> {to}");
            assert_eq!(one.messages_version(), other.messages_version(), "{from} -> {to}");
        }
    }

    #[test]
    fn what_it_means_changes_the_version() {
        for (from, to) in [
            ("peers { leader, wingman, scout }", "peers { wingman, leader, scout }"),
            ("peers { leader, wingman, scout }", "peers { leader, wingman, scout, other }"),
            ("tell at", "tell near"),
            ("achieve wait from leader", "tell wait from leader"),
            ("at(double, place_t)", "at(float, place_t)"),
            ("at(double, place_t)", "at(place_t, double)"),
            ("at(double, place_t)", "at(double)"),
            ("float y", "double y"),
            ("float y", "float z"),
            ("double x; float y;", "float y; double x;"),
            ("(const char *, peer)", "(const char *, uint8_t)"),
            ("(const char *, peer)", "(int64_t, peer)"),
            ("(int32_t, uint8_t)", "(uint32_t, uint8_t)"),
            ("from any", "from leader, wingman"),
            ("from wingman, scout", "from wingman"),
            ("from leader, 4", "from leader, 3"),
            ("from leader, 4", "from any, 4"),
            ("achieve wait from leader;", "achieve wait from leader, 2;"),
            ("achieve wait from leader;\n", ""),
        ] {
            let (one, other) = (parsed(SECTIONS), changed(from, to));
            assert_ne!(one.canonical_messages(), other.canonical_messages(), "{from} -> {to}");
            assert_ne!(one.messages_version(), other.messages_version(), "{from} -> {to}");
        }
    }
}
