//! Messages as lines of text: what the Rust bindings write, they read again, and they read nothing else.
//!
//! The bindings are compiled into a program, [`MAIN`], which is asked line by line. What it should answer is worked out here, by
//! code that it does not share.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use translator::interpreter::{Value, message_text};
use translator::parse_configuration;
use translator::syntax::ast::Performative;

use crate::generated::built_with;
use crate::harness::{Case, from_environment};

/// An agent whose messages have arguments of all kinds.
const TALKER: Case = Case {
    basics: "void show(int64_t); void who(peer); void place(place_t); void both(float, float);",
    types: "go(void);",
    sections: "structs { place_t { double x; float y; bool known; }; };
        peers { leader, wingman, scout };
        messages {
          tell at(double, float, place_t, peer) from any;
          tell low from wingman, scout;
          tell named(const char *) from leader;
          tell lastly(float, float, place_t) from any;
          achieve visit(int64_t, uint8_t, bool) from leader, 2;
        };",
    agent: "+at(_, _, P, Q)[source(S)] <- place(P); who(Q); who(S).
        +low[source(P)] <- who(P). -low[source(P)] <- who(P); who(P). +lastly(X, Y, _) <- both(X, Y). +!visit(X, _, true)[source(P)] <- show(X); who(P).",
};

/// Numbers cross by their bits, texts by their bytes.
const MAIN: &str = r#"
mod bindings { include!("bindings.rs"); }
use bindings::{Agent, Beliefs, Envelope, Environment, LONGEST_LINE, MESSAGES_VERSION, Message, Peer, PlaceT};

#[derive(Default)]
struct World(String);
impl Environment for World {
    fn update_beliefs(&mut self, _: &mut Beliefs<'_>) {}
    fn show(&mut self, x: i64) { self.0 += &format!(" show {x}"); }
    fn who(&mut self, peer: u8) { self.0 += &format!(" who {}", Peer::try_from(peer).unwrap()); }
    fn place(&mut self, place: PlaceT) { self.0 += &format!(" place {}", place_bits(place)); }
    fn both(&mut self, x: f32, y: f32) { self.0 += &format!(" both {x} {y}"); }
    fn send(&mut self, to: Peer, message: Message) { self.0 += &format!(" send {to} {message}"); }
}

fn place_bits(PlaceT { x, y, known }: PlaceT) -> String {
    format!("{:x} {:x} {known}", x.to_bits(), y.to_bits())
}

fn bits(Envelope { from, message }: Envelope) -> String {
    let said = match message {
        Message::TellAt(a, b, place, peer) =>
            format!("at {:x} {:x} {} {}", a.to_bits(), b.to_bits(), place_bits(place), peer as u8),
        Message::UntellAt => "unat".to_owned(),
        Message::TellLow => "low".to_owned(),
        Message::UntellLow => "unlow".to_owned(),
        Message::TellNamed(_) => "named".to_owned(),
        Message::UntellNamed => "unnamed".to_owned(),
        Message::TellLastly(a, b, place) =>
            format!("lastly {:x} {:x} {}", a.to_bits(), b.to_bits(), place_bits(place)),
        Message::UntellLastly => "unlastly".to_owned(),
        Message::AchieveVisit(a, b, c) => format!("visit {a} {b} {c}"),
        Message::UnachieveVisit => "unvisit".to_owned(),
    };
    format!("{} {said}", from as u8)
}

#[allow(clippy::cast_possible_truncation)]
fn message(kind: u64, words: &[u64]) -> Message {
    let float = |word: u64| f32::from_bits(word as u32);
    let place = PlaceT { x: f64::from_bits(words[2]), y: float(words[3]), known: words[4] % 2 == 1 };
    match kind {
        0 => {
            let peer = Peer::ALL[words[5] as usize % Peer::ALL.len()];
            Message::TellAt(f64::from_bits(words[0]), float(words[1]), place, peer)
        }
        1 => Message::UntellAt,
        2 => Message::TellLow,
        3 => Message::UntellLow,
        4 => Message::AchieveVisit(words[0] as i64, words[1] as u8, words[4] % 2 == 1),
        5 => Message::UnachieveVisit,
        6 => Message::TellLastly(float(words[0]), float(words[1]), place),
        _ => Message::TellNamed(c"a \"name\"\n\xff"),
    }
}

fn text(digits: &str) -> String {
    let digits = digits.as_bytes().chunks(2);
    let bytes = digits.map(|two| u8::from_str_radix(std::str::from_utf8(two).unwrap(), 16).unwrap());
    String::from_utf8_lossy(&bytes.collect::<Vec<u8>>()).into_owned()
}

fn main() {
    let mut agent = Agent::new(Peer::Wingman);
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let (command, rest) = line.split_once(' ').unwrap_or((line.as_str(), ""));
        match command {
            "known" => println!("{MESSAGES_VERSION:016x} {LONGEST_LINE}"),
            "write" => {
                let words: Vec<u64> = rest.split(' ').map(|word| word.parse().unwrap()).collect();
                let from = Peer::ALL[words[0] as usize];
                let envelope = Envelope { from, message: message(words[1], &words[2..]) };
                println!("{}|{}", bits(envelope), envelope.to_string().escape_debug());
            }
            "read" => match text(rest).parse::<Envelope>() {
                Ok(envelope) => println!("{}|{envelope}", bits(envelope)),
                Err(error) => println!("{error:?}|{error}"),
            },
            "message" => match text(rest).parse::<Message>() {
                Ok(message) => println!("{message}"),
                Err(error) => println!("{error:?}"),
            },
            "peer" => println!("{:?} {:?}", rest.parse::<Peer>(), Peer::try_from(rest.len() as u8)),
            "hear" => match text(rest).parse::<Envelope>() {
                Ok(Envelope { from, message }) => {
                    let mut world = World::default();
                    let accepted = agent.receive(&mut world, from, message);
                    agent.next_step(&mut world);
                    println!("{accepted}{}", world.0);
                }
                Err(error) => println!("{error:?}"),
            },
            other => panic!("{other}"),
        }
    }
}
"#;

