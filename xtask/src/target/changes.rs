//! Generated C in which one character is another one.

/// Texts that are replaced; each differs from its replacement by one character.
const REPLACED: [(&str, &str); 8] = [
    (" < ", " > "),
    (" > ", " < "),
    (" <= ", " >= "),
    (" >= ", " <= "),
    (" == ", " != "),
    (" != ", " == "),
    (" + ", " - "),
    (" - ", " + "),
];

/// At most this many changes, at even distances in the text, without comments and preprocessor lines.
pub(super) fn changes(c: &str, most: usize) -> Vec<String> {
    let mut places = Vec::new();
    let mut start = 0;
    for line in c.split_inclusive('\n') {
        if !line.trim_start().starts_with(['/', '*', '#']) {
            for (from, to) in REPLACED {
                places.extend(line.match_indices(from).map(|(at, _)| (start + at, from, to)));
            }
        }
        start += line.len();
    }
    places.sort_unstable();
    let distance = places.len().div_ceil(most.max(1)).max(1);
    let changed = |(at, from, to): &(usize, &str, &str)| {
        format!("{}{to}{}", &c[..*at], &c[at + from.len()..])
    };
    places.iter().step_by(distance).map(changed).collect()
}

#[cfg(test)]
mod tests {
    use super::changes;

    #[test]
    fn each_change_is_one_character_of_code() {
        let c = "/* a < b */\n#if A < B\nif (a < b) {\n    c = d - (e + f);\n}\n";
        let all = changes(c, 10);
        assert_eq!(all.len(), 3);
        for changed in &all {
            let other = changed.bytes().zip(c.bytes()).filter(|(one, other)| one != other);
            assert_eq!((other.count(), changed.len()), (1, c.len()));
        }
        assert!(all[0].contains("if (a > b)"));
        assert_eq!(changes(c, 2).len(), 2);
        assert!(changes("", 2).is_empty());
    }
}
