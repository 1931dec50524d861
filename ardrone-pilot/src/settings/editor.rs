//! What people must know to change a `pilot.toml`, and the change of a file of theirs.

use toml::{Table, Value};

use super::{DECLARED, Settings, SettingsError};

/// A setting with everything that is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Described {
    /// Its section.
    pub section: String,
    /// Its name there.
    pub name: String,
    /// What it is for, with its unit.
    pub help: String,
    /// Least and largest number.
    pub range: Option<[f64; 2]>,
    /// Its default; `None` if it stands in place of another one.
    pub default: Option<Value>,
    /// Its value.
    pub value: Value,
}

impl Settings {
    /// Every setting, in the order of the file.
    ///
    /// # Errors
    /// As [`Settings::to_toml`].
    pub fn described(&self) -> Result<Vec<Described>, toml::ser::Error> {
        let table = |settings: &Self| Table::try_from(settings);
        let (values, defaults) = (table(self)?, table(&Self::default())?);
        let mut all = Vec::new();
        for (section, declared) in DECLARED {
            let of = |table: &Table| table.get(section).and_then(Value::as_table).cloned();
            let (values, defaults) =
                (of(&values).unwrap_or_default(), of(&defaults).unwrap_or_default());
            let place = |name: &str| declared.iter().position(|value| value.name == name);
            let mut names: Vec<&String> = values.keys().collect();
            // One that is not declared stands in place of the last one.
            names.sort_by_key(|name| place(name).unwrap_or(usize::MAX));
            let mut help = String::new();
            for name in names {
                let value = place(name).map(|place| declared[place]);
                if let Some(value) = value.filter(|value| !value.comments.is_empty()) {
                    value.comments.concat().trim().clone_into(&mut help);
                }
                all.push(Described {
                    section: section.to_owned(),
                    name: name.clone(),
                    help: help.clone(),
                    range: value.and_then(|value| value.range),
                    default: defaults.get(name).cloned(),
                    value: values[name].clone(),
                });
            }
        }
        Ok(all)
    }
}

/// A `pilot.toml` with other values, and with everything else as it was written, comments too. `changes` has a table for
/// each section; `path` is for messages.
///
/// # Errors
/// [`SettingsError`] if the file was wrong, or is with these values.
pub fn with_changes(path: &str, text: &str, changes: &Table) -> Result<String, SettingsError> {
    Settings::parse(path, text)?;
    // What is no section, or no setting of one, must not be passed over. A list would be read as the values of a section.
    if let Some((section, value)) = changes.iter().find(|(_, value)| value.is_array()) {
        return Err(SettingsError::Change(format!("`{section}` is {value}, and no section")));
    }
    let shape: Result<Settings, _> = changes.clone().try_into();
    if let Err(error) = shape {
        return Err(SettingsError::Change(error.to_string().trim_end().to_owned()));
    }
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (section, values) in changes {
        for (name, value) in values.as_table().into_iter().flatten() {
            set(&mut lines, section, name, &format!("{name} = {value}"));
        }
    }
    let changed = lines.join("\n") + "\n";
    Settings::parse(path, &changed)?;
    Ok(changed)
}

/// Writes a value in place of the one of its name, or at the end of its section.
fn set(lines: &mut Vec<String>, section: &str, name: &str, written: &str) {
    let begins = |line: &String| header(line).is_some_and(|table| table.contains_key(section));
    let Some(begin) = lines.iter().position(begins) else {
        let empty = lines.last().is_none_or(|line| line.trim().is_empty());
        lines.extend((!empty).then(String::new));
        lines.extend([format!("[{section}]"), written.to_owned()]);
        return;
    };
    let end =
        (begin + 1..lines.len()).find(|at| header(&lines[*at]).is_some()).unwrap_or(lines.len());
    let is_name = |line: &String| line.split_once('=').is_some_and(|(key, _)| key.trim() == name);
    let Some(at) = (begin + 1..end).find(|at| is_name(&lines[*at])) else {
        let last = (begin..end).rev().find(|at| !lines[*at].trim().is_empty()).unwrap_or(begin);
        lines.insert(last + 1, written.to_owned());
        return;
    };
    // An array may go on in the next lines.
    let whole = |until: usize| lines[at..until].join("\n").parse::<Table>().is_ok();
    let until = (at + 1..=end).find(|until| whole(*until)).unwrap_or(at + 1);
    let comment = comment(&lines[until - 1]).to_owned();
    lines.splice(at..until, [format!("{written}{comment}")]);
}

