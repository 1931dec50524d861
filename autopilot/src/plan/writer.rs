//! Writes commands that were made, not read: the inverse of the [parser], by the same declarations.

use diagnostic::Diagnostic;
use kinematics::Pose;

use super::Command;
use super::language::{LANGUAGE, MOST, Meaning};
use super::parser::{self, Line};

/// Writes a line for each meaning, and returns what the parser would return for that text.
pub(super) fn write(
    meant: impl IntoIterator<Item = Meaning>,
) -> (String, Vec<Line>, Vec<Diagnostic>) {
    let (mut text, mut lines, mut diagnostics) = (String::new(), Vec::new(), Vec::new());
    for (number, meaning) in (1..).zip(meant) {
        // The parser counts the empty line behind the last one, too.
        if number >= parser::MAX_LINES {
            diagnostics.push(parser::too_long(text.len()));
            break;
        }
        match line(meaning, number, text.len()) {
            Ok(line) => {
                text.push_str(&line.text);
                text.push('\n');
                lines.push(line);
            }
            Err(diagnostic) => diagnostics.push(diagnostic),
        }
    }
    (text, lines, diagnostics)
}

fn line(meaning: Meaning, number: usize, start: usize) -> Result<Line, Diagnostic> {
    let values = if let Meaning::Step(command) = meaning { numbers(command) } else { [0.0; MOST] };
    let declared = LANGUAGE.iter().find_map(|declaration| {
        let word = declaration.words.iter().find(|(_, known)| Meaning::Step(*known) == meaning);
        let fits = word.is_some() || (declaration.meaning)(values) == meaning;
        fits.then_some((declaration, word))
    });
    let Some((declaration, word)) = declared else {
        // Only what is no number differs from itself.
        return Err(Diagnostic::error(format!("not a number in {meaning:?}"), start..start));
    };
    let needed = if word.is_some() { 0 } else { declaration.numbers.len() - declaration.optional };
    let values = || values.iter().copied().zip(declaration.numbers).take(needed);
    let words = word.map(|(word, _)| format!(" {word}")).into_iter();
    let words = words.chain(values().map(|(value, _)| format!(" {value}")));
    let text: String = std::iter::once(declaration.name.to_owned()).chain(words).collect();
    let span = start..start + text.len();
    values().try_for_each(|(value, number)| parser::check(value, number, &span))?;
    Ok(Line::new(number, span, text, declaration, meaning))
}

/// The numbers of a command, in the order in which they are declared.
fn numbers(command: Command) -> [f64; MOST] {
    let first = match command {
        Command::GoTo(pose)
        | Command::MoveBy(pose)
        | Command::MoveByRelative(pose)
        | Command::SetReference(pose) => {
            let Pose { x_m, y_m, z_m, yaw_deg } = pose;
            return [x_m, y_m, z_m, yaw_deg];
        }
        Command::SetReachDistance { distance_m } | Command::SetStayDistance { distance_m } => {
            distance_m
        }
        Command::Hold { time_s } | Command::SetStayTime { time_s } => time_s,
        Command::SetSpeed { speed_m_s } => speed_m_s,
        Command::SetMaxControl { fraction } => fraction,
        Command::TakeOff { .. }
        | Command::Land
        | Command::FindTag
        | Command::LandOnTag
        | Command::SetReferenceHere
        | Command::SetReferenceStart => 0.0,
    };
    [first, 0.0, 0.0, 0.0]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::plan::{Commands, MissionId};

    /// Each command of the language, with these numbers where it has some.
    fn all(numbers: [f64; MOST]) -> Vec<Meaning> {
        let meant = LANGUAGE.iter().flat_map(|declaration| {
            let words = declaration.words.iter().map(|(_, command)| Meaning::Step(*command));
            words.chain([(declaration.meaning)(numbers)])
        });
        meant.filter(|meaning| matches!(meaning, Meaning::Step(_) | Meaning::Clears)).collect()
    }

    proptest! {
        /// A log holds the text, and a replay flies what is read from it.
        #[test]
        fn what_is_written_is_read_again(
            numbers in prop::array::uniform4(prop_oneof![-0.0..1.0, -50.0..50.0, -1e-7..1e-7]),
        ) {
            for meaning in all(numbers) {
                let (text, lines, diagnostics) = write([meaning, Meaning::Clears, meaning]);
                let (read, problems) = parser::parse(&text);
                if diagnostics.is_empty() {
                    prop_assert_eq!((lines, diagnostics), (read, problems));
                } else {
                    // It need not be in range.
                    prop_assert_eq!((lines.len(), diagnostics.len()), (1, 2));
                }
            }
        }
    }

    #[test]
    fn every_command_can_be_written() {
        let meant = all([0.5, 0.25, -1.0, 90.0]);
        let (text, lines, diagnostics) = write(meant.iter().copied());
        assert_eq!((lines.len(), diagnostics), (meant.len(), vec![]), "{text}");
        for line in ["setReference $START$", "goto 0.5 0.25 -1 90", "autoTakeover", "landOnTag"] {
            assert!(text.lines().any(|written| written == line), "{line}: {text}");
        }
    }

    #[test]
    fn numbers_are_checked_as_those_of_a_text() {
        let made = |command| Commands::new("made", MissionId(1), false, [Command::Land, command]);
        let far = Pose { x_m: 1e3, ..Pose::default() };
        let error = made(Command::GoTo(far)).unwrap_err().to_string();
        let read = Commands::parse("made", "land\ngoto 1000 0 0 0\n").unwrap_err().to_string();
        assert!(error.contains("1000 is out of range") && read.contains("1000 is out of range"));
        for number in [f64::NAN, f64::INFINITY, -1.0] {
            assert!(made(Command::Hold { time_s: number }).is_err(), "{number}");
        }
        let many = std::iter::repeat_n(Command::Land, parser::MAX_LINES);
        let error = Commands::new("made", MissionId(1), false, many).unwrap_err().to_string();
        assert!(error.contains("more than 10000 lines"), "{error}");
        assert!(Commands::new("made", MissionId(1), false, []).is_err(), "no command");
    }
}
