//! The pages for people: their links lead somewhere, and what they tell to type can be typed.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::processes::program;

const PROGRAMS: [&str; 3] = ["ardrone-pilot", "mock-drone", "asl2c"];
/// Folders of the repository that a build or a flight makes.
const MADE: [&str; 2] = ["target", "flights"];

fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// Each page by its path in the repository.
fn pages() -> BTreeMap<String, String> {
    let in_docs = std::fs::read_dir(repository().join("docs")).unwrap();
    let in_docs = in_docs.map(|file| format!("docs/{}", file.unwrap().file_name().display()));
    let others = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"];
    let others = others.into_iter().chain(["ardrone-link/README.md"]).map(str::to_owned);
    let names =
        others.chain(in_docs.filter(|name| Path::new(name).extension() == Some("md".as_ref())));
    let text = |name: &str| std::fs::read_to_string(repository().join(name)).unwrap();
    names.map(|name| (name.clone(), text(&name))).collect()
}

struct Line<'a> {
    number: usize,
    /// The kind of the block of code that it is in.
    code: Option<&'a str>,
    text: &'a str,
}

/// The lines of a page, but for those where a block of code begins or ends.
fn lines(page: &str) -> impl Iterator<Item = Line<'_>> {
    let mut code = None;
    page.lines().enumerate().filter_map(move |(at, line)| {
        let text = line.trim_start();
        if let Some(kind) = text.strip_prefix("```") {
            code = code.is_none().then_some(kind);
            return None;
        }
        Some(Line { number: at + 1, code, text })
    })
}

/// The odd pieces of a line are code.
fn pieces(line: &str) -> impl Iterator<Item = (bool, &str)> {
    line.split('`').enumerate().map(|(at, piece)| (at % 2 == 1, piece))
}

/// The targets of links in a line, images among them.
fn targets(line: &str) -> Vec<String> {
    let text: String = pieces(line).filter(|(is_code, _)| !is_code).map(|(_, text)| text).collect();
    let behind = text.split("](").skip(1);
    let linked = behind.map(|rest| rest.split(')').next().unwrap_or_default().to_owned());
    let included = text.strip_prefix("{{#include ").and_then(|rest| rest.strip_suffix("}}"));
    linked.chain(included.map(str::to_owned)).collect()
}

/// What a link can name in a page: its headings, as both the book and code hosts write them, and `<a id="NAME"></a>`.
fn anchors(page: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    for Line { text, .. } in lines(page).filter(|line| line.code.is_none()) {
        let marks = text.split("<a id=\"").skip(1);
        anchors.extend(marks.filter_map(|rest| Some(rest.split_once("\"></a>")?.0.to_owned())));
        let heading = text.trim_start_matches('#');
        if heading.len() == text.len() || !heading.starts_with(' ') {
            continue;
        }
        let kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
        let anchor: String = heading.trim().chars().filter(kept).collect();
        let anchor = anchor.to_lowercase().replace(' ', "-");
        let again = (1..).map(|number| format!("{anchor}-{number}"));
        let mut names = std::iter::once(anchor.clone()).chain(again);
        anchors.extend(names.find(|name| !anchors.contains(name)));
    }
    anchors
}

/// Whether a link in the page of this name leads somewhere, to its place in the page too.
fn leads(name: &str, target: &str) -> bool {
    let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
    let folder = repository().join(name).parent().unwrap().to_owned();
    let file = if path.is_empty() { repository().join(name) } else { folder.join(path) };
    let has_place =
        || std::fs::read_to_string(&file).is_ok_and(|page| anchors(&page).contains(anchor));
    target.contains("://") || file.exists() && (anchor.is_empty() || has_place())
}

/// Each step that tests assumptions can be linked to, and each assumption with an experiment does so.
#[test]
fn the_safety_case_leads_to_the_steps_of_the_first_flight() {
    let page = |name: &str| std::fs::read_to_string(repository().join(name)).unwrap();
    let anchors = anchors(&page("docs/first-flight.md"));
    let steps = anchors.iter().filter(|anchor| anchor.starts_with("step-")).count();
    assert_eq!(steps, 25);
    let case = page("docs/safety-case.md");
    assert!(!case.contains("(first-flight.md)"), "a link to no step");
    assert_eq!(case.matches("(first-flight.md#step-").count(), 18);
}