/// The section that a line begins; a row of an array begins none.
fn header(line: &str) -> Option<Table> {
    line.trim_start().starts_with('[').then(|| line.parse().ok())?
}

/// The comment behind a value, with the space before it.
fn comment(line: &str) -> &str {
    let value = |at: &usize| {
        let (before, _) = line.split_at(*at);
        // A `#` may be part of a string.
        before.matches('"').count() % 2 == 0
    };
    let begin = line.match_indices('#').map(|(at, _)| at).find(value).unwrap_or(line.len());
    let space = line[..begin].len() - line[..begin].trim_end().len();
    if begin < line.len() { &line[begin - space..] } else { "" }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changes(text: &str) -> Table {
        text.parse().unwrap()
    }

    #[test]
    fn every_setting_is_described_with_its_default_and_its_range() {
        let settings = Settings::parse("p", "[fence]\nradius_m = 4\n").unwrap();
        let all = settings.described().unwrap();
        let count: usize = Table::try_from(Settings::default())
            .unwrap()
            .values()
            .map(|section| section.as_table().unwrap().len())
            .sum();
        assert_eq!(all.len(), count);
        assert!(all.iter().all(|it| !it.help.is_empty() && it.default.is_some()), "{all:?}");
        let named = |name: &str| all.iter().find(|it| it.name == name).unwrap();
        let radius = named("radius_m");
        assert_eq!((&radius.value, &radius.default), (&4.0.into(), &Some(10.0.into())));
        assert_eq!(named("tilt_max_deg").range, Some([1.0, 25.0]));
        assert!(named("climb_max_m_s").help.contains("full sticks"), "as the one before it");
    }

    #[test]
    fn a_change_leaves_the_rest_as_it_was_written() {
        let text = "# Our hall.\n[fence] # narrow\nradius_m = 3 # to the wall\n\n[tags]\nsurveyed = [\n  [1, 2],\n\
            [3, 4],\n]\nsize_m = 0.2\n";
        let wider = with_changes("p", text, &changes("[fence]\nradius_m = 4\nceiling_m = 2\n"));
        assert_eq!(
            wider.unwrap(),
            text.replace("radius_m = 3 #", "radius_m = 4 #")
                .replace("to the wall\n", "to the wall\nceiling_m = 2\n")
        );
        let tags = with_changes("p", text, &changes("[tags]\nsurveyed = [[0, 1]]\n")).unwrap();
        assert!(tags.contains("[tags]\nsurveyed = [[0, 1]]\nsize_m = 0.2\n"), "{tags}");
        let named = with_changes("p", text, &changes("[vehicle]\nname = \"a\"\n")).unwrap();
        assert_eq!(named, format!("{text}\n[vehicle]\nname = \"a\"\n"));
        assert_eq!(
            with_changes("p", "", &changes("[drone]\ngps = true\n")).unwrap(),
            "[drone]\ngps = true\n"
        );
    }

    #[test]
    fn what_is_wrong_is_not_written() {
        for wrong in [
            "[fence]\nradius_m = -4\n",
            "[fence]\nwidth = 4\n",
            "[hall]\nx = 1\n",
            "[drone]\ngps = 1\n",
            "fence = 4\n",
            "fence = []\n",
            "[hall]\n",
        ] {
            assert!(
                with_changes("p", "[fence]\nradius_m = 3\n", &changes(wrong)).is_err(),
                "{wrong}"
            );
        }
        assert!(with_changes("p", "[fence\n", &Table::new()).is_err());
        let said = with_changes("p", "", &changes("fence = 4\n")).unwrap_err().to_string();
        assert!(said.contains("integer `4`") && said.contains("fence"), "{said}");
    }
}