/// The compiled program.
struct Bound {
    _folder: tempfile::TempDir,
    child: Child,
    questions: ChildStdin,
    answers: BufReader<ChildStdout>,
    version: String,
    longest: usize,
}

impl Bound {
    fn new() -> Self {
        let folder = built_with("", &TALKER, MAIN);
        let mut program = Command::new(folder.path().join("main"));
        let mut child = program.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let questions = child.stdin.take().unwrap();
        let answers = BufReader::new(child.stdout.take().unwrap());
        let (version, longest) = (String::new(), 0);
        let mut bound = Self { _folder: folder, child, questions, answers, version, longest };
        let known = bound.ask("known");
        let (version, longest) = known.split_once(' ').unwrap();
        (bound.version, bound.longest) = (version.to_owned(), longest.parse().unwrap());
        bound
    }

    fn ask(&mut self, question: &str) -> String {
        writeln!(self.questions, "{question}").unwrap();
        self.questions.flush().unwrap();
        let mut answer = String::new();
        self.answers.read_line(&mut answer).unwrap();
        assert!(answer.ends_with('\n'), "it has ended after {question}: {answer}");
        answer.trim_end_matches('\n').to_owned()
    }

    fn ask_of(&mut self, command: &str, bytes: &[u8]) -> String {
        let mut question = format!("{command} ");
        for byte in bytes {
            // Writing to a string cannot fail.
            _ = write!(question, "{byte:02x}");
        }
        self.ask(&question)
    }

