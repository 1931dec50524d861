//! What people must know to change a `pilot.toml`, and the change of a file of theirs.

use toml::{Table, Value};
use toml_edit::{DocumentMut, Item, Key, TableLike};

use super::fence::Fence;
use super::{DECLARED, Settings, SettingsError};

/// A setting with everything that is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Described {
    /// Its section.
    pub section: String,
    /// Its name there.
    pub name: String,
    /// What it is for, with its unit; if it has no text of its own, that of the setting before it.
    pub help: String,
    /// Least and largest number; `None` if it has no such range.
    pub range: Option<[f64; 2]>,
    /// Its default; `None` if it stands in place of another setting.
    pub default: Option<Value>,
    /// Its value in these settings.
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
    let refused = |why: String| SettingsError::Change(why);
    let mut document: DocumentMut =
        text.parse().map_err(|error: toml_edit::TomlError| refused(error.to_string()))?;
    for (section, values) in changes {
        let item = document.entry(section).or_insert_with(toml_edit::table);
        let no_section = || refused(format!("`{section}` is no section"));
        let table = item.as_table_like_mut().ok_or_else(no_section)?;
        for (name, value) in values.as_table().into_iter().flatten() {
            let mut written: toml_edit::Value = value
                .to_string()
                .parse()
                .map_err(|error: toml_edit::TomlError| refused(error.to_string()))?;
            let other = Fence::replaced_by(section, name);
            if let Some(other) = other.filter(|other| table.contains_key(other)) {
                rename(table, other, name);
            }
            match table.get_mut(name).and_then(Item::as_value_mut) {
                Some(old) => {
                    // The comment behind it.
                    written.decor_mut().clone_from(old.decor());
                    *old = written;
                }
                None => drop(table.insert(name, written.into())),
            }
        }
    }
    let mut changed = document.to_string();
    // The library ends each line in its own way.
    if text.contains("\r\n") && text.lines().count() == text.matches("\r\n").count() {
        changed = changed.replace('\n', "\r\n");
    }
    Settings::parse(path, &changed)?;
    Ok(changed)
}

/// Gives a value another name, at its place and with its comments.
fn rename(table: &mut dyn TableLike, from: &str, to: &str) {
    let names: Vec<Key> = table.iter().filter_map(|(name, _)| table.key(name).cloned()).collect();
    let all: Vec<(Key, Item)> =
        names.into_iter().filter_map(|key| Some((key.clone(), table.remove(&key)?))).collect();
    for (key, item) in all {
        let key = if key.get() == from { renamed(&key, to) } else { key };
        _ = table.entry_format(&key).or_insert(item);
    }
}

fn renamed(key: &Key, to: &str) -> Key {
    Key::new(to)
        .with_leaf_decor(key.leaf_decor().clone())
        .with_dotted_decor(key.dotted_decor().clone())
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
            .filter_map(|section| Some(section.as_table()?.len()))
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
    fn a_circle_and_a_polygon_replace_each_other() {
        let polygon = "[fence]\npolygon_m = [[-2, -2], [2, -2], [0, 2]]\n";
        let circle = "[fence]\nradius_m = 4\n";
        for (from, to) in [(polygon, circle), (circle, polygon)] {
            let changed = with_changes("p", from, &changes(to)).unwrap();
            assert_eq!(changed, to);
        }
        let hall = "[fence]\n# our hall\nradius_m = 4 # by Ann\nceiling_m = 2 # low\n";
        let changed = with_changes("p", hall, &changes(polygon)).unwrap();
        assert_eq!(
            changed,
            hall.replace("radius_m = 4", "polygon_m = [[-2, -2], [2, -2], [0, 2]]")
        );
        let inline =
            with_changes("p", "fence = { radius_m = 4, ceiling_m = 2 }\n", &changes(polygon));
        assert!(
            inline.unwrap().starts_with("fence = { polygon_m = [[-2, -2], [2, -2], [0, 2]], ceil")
        );
        let dotted = with_changes("p", "fence.radius_m = 4 # a\n", &changes(polygon)).unwrap();
        assert_eq!(dotted, "fence.polygon_m = [[-2, -2], [2, -2], [0, 2]] # a\n");
        let all = Settings::parse("p", polygon).unwrap().described().unwrap();
        let polygon = all.iter().find(|setting| setting.name == "polygon_m").unwrap();
        assert!(polygon.help.contains("corners"), "{polygon:?}");
    }

    #[test]
    fn lines_end_as_they_did() {
        let text = "# Our hall.\r\n[fence]\r\nradius_m = 3 # to the wall\r\n";
        let wider = with_changes("p", text, &changes("[fence]\nradius_m = 4\n")).unwrap();
        assert_eq!(wider, text.replace('3', "4"));
    }

    #[test]
    fn a_section_is_changed_as_it_was_written() {
        let wider = |text| with_changes("p", text, &changes("[fence]\nradius_m = 4\n")).unwrap();
        assert_eq!(
            wider("fence = { radius_m = 3, ceiling_m = 2 } # hall\n"),
            "fence = { radius_m = 4, ceiling_m = 2 } # hall\n"
        );
        assert_eq!(
            wider("fence.ceiling_m = 2\nfence.radius_m = 3 # hall\n"),
            "fence.ceiling_m = 2\nfence.radius_m = 4 # hall\n"
        );
        assert_eq!(wider("\"fence\" = {}\n"), "\"fence\" = { radius_m = 4 }\n");
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