#[test]
fn what_a_page_names_is_there() {
    let mut missing = Vec::new();
    for (name, page) in &pages() {
        for Line { number, text, .. } in lines(page).filter(|line| line.code.is_none()) {
            let broken = targets(text).into_iter().filter(|target| !leads(name, target));
            missing.extend(broken.map(|target| format!("{name}:{number}: {target}")));
            // What the changelog tells of earlier versions need not be there any more.
            let named = pieces(text).filter(|(is_code, _)| *is_code && name != "CHANGELOG.md");
            let named = named.filter(|(_, word)| is_missing(word));
            missing.extend(named.map(|(_, word)| format!("{name}:{number}: {word}")));
        }
    }
    assert!(missing.is_empty(), "not there:\n{}", missing.join("\n"));
}

#[test]
fn each_page_is_in_the_book_and_the_first_one_is_short() {
    let pages = pages();
    let listed: Vec<String> = pages["docs/SUMMARY.md"].lines().flat_map(targets).collect();
    for page in pages.keys().filter_map(|name| name.strip_prefix("docs/")) {
        let times = listed.iter().filter(|target| *target == page).count();
        assert_eq!(times, usize::from(page != "SUMMARY.md"), "{page} in docs/SUMMARY.md");
    }
    assert!(pages["README.md"].lines().count() <= 120, "README.md has more than 120 lines");
}

/// The pictures of a folder of `docs`, and of those in it.
fn pictures_in(folder: &str) -> BTreeSet<String> {
    let files = std::fs::read_dir(repository().join(folder)).unwrap().map(Result::unwrap);
    let pictures = files.flat_map(|file| {
        let name = format!("{folder}/{}", file.file_name().display());
        if file.path().is_dir() { pictures_in(&name) } else { BTreeSet::from([name]) }
    });
    pictures.filter(|name| is_picture(name)).collect()
}

fn is_picture(name: &str) -> bool {
    [".png", ".svg"].iter().any(|ending| name.ends_with(ending))
}

/// What is drawn by tests whose names begin with `the_picture`: it is named in them.
fn drawn() -> BTreeSet<String> {
    let tests = std::fs::read_dir(repository().join("tests/system")).unwrap();
    let mut drawn = BTreeSet::new();
    for file in tests.map(|file| file.unwrap().path()).filter(|file| file.is_file()) {
        let source = std::fs::read_to_string(file).unwrap();
        let tests = source.split("\nfn ").filter(|test| test.starts_with("the_picture"));
        let bodies = tests.filter_map(|test| test.split("\n}\n").next());
        let named =
            bodies.flat_map(|body| body.split('"')).filter_map(|word| word.strip_prefix("../"));
        drawn.extend(named.filter(|name| is_picture(name)).map(str::to_owned));
    }
    drawn
}

/// What the glossary names as a field has this name in JSON and in the log.
#[test]
fn fields_have_the_names_of_the_glossary() {
    let pages = pages();
    let words = pages["docs/glossary.md"].lines().flat_map(pieces);
    let fields = words.filter(|(is_code, word)| *is_code && word.ends_with("_m"));
    let fields: Vec<&str> = fields.map(|(_, word)| word).collect();
    assert_eq!(fields, ["uncertainty_m", "height_uncertainty_m"]);
    for source in ["json.rs", "recording/schemas/tick.json"] {
        let text = std::fs::read_to_string(repository().join("ardrone-pilot/src").join(source));
        let missing =
            fields.iter().find(|field| !text.as_ref().unwrap().contains(&format!("\"{field}\"")));
        assert_eq!(missing, None, "{source}");
    }
}

#[test]
fn each_picture_is_shown_and_can_be_drawn_again() {
    let mut shown = BTreeSet::new();
    for (name, page) in pages() {
        let folder =
            name.rsplit_once('/').map(|(folder, _)| format!("{folder}/")).unwrap_or_default();
        let of_page =
            lines(&page).filter(|line| line.code.is_none()).flat_map(|line| targets(line.text));
        shown.extend(
            of_page.filter(|target| is_picture(target)).map(|target| folder.clone() + &target),
        );
    }
    let there = pictures_in("docs");
    assert_eq!(shown, there, "what pages show, and what is there");
    assert_eq!(
        drawn(),
        there,
        "what tests draw whose names begin with the_picture, and what is there"
    );
}