    /// What it reads in a line: the bits of the values and the line that it would write, or the error and its text.
    fn read(&mut self, line: impl AsRef<[u8]>) -> (String, String) {
        let answer = self.ask_of("read", line.as_ref());
        let (bits, text) = answer.split_once('|').unwrap();
        (bits.to_owned(), text.to_owned())
    }

    /// What it reads in a line of its own version.
    fn read_said(&mut self, said: &str) -> String {
        let line = format!("{} {said}", self.version);
        self.read(line).0
    }
}

impl Drop for Bound {
    fn drop(&mut self) {
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

/// Whether an answer is an error.
fn is_error(bits: &str) -> bool {
    bits.starts_with(|c: char| c.is_ascii_uppercase())
}

/// A message of [`TALKER`] that can be read, by its sender, its number in `message` of [`MAIN`], and the words that its
/// arguments are made of.
#[derive(Debug, Clone)]
struct Said {
    from: usize,
    kind: usize,
    words: [u64; 6],
}

impl Said {
    fn any() -> impl Strategy<Value = Self> {
        // Numbers at the edges, and those that people write.
        let edges = [0.0, -0.0, 1.5, f64::MAX, f64::MIN_POSITIVE, 5e-324, 0.1, 1e16, f64::NAN];
        let edges = edges.into_iter().chain([f64::INFINITY, f64::NEG_INFINITY]);
        let edges = edges.map(f64::to_bits);
        let narrow = [0.1_f32, -0.0, f32::MAX, f32::MIN_POSITIVE, f32::NAN, f32::INFINITY, 1e-45];
        let narrow = narrow.map(|number| u64::from(number.to_bits()));
        let special = [0x7ff0_0000_0000_0001, u64::MAX, 0xffc0_0001, 1 << 63, (1 << 63) - 1];
        let all: Vec<u64> = edges.chain(narrow).chain(special).collect();
        let word = prop_oneof![
            2 => any::<u64>(),
            2 => prop::sample::select(all),
            1 => any::<f32>().prop_map(|number| f64::from(number).to_bits()),
            1 => 0..300_u64,
        ];
        (0..3_usize, 0..7_usize, prop::array::uniform6(word)).prop_map(|(from, kind, words)| Self {
            from,
            kind,
            words,
        })
    }

    fn question(&self) -> String {
        let Self { from, kind, words } = self;
        let words: Vec<String> = words.iter().map(u64::to_string).collect();
        format!("write {from} {kind} {}", words.join(" "))
    }

    fn narrow(&self, word: usize) -> f32 {
        f32::from_bits(u32::try_from(self.words[word] & u64::from(u32::MAX)).unwrap())
    }

    /// What it says: numbers of both kinds, whether they are known, and so on.
    fn values(&self) -> Vec<Value> {
        let words = &self.words;
        let flag = Value::Bool(words[4] % 2 == 1);
        let wide = |word: usize| Value::Float(f64::from_bits(words[word]));
        let narrow = |word: usize| Value::Float(self.narrow(word).into());
        let place = Value::Struct(vec![wide(2), narrow(3), flag.clone()]);
        let whole = |number: i128| Value::Integer(number);
        match self.kind {
            0 => vec![wide(0), narrow(1), place, whole((words[5] % 3).into())],
            4 => {
                let signed = i64::from_le_bytes(words[0].to_le_bytes());
                vec![whole(signed.into()), whole((words[1] & 0xff).into()), flag]
            }
            6 => vec![narrow(0), narrow(1), place],
            _ => Vec::new(),
        }
    }

    fn head(&self) -> (Performative, &'static str) {
        [
            (Performative::Tell, "at"),
            (Performative::Untell, "at"),
            (Performative::Tell, "low"),
            (Performative::Untell, "low"),
            (Performative::Achieve, "visit"),
            (Performative::Unachieve, "visit"),
            (Performative::Tell, "lastly"),
        ][self.kind]
    }
}

/// Runs a property of lines, with a program that is compiled once.
fn check<S: Strategy>(
    strategy: &S,
    property: impl Fn(&mut Bound, S::Value) -> Result<(), TestCaseError>,
) {
    let cases = from_environment("ASL2C_LINES", 3000);
    let bound = RefCell::new(Bound::new());
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let result =
        TestRunner::new(config).run(strategy, |value| property(&mut bound.borrow_mut(), value));
    result.unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn what_is_written_is_read_again_bit_for_bit() {
    let configuration = parse_configuration("agent.conf", &TALKER.configuration("")).unwrap();
    let declared = configuration.declarations();
    let version = declared.messages_version().unwrap().to_string();
    check(&Said::any(), |bound, said| {
        let answer = bound.ask(&said.question());
        let (bits, line) = answer.split_once('|').unwrap();
        prop_assert!(line.len() <= bound.longest, "{}", line);
        prop_assert!(line.is_ascii() && !line.contains(char::is_control), "{}", line);
        // The interpreter has a text form of its own. It does not know the bits of a not-a-number.
        let peer = &declared.peers[said.from].text;
        let (performative, name) = said.head();
        let expected = message_text(declared, performative, name, &said.values());
        let expected = format!("{version} {peer} {expected}");
        let plain: String =
            line.split("nan:").enumerate().fold(String::new(), |text, (index, part)| {
                let digits = part.chars().take_while(char::is_ascii_hexdigit).count();
                if index == 0 { part.to_owned() } else { format!("{text}nan{}", &part[digits..]) }
            });
        prop_assert_eq!(&plain, &expected);
        let (again, rewritten) = bound.read(line);
        prop_assert_eq!(&again, bits);
        prop_assert_eq!(rewritten, line);
        Ok(())
    });
}

/// The parts of a line between signs that have a meaning, and those signs.
fn parts(line: &str) -> Vec<&str> {
    line.split_inclusive([' ', ',', '(', ')', '{', '}'])
        .flat_map(|part| {
            let end = part.trim_end_matches([' ', ',', '(', ')', '{', '}']).len();
            [&part[..end], &part[end..]]
        })
        .collect()
}

/// Whether two lines differ in the spelling of numbers only.
fn are_same(one: &str, other: &str) -> bool {
    let (one, other) = (parts(one), parts(other));
    let is_same = |(one, other): (&&str, &&str)| {
        let bits = |text: &str| text.parse::<f64>().map(f64::to_bits);
        one == other || matches!((bits(one), bits(other)), (Ok(one), Ok(other)) if one == other)
            // A number may be single.
            || matches!((one.parse::<f32>(), other.parse::<f32>()), (Ok(one), Ok(other)) if one.to_bits() == other.to_bits())
    };
    one.len() == other.len() && one.iter().zip(&other).all(is_same)
}

#[test]
fn a_damaged_line_is_refused_or_means_what_it_says() {
    let signs = prop::sample::select(b" ,(){}0123456789abcdefnai-+.:eE_x\n\0\xc3\xa9".as_slice());
    let damage = (0..3_u8, any::<prop::sample::Index>(), signs);
    let strategy = (Said::any(), prop::collection::vec(damage, 1..4));
    let read = std::cell::Cell::new(0);
    check(&strategy, |bound, (said, damages)| {
        let answer = bound.ask(&said.question());
        let (_, line) = answer.split_once('|').unwrap();
        let mut bytes = line.as_bytes().to_vec();
        for (kind, place, sign) in damages {
            let place = place.index(bytes.len());
            match kind {
                0 => bytes[place] = sign,
                1 => bytes.insert(place, sign),
                _ => _ = bytes.remove(place),
            }
        }
        let (bits, text) = bound.read(&bytes);
        if !is_error(&bits) {
            read.set(read.get() + 1);
            let damaged = String::from_utf8(bytes).unwrap();
            prop_assert!(are_same(&damaged, &text), "{} was read as {}", damaged, text);
        }
        Ok(())
    });
    // Some digits of numbers were exchanged, and otherwise this says nothing.
    assert!(read.get() > 0);
}

#[test]
fn a_truncated_line_is_refused() {
    let strategy = Said::any();
    check(&strategy, |bound, said| {
        let answer = bound.ask(&said.question());
        let (_, line) = answer.split_once('|').unwrap();
        for end in 0..line.len() {
            let (bits, _) = bound.read(&line[..end]);
            prop_assert!(is_error(&bits), "{} was read as {}", &line[..end], bits);
        }
        for behind in [" ", "\n", "\r\n", ",", ")", "x", "\0", " tell low"] {
            let (bits, _) = bound.read(format!("{line}{behind}"));
            prop_assert!(is_error(&bits), "{}{:?} was read as {}", line, behind, bits);
        }
        Ok(())
    });
}

#[test]
fn any_bytes_are_refused() {
    let begun = prop_oneof![
        Just(""),
        Just("V leader "),
        Just("V scout tell at("),
        Just("V leader achieve visit("),
        Just("V wingman tell at(1.0, 2.0, {1.0, "),
    ];
    let strategy = (begun, prop::collection::vec(any::<u8>(), 0..200));
    check(&strategy, |bound, (begun, bytes)| {
        let mut line = begun.replace('V', &bound.version).into_bytes();
        line.extend(bytes);
        let (bits, _) = bound.read(&line);
        prop_assert!(is_error(&bits), "{:?} was read as {}", line, bits);
        Ok(())
    });
}

/// Lines and what is read of them; `V` is the version.
#[test]
fn errors_say_what_is_wrong_and_where() {
    let bound = &mut Bound::new();
    let place = "{1.0, 2.0, true}";
    for (said, expected) in [
        ("leader tell low", "0 low".to_owned()),
        ("pilot tell low", "UnknownPeer { column: 18 }".to_owned()),
        (" leader tell low", "UnknownPeer { column: 18 }".to_owned()),
        ("Leader tell low", "UnknownPeer { column: 18 }".to_owned()),
        ("leaders tell low", "UnknownPeer { column: 18 }".to_owned()),
        ("", "UnknownPeer { column: 18 }".to_owned()),
        ("leader", "UnknownMessage { column: 24 }".to_owned()),
        ("leader ", "UnknownMessage { column: 25 }".to_owned()),
        ("leader tell", "UnknownMessage { column: 25 }".to_owned()),
        ("leader  tell low", "UnknownMessage { column: 25 }".to_owned()),
        ("leader tell  low", "UnknownMessage { column: 25 }".to_owned()),
        ("leader tell high", "UnknownMessage { column: 25 }".to_owned()),
        ("leader achieve low", "UnknownMessage { column: 25 }".to_owned()),
        ("leader tell low ", "Trailing { column: 33 }".to_owned()),
        ("leader tell low()", "Trailing { column: 33 }".to_owned()),
        ("leader tell lowly", "UnknownMessage { column: 25 }".to_owned()),
        ("leader achieve visit", "WrongArgument { column: 38 }".to_owned()),
        ("leader achieve visit()", "WrongArgument { column: 39 }".to_owned()),
        ("leader achieve visit (1, 2, true)", "WrongArgument { column: 38 }".to_owned()),
        ("leader achieve visit(1, 2, true)", "0 visit 1 2 true".to_owned()),
        ("leader achieve visit(1,2, true)", "WrongArgument { column: 40 }".to_owned()),
        ("leader achieve visit(1, 2)", "WrongArgument { column: 43 }".to_owned()),
        ("leader achieve visit(1, 2, yes)", "WrongArgument { column: 45 }".to_owned()),
        ("leader achieve visit(1, 2, True)", "WrongArgument { column: 45 }".to_owned()),
        ("leader achieve visit(1, 2, 1)", "WrongArgument { column: 45 }".to_owned()),
        ("leader achieve visit(1, 256, true)", "WrongArgument { column: 42 }".to_owned()),
        ("leader achieve visit(1, -1, true)", "WrongArgument { column: 42 }".to_owned()),
        ("leader achieve visit(1, 2, true", "WrongArgument { column: 49 }".to_owned()),
        ("leader achieve visit(1, 2, true))", "Trailing { column: 50 }".to_owned()),
        ("leader achieve visit(1, 2, true, 3)", "WrongArgument { column: 49 }".to_owned()),
        ("leader unachieve visit(1, 2, true)", "Trailing { column: 40 }".to_owned()),
        (
            &format!("leader tell at(1.0, 2.0, {place}, self)"),
            "WrongArgument { column: 61 }".to_owned(),
        ),
        (
            &format!("leader tell at(1.0, 2.0, {place}, 1)"),
            "WrongArgument { column: 61 }".to_owned(),
        ),
        ("leader tell at(1.0, 2.0, {1.0, 2.0}, scout)", "WrongArgument { column: 52 }".to_owned()),
        (
            "leader tell at(1.0, 2.0, 1.0, 2.0, true, scout)",
            "WrongArgument { column: 41 }".to_owned(),
        ),
        ("leader tell named(\"x\")", "Unreadable { column: 25 }".to_owned()),
        ("leader untell named", "0 unnamed".to_owned()),
    ] {
        assert_eq!(bound.read_said(said), expected, "{said}");
    }
    // A message alone, without version and sender.
    assert_eq!(
        bound.ask_of("message", b"achieve visit(-7, 0, false)"),
        "achieve visit(-7, 0, false)"
    );
    assert_eq!(
        bound.ask_of("message", b"achieve visit(-7, x, false)"),
        "WrongArgument { column: 19 }"
    );
    assert_eq!(bound.ask("peer leader"), "Ok(Leader) Err(6)");
    assert_eq!(bound.ask("peer x"), "Err(UnknownPeer { column: 1 }) Ok(Wingman)");
    // A string is written in one line.
    let written = bound.ask("write 0 7 0 0 0 0 0 0");
    let expected = r#"leader tell named(\"a \\\"name\\\"\\n\\xff\")"#;
    assert!(written.ends_with(expected), "{written}");
}

#[test]
fn agents_of_other_versions_refuse_each_other() {
    let bound = &mut Bound::new();
    let version = bound.version.clone();
    let ours = u64::from_str_radix(&version, 16).unwrap();
    let long = "x".repeat(2000);
    // An older one is no better than a newer one: they have no order.
    let others = [ours - 1, ours + 1, 0, u64::MAX];
    let rests = ["leader tell low", "pilot tell low", "", &long];
    for (theirs, rest) in others.into_iter().flat_map(|other| rests.map(|rest| (other, rest))) {
        let (error, text) = bound.read(format!("{theirs:016x} {rest}"));
        assert_eq!(error, format!("OtherVersion {{ ours: {ours}, theirs: {theirs} }}"));
        let expected =
            format!("it is of version {theirs:016x} of the messages, and not of {version}");
        assert_eq!(text, expected);
    }
    let upper = version.to_uppercase();
    assert_ne!(upper, version);
    for line in [
        String::new(),
        version.clone(),
        format!(" {version} leader tell low"),
        format!("{upper} leader tell low"),
        format!("0{version} leader tell low"),
        format!("{} leader tell low", &version[1..]),
        format!("+{} leader tell low", &version[1..]),
        format!("{version}\tleader tell low"),
        format!("{version}: leader tell low"),
        "leader tell low".to_owned(),
        long.clone(),
        "é".repeat(16),
    ] {
        assert_eq!(bound.read(&line).0, "NoVersion", "{line}");
    }
    // The longest line is read, and none that is longer.
    let longest = "wingman tell at(-2.2250738585072014e-308, -9999999000000000.0, {-2.2250738585072014e-308, \
        -9999999000000000.0, false}, wingman)";
    assert_eq!(17 + longest.len(), bound.longest);
    assert!(!is_error(&bound.read_said(longest)));
    let longer = format!("{version} {}", longest.replace("e-308,", "1e-308,"));
    assert_eq!(bound.read(&longer).0, format!("TooLong {{ bytes: {} }}", longer.len()));
    let many = format!("{version} leader achieve visit({}, 1, true)", "9".repeat(1 << 20));
    assert_eq!(bound.read(&many).0, format!("TooLong {{ bytes: {} }}", many.len()));
    let error = bound.ask_of("message", "9".repeat(1000).as_bytes());
    assert_eq!(error, "TooLong { bytes: 1000 }");
}

/// Other programs may write the same number in another way, but not another number.
#[test]
fn numbers_are_read_in_any_decimal_form() {
    let bound = &mut Bound::new();
    let mut read = |number: &str, narrow: &str| {
        let line = format!("leader tell at({number}, {narrow}, {{0, 0, true}}, leader)");
        bound.read_said(&line)
    };
    for (text, number) in [
        ("2", 2.0),
        ("2.0", 2.0),
        ("007.50", 7.5),
        ("-0", -0.0),
        ("-0.0", -0.0),
        ("1e3", 1e3),
        ("1E+3", 1e3),
        ("12.5e-7", 12.5e-7),
        ("1e-400", 0.0),
        ("1.7976931348623157e308", f64::MAX),
        ("inf", f64::INFINITY),
        ("-inf", f64::NEG_INFINITY),
        ("nan", f64::from_bits(0x7ff8_0000_0000_0000)),
        ("nan:fff8000000000000", f64::from_bits(0xfff8_0000_0000_0000)),
        ("nan:7ff0000000000001", f64::from_bits(0x7ff0_0000_0000_0001)),
    ] {
        let number = number.to_bits();
        let expected = format!("0 at {number:x} 7fc00000 0 0 true 0");
        assert_eq!(read(text, "nan"), expected, "{text}");
    }
    for (text, number) in [
        ("0.1", 0.1_f32),
        ("0.10000000149011612", 0.1),
        // A little above the middle of two numbers, which it is not rounded to before.
        ("1.00000005960464477539062500000001", 1.000_000_1),
        ("-1e-46", -0.0),
        ("3.4028235e38", f32::MAX),
        ("nan:ffc00001", f32::from_bits(0xffc0_0001)),
    ] {
        let expected = format!("0 at 0 {:x} 0 0 true 0", number.to_bits());
        assert_eq!(read("0", text), expected, "{text}");
    }
    for text in [
        "",
        "-",
        ".",
        "1.",
        ".5",
        "+1",
        "--1",
        "1e",
        "1e+",
        "e3",
        "1.e3",
        "1.5.2",
        "1e3e3",
        "1_000",
        "0x10",
        " 1",
        "1 ",
        "1f",
        "infinity",
        "+inf",
        "Inf",
        "NaN",
        "-nan",
        "nan:",
        "nan:7ff8000000000000",
        "nan:7ff0000000000000",
        "nan:0000000000000000",
        "nan:7ff800000000001",
        "nan:7FF8000000000001",
        "nan:+ff8000000000001",
        "nan:17ff8000000000001",
        "1e309",
        "-1e999",
        "١",
    ] {
        assert_eq!(read(text, "0"), "WrongArgument { column: 33 }", "{text}");
    }
    for text in ["1e39", "nan:7fc00000", "nan:7f800000", "nan:7ff8000000000001", "nan:0ffc00001"] {
        assert_eq!(read("0", text), "WrongArgument { column: 36 }", "{text}");
    }
    let mut visit = |number: &str, small: &str| {
        bound.read_said(&format!("leader achieve visit({number}, {small}, true)"))
    };
    for text in ["0", "-1", "9223372036854775807", "-9223372036854775808"] {
        assert_eq!(visit(text, "255"), format!("0 visit {text} 255 true"));
    }
    for text in
        ["-0", "+1", "01", "00", "-01", "1.0", "1e3", "9223372036854775808", "", "-", "1_0", "０"]
    {
        assert_eq!(visit(text, "1"), "WrongArgument { column: 39 }", "{text}");
    }
}

/// What arrives as a line has the effect of the call.
#[test]
fn a_line_reaches_the_agent() {
    let bound = &mut Bound::new();
    let version = bound.version.clone();
    let mut hear = |said: &str| bound.ask_of("hear", format!("{version} {said}").as_bytes());
    let at = "tell at(1.0, 2.0, {1.5, -0.0, true}, leader)";
    assert_eq!(
        hear(&format!("scout {at}")),
        "true place 3ff8000000000000 80000000 true who leader who scout"
    );
    // It is the agent's own name, or may not say this.
    assert_eq!(hear(&format!("wingman {at}")), "false");
    assert_eq!(hear("leader tell low"), "false");
    assert_eq!(hear("scout tell low"), "true who scout");
    assert_eq!(hear("scout untell low"), "true who scout who scout");
    // Values of the same type keep their order.
    assert_eq!(hear("leader tell lastly(1.5, -2.5, {0.0, 0.0, false})"), "true both 1.5 -2.5");
    assert_eq!(hear("leader achieve visit(-9, 1, true)"), "true show -9 who leader");
    assert_eq!(hear("leader achieve visit(-9, 1, false)"), "true");
    assert_eq!(hear("scout achieve visit(-9, 1, true)"), "false");
    assert_eq!(hear("leader unachieve visit"), "true");
    assert_eq!(hear("leader achieve visit(-9, 1, maybe)"), "WrongArgument { column: 46 }");
}

/// Bindings with few kinds of messages have no function that nobody calls.
#[test]
fn bindings_of_all_sorts_of_messages_pass_the_lints() {
    let talkers = [
        "tell low from any;",
        "tell at(int) from any;",
        "tell at(bool) from any;",
        "tell at(peer) from any;",
        "tell at(float) from any;",
        "tell at(double) from any;",
        "tell at(const char *) from any;",
        "tell at(const char *, double) from any; tell low from any;",
        "tell at(place_t) from any;",
        "tell at(place_t, place_t, uint64_t) from any; achieve go(place_t) from y;",
        "",
    ];
    for messages in talkers {
        let configuration = format!(
            "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; rust = bindings.rs; \
             instance = context; }};\nstructs {{ place_t {{ double x; bool y; }}; }};\npeers {{ x, y, err, error, none, ok }};\n\
             messages {{ {messages} }};\ntypes {{ g(void); s(int); }}; settables {{ s; }};"
        );
        let parsed = parse_configuration("a.conf", &configuration).unwrap();
        let translation = translator::translate(&parsed, "!g. +!g.").unwrap();
        let bindings = translation.files.iter().find(|file| file.name == "bindings.rs").unwrap();
        assert_eq!(bindings.text.contains("Message"), !messages.is_empty());
        let folder = tempfile::tempdir().unwrap();
        let text = format!("//! Bindings.\n{}", bindings.text);
        std::fs::write(folder.path().join("bindings.rs"), text).unwrap();
        let lints =
            ["warnings", "missing_docs", "unused_qualifications", "elided_lifetimes_in_paths"];
        let lints = lints.iter().flat_map(|lint| ["-D", lint]);
        let mut compile = Command::new("rustc");
        compile
            .args(["--edition", "2024", "--crate-type", "lib", "--emit", "metadata"])
            .args(lints);
        compile.args(["-D", "unreachable_pub", "bindings.rs"]).current_dir(folder.path());
        let output = compile.output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{messages}\n{errors}\n{}", bindings.text);
    }
}
