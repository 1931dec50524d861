//! What logs have by its name, in sentences for people. A name of another version stays as it is.

use autopilot::agent::{Danger, Report};
use autopilot::vehicle::Veto;

/// What the agent said of a danger.
pub(super) fn danger(name: &str) -> String {
    let known = Danger::ALL.into_iter().find(|danger| danger.name() == name);
    let said = known.map_or_else(|| name.to_owned(), |danger| danger.to_string());
    format!("the agent says: {said}")
}

/// How the agent's last order ended.
pub(super) fn last_order(name: &str) -> String {
    let known = Report::ALL.into_iter().find(|report| report.name() == name);
    let ended = known.map_or_else(|| format!("ended: {name}"), |report| report.to_string());
    format!("the last order {ended}")
}

/// Why the safety monitor replaced a command, and what it did instead.
pub(super) fn veto(name: &str) -> String {
    let known = Veto::ALL.into_iter().find(|veto| veto.name() == name);
    let why = known.map_or_else(|| name.to_owned(), |veto| veto.to_string());
    format!("the safety monitor steps in: {why}")
}

/// What follows a veto.
pub(super) const NO_VETO: &str = "the safety monitor lets the agent's commands pass again";

/// A name like `TakingOff` as words: "taking off".
pub(super) fn spoken(name: &str) -> String {
    let mut words = String::with_capacity(name.len() + 4);
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.extend(letter.to_lowercase());
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_sentences_and_unknown_ones_are_kept() {
        assert_eq!(danger("Blind"), "the agent says: there are no usable navdata");
        assert_eq!(last_order("Done"), "the last order was carried out");
        assert_eq!(veto("NearFence"), "the safety monitor steps in: at the fence: stopping");
        assert_eq!(danger("Sharks"), "the agent says: Sharks");
        assert_eq!([spoken("TakingOff"), spoken("Goto")], ["taking off", "goto"]);
        for danger in Danger::ALL {
            assert!(danger.to_string().contains(' ') && danger.to_string() != danger.name());
        }
    }
}