/// A command line as words, without what a shell does around it.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut quote) = (vec![String::new()], None);
    for c in line.chars() {
        match quote {
            None if c == '#' && words.last().is_some_and(String::is_empty) => break,
            None if c.is_whitespace() => words.push(String::new()),
            None if c == '\'' || c == '"' => quote = Some(c),
            Some(end) if c == end => quote = None,
            _ => words.last_mut().unwrap().push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The command lines of a page that are to be typed, each with its number.
fn command_lines(page: &str) -> impl Iterator<Item = (usize, Vec<String>)> {
    lines(page).filter_map(|line| {
        // Elsewhere what is printed is shown behind it.
        let all = (line.code? == "sh").then_some(line.text);
        Some((line.number, words(line.text.strip_prefix("$ ").or(all)?)))
    })
}

/// What a program of ours is given, if it is started here, also by cargo.
fn started(words: &[String]) -> Option<(&'static str, &[String])> {
    let words = &words[words.iter().take_while(|word| word.contains('=')).count()..];
    let known = |word: &String| PROGRAMS.into_iter().find(|name| name == word);
    let first = words.first()?;
    if let Some(name) = known(first) {
        return Some((name, &words[1..]));
    }
    let (cargo, given) = match words.iter().position(|word| word == "--") {
        Some(at) => (&words[..at], &words[at + 1..]),
        None => (words, &[][..]),
    };
    let runs = first == "cargo" && cargo.iter().any(|word| word == "run");
    let other = cargo.iter().any(|word| word == "--example");
    cargo.iter().find_map(known).filter(|_| runs && !other).map(|name| (name, given))
}

/// What `--help` tells: options with the number of their values, commands, and how many other words there may be.
#[derive(Default)]
struct Help {
    options: BTreeMap<String, usize>,
    commands: BTreeSet<String>,
    others: usize,
}

impl Help {
    fn of(called: &[&str]) -> Self {
        let output = program(called[0]).args(&called[1..]).arg("--help").output().unwrap();
        assert!(output.status.success(), "{called:?} --help");
        let (mut help, mut section) = (Self::default(), String::new());
        for line in String::from_utf8(output.stdout).unwrap().lines() {
            let text = line.trim();
            match (section.as_str(), line.len() - line.trim_start().len()) {
                (_, 0) if !line.is_empty() => text.clone_into(&mut section),
                ("Commands:", 2) => {
                    help.commands.extend(text.split(' ').next().map(str::to_owned));
                }
                ("Arguments:", 2) => help.others += if text.contains("...") { 1000 } else { 1 },
                (_, 1..) if text.starts_with('-') => {
                    let definition = text.split("  ").next().unwrap_or_default();
                    // A value that may be left out stands in brackets.
                    let values = definition.matches(" <").count();
                    let names = definition.split([' ', ',']).filter(|name| name.starts_with('-'));
                    help.options.extend(names.map(|name| (name.to_owned(), values)));
                }
                _ => {}
            }
        }
        help
    }
}

/// What a program would not take of these words.
fn refused(name: &'static str, given: &[String]) -> Option<String> {
    let mut called = vec![name];
    let mut help = Help::of(&called);
    let mut words = given.iter().map(String::as_str).peekable();
    while let Some(word) = words.next() {
        let (option, value) = word.split_once('=').unwrap_or((word, ""));
        if let Some(values) = help.options.get(option) {
            let behind = values.saturating_sub(usize::from(!value.is_empty()));
            if words.by_ref().take(behind).count() < behind {
                return Some(format!("{word} has too few values"));
            }
            // One that may be left out is an address.
            words.next_if(|next| *values == 0 && next.contains(':'));
        } else if help.commands.contains(word) {
            called.push(word);
            help = Help::of(&called);
        } else if help.others > 0
            && (word == "-" || !word.starts_with('-'))
            // A command that is not there is no file.
            && (help.commands.is_empty() || word.contains('.'))
        {
            help.others -= 1;
        } else {
            return Some(format!("{} does not take {word}", called.join(" ")));
        }
    }
    None
}

/// Whether this is the path of a file or folder of the repository that is not there.
fn is_missing(word: &str) -> bool {
    let path = word.rsplit('=').next().unwrap_or(word);
    let Some((folder, _)) = path.split_once('/') else { return false };
    let is_ours = !folder.is_empty() && !folder.starts_with('.') && !MADE.contains(&folder);
    // Where a name stands for many, there is no such file.
    let is_one = !path.contains(['*', '{', '<', ' ', '…']) && !path.contains("NAME");
    is_ours && is_one && repository().join(folder).is_dir() && !repository().join(path).exists()
}

#[test]
fn what_is_to_be_typed_can_be_typed() {
    let (mut wrong, mut checked) = (Vec::new(), 0);
    for (name, page) in &pages() {
        for (at, words) in command_lines(page) {
            let missing = words.iter().filter(|word| is_missing(word));
            wrong.extend(missing.map(|word| format!("{name}:{at}: there is no {word}")));
            for command in words.split(|word| ["|", "&&", ">"].contains(&word.as_str())) {
                let Some((program, given)) = started(command) else { continue };
                checked += 1;
                wrong.extend(refused(program, given).map(|why| format!("{name}:{at}: {why}")));
            }
        }
    }
    assert!(wrong.is_empty(), "cannot be typed:\n{}", wrong.join("\n"));
    assert!(checked > 60, "only {checked} commands were found");
}
