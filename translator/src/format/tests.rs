use proptest::test_runner::{Config, TestRunner};

use super::*;
use crate::system::ParsedSystem;

#[track_caller]
fn check(text: &str, expected: &str) {
    let formatted = formatted(text).unwrap();
    assert_eq!(formatted, expected);
    assert_eq!(super::formatted(expected).unwrap(), expected, "not stable");
}

#[test]
fn blanks_are_normalized() {
    check(
        "  b ( 1,-2.5 ).limit( 20 ) . ! start( \"a  b\" ).\n\n\n@ go [ req( \"R-1\" ),req(\"R-2\") ] + ! start ( _ ):b(X,Y)&not(c)|\
         X+1< -3.+!a<-f(X*-Y,- 1,--1);Y=g ( ) mod 2;+c;-c(_) ; !!h;?b(X);. wait(2);!h [ deadline ( 5 ) ] .",
        "b(1, -2.5).\nlimit(20).\n!start(\"a  b\").\n\n@go[req(\"R-1\"), req(\"R-2\")]\n+!start(_) : b(X, Y) & not (c) | X + 1 < -3.\n\
         +!a <- f(X * -Y, - 1, --1); Y = g() mod 2; +c; -c(_); !!h; ?b(X); .wait(2); !h[deadline(5)].\n",
    );
}

#[test]
fn the_author_decides_where_lines_are_broken() {
    check("+!a\n:\nb &\nc\n<-\nd\n;\ne\n.", "+!a : b\n    & c\n  <- d;\n     e.\n");
    check("+!a : b <-\n  d; e; f.", "+!a : b\n  <- d; e; f.\n");
    check("+!a : b <- d; e;\n f.", "+!a : b\n  <- d;\n     e;\n     f.\n");
    check("+!a : b\n | c <- d; e.", "+!a : b\n    | c\n  <- d; e.\n");
    check("+!a <- f(1,\n2).", "+!a <- f(1, 2).\n");
}

#[test]
fn long_lines_are_broken() {
    let name = |length: usize| "a".repeat(length);
    let (n50, n60) = (name(50), name(60));
    check(&format!("+!b <- {n60}; {n50}."), &format!("+!b <- {n60}; {n50}.\n"));
    check(&format!("+!b <- {n60}; {n60}."), &format!("+!b\n  <- {n60};\n     {n60}.\n"));
    check(&format!("+!b : {n50} <- {n60}; c."), &format!("+!b : {n50}\n  <- {n60}; c.\n"));
    check(
        &format!("+!b : {n50} & {n60} & {n60} & c <- d."),
        &format!("+!b : {n50} & {n60}\n    & {n60} & c\n  <- d.\n"),
    );
    // Where there is no place to break it, it stays as long as it is.
    let n130 = name(130);
    check(&format!("+!b <- {n130}."), &format!("+!b\n  <- {n130}.\n"));
}

#[test]
fn comments_stay_where_they_are() {
    check(
        "\n\n// one\r\n\r\n\r\n/* two\r\n   three   */\nb. // four  \n/* five */ !g. /* six */ // seven\n\n\n// eight\n+!a.\n// nine\n\n",
        "// one\n\n/* two\n   three   */\nb. // four\n/* five */\n!g. /* six */ // seven\n\n// eight\n+!a.\n// nine\n",
    );
    check(
        "+!a : b & // one\n c /* two */ <- // three\n d(/* four */ 1, // five\n 2); // six\n\n // seven\n e /* eight */ .",
        "+!a : b & // one\n    c /* two */\n  <- // three\n     d(/* four */ 1, // five\n       2); // six\n     // seven\n     e /* eight */.\n",
    );
    check(
        "+!a <- X = 6 / /* a */ -/* b */ 2; b(X).",
        "+!a <- X = 6 / /* a */ - /* b */ 2; b(X).\n",
    );
}

#[test]
fn what_cannot_be_parsed_is_refused() {
    for text in ["", "+!a <- b", "+!a <- b /* c", "+!a. ~b.", "b."] {
        assert!(!formatted(text).unwrap_err().is_empty(), "{text}");
    }
    let error = format("x.asl", "+!a <- b").unwrap_err().to_string();
    assert!(error.contains(" --> x.asl:1:9\n"), "{error}");
}

/// The tokens of a text, joined by other blanks and comments.
fn disturbed(text: &str, choices: &[u8]) -> String {
    const GAPS: [&str; 12] = [
        " ",
        "\n",
        " ",
        "\n  ",
        "\t",
        "\n\n\n",
        " /* c */ ",
        " // c\n",
        "/*c*/",
        "\n/* c\n d */\n",
        "\n// c  \n",
        "\r\n",
    ];
    let (tokens, _) = tokenize(text);
    let mut choices = choices.iter().cycle();
    let mut disturbed = String::new();
    let mut last = 0;
    for token in tokens {
        let before = &text[last..token.span.start];
        match choices.next() {
            // Mostly as it is, so that there are many combinations.
            Some(choice) if *choice < 64 => disturbed.push_str(GAPS[usize::from(*choice) % 12]),
            _ => disturbed.push_str(before),
        }
        disturbed.push_str(&text[token.span.clone()]);
        last = token.span.end;
    }
    disturbed
}

/// The tokens, and the text of the comments.
fn content(text: &str) -> (Vec<String>, Vec<String>) {
    let (tokens, found) = tokenize(text);
    assert_eq!(found, []);
    let mut comments = Vec::new();
    let mut last = 0;
    for token in &tokens {
        for comment in Gap::new(&text[last..token.span.start]).comments {
            comments.push(comment.text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n"));
        }
        last = token.span.end;
    }
    (tokens.iter().map(|token| text[token.span.clone()].to_owned()).collect(), comments)
}

/// The tree without places.
fn tree(text: &str) -> String {
    let (agent, found) = parse(text);
    assert_eq!(found, []);
    let shown = format!("{agent:?}");
    let mut parts = shown.split("..").peekable();
    let mut tree = String::new();
    while let Some(part) = parts.next() {
        let part = part.trim_start_matches(|c: char| c.is_ascii_digit());
        let inner = part.trim_end_matches(|c: char| c.is_ascii_digit());
        tree.push_str(if parts.peek().is_some() { inner } else { part });
    }
    tree
}

#[test]
fn disturbed_agents_keep_their_meaning_and_are_stable() {
    let texts = [
        include_str!("../../../autopilot/agent/autopilot.asl"),
        include_str!("../../agents/lift.asl"),
        include_str!("../../agents/rover.asl"),
        "b(1, -2.5). c. !g(\"a // b\").\n@l[req(\"R\"), req(\"S\")] +!g(X) : not (b(X, _) | c & X - 1 < -(3 + X) * - 2) <- f(--1); Y = h() mod 2; +c; -c; \
         ?b(Y, Z); .wait(5); !g(X)[deadline(-1)]. -!g(_) <- true. +?b(_, Y) <- Y = 1.0e5. -b : true. +b(X, X) <- !!g(X).",
    ];
    let strategy = (0..texts.len(), proptest::collection::vec(proptest::num::u8::ANY, 1..400));
    let config = Config { cases: 300, failure_persistence: None, ..Config::default() };
    TestRunner::new(config)
        .run(&strategy, |(index, choices)| {
            let text = disturbed(texts[index], &choices);
            let once = formatted(&text).unwrap();
            assert_eq!(content(&once), content(&text));
            assert_eq!(tree(&once), tree(&text));
            assert_eq!(formatted(&once).unwrap(), once);
            assert!(once.lines().all(|line| line.trim_end() == line), "{once}");
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}

#[track_caller]
fn check_system(text: &str, expected: &str) {
    let formatted = format_system("x.system", text).unwrap();
    assert_eq!(formatted, expected);
    assert_eq!(format_system("x.system", expected).unwrap(), expected, "not stable");
}

#[test]
fn sections_are_one_line_or_one_for_each_entry() {
    check_system(
        "agents{a:x.conf;b : two words.conf ; } ;channels { capacity=3 ;losses = any; }\n\n\n\
         properties { p[R-1,R-2.a] : never_together ( a . x,b.y ) ; };",
        "agents { a: x.conf; b: two words.conf; };\nchannels { capacity = 3; losses = any; }\n\n\
         properties { p [R-1, R-2.a]: never_together(a.x, b.y); };\n",
    );
    check_system("version\n 1 ;agents{a:x.conf;}", "version 1;\nagents { a: x.conf; }\n");
    check_system(
        "agents\n{\n\na: x.conf; b:\ny.conf;\n\n\nc: /* d */ z//.conf /* e */;\n\n} channels { };",
        "agents {\n  a: x.conf;\n  b: y.conf;\n\n  c: /* d */ z//.conf /* e */;\n}\nchannels { };\n",
    );
}

#[test]
fn formulae_are_broken_behind_commas() {
    check_system(
        "agents { a: x.conf; }; properties { p: within(1, a.+! g,\n b.x,c.\ny); };",
        "agents { a: x.conf; };\nproperties {\n  p: within(1, a.+!g,\n    b.x, c.y);\n};\n",
    );
    let name = |length: usize| "a".repeat(length);
    let (n50, n60) = (name(50), name(60));
    check_system(
        &format!("agents {{ a: x.conf; }}; properties {{ p: never_together({n50}.b, {n60}.c); }};"),
        &format!(
            "agents {{ a: x.conf; }};\nproperties {{\n  p: never_together({n50}.b,\n    {n60}.c);\n}};\n"
        ),
    );
}

#[test]
fn comments_of_a_system_stay_where_they_are() {
    check_system(
        "// one\n\n\n// two\nagents { // three\n\n  // four  \n a /* five */ : x.conf; // six\n// seven\n}; // eight\n\n",
        "// one\n\n// two\nagents { // three\n\n  // four\n  a /* five */: x.conf; // six\n  // seven\n}; // eight\n",
    );
    check_system(
        "\u{feff}agents { /* one */ a: x.conf; } // two\n; properties { p: // three\n within(1, // four\n a.x, /*/ five */ b.y); };",
        "agents { /* one */ a: x.conf; } // two\n;\nproperties {\n  p: // three\n    within(1, // four\n    a.x, /*/ five */ b.y);\n};\n",
    );
}

/// What a system declares, without places.
fn declared(text: &str) -> Option<String> {
    let (parsed, found) = ParsedSystem::read("", text);
    let shown = format!("{parsed:?}").replace(&format!("{text:?}"), "");
    let digit = |c: char| c.is_ascii_digit();
    let parts: Vec<&str> = shown.split("..").collect();
    found.is_empty().then(|| parts.iter().map(|part| part.trim_matches(digit)).collect())
}

#[test]
fn disturbed_systems_keep_their_meaning_and_are_stable() {
    const GAPS: [&str; 8] =
        [" ", "\n", "\t\t", "\n\n\n", " /* c */ ", " // c\n", "\n/* c\n d */\n", "\r\n"];
    let texts = [
        include_str!("../../agents/systems/corridor_calm.system"),
        include_str!("../../agents/systems/contract.system"),
        "agents { a: ../x y.conf; b: z.conf; } properties { p: within(2, a.+!g, b.x); q [A-1, B.2]: within(2, a.-c, b.x); }",
    ];
    let strategy = (0..texts.len(), proptest::collection::vec(proptest::num::u8::ANY, 1..200));
    let config = Config { cases: 300, failure_persistence: None, ..Config::default() };
    TestRunner::new(config)
        .run(&strategy, |(index, choices)| {
            let mut choices = choices.iter().cycle();
            let (mut text, mut before) = (String::new(), "");
            for token in sections::tokens(texts[index]).0 {
                // Here nothing may stand.
                let is_fixed = ["+", "-", "!"].contains(&token.text) || before == "[";
                let choice = choices.next().copied().unwrap_or_default();
                match GAPS.get(usize::from(choice % 16)) {
                    Some(gap) if !is_fixed => text.push_str(gap),
                    _ => text.push(' '),
                }
                if is_fixed {
                    text.truncate(text.trim_end().len());
                }
                text.push_str(token.text);
                before = token.text;
            }
            let Some(meaning) = declared(&text) else { return Ok(()) };
            let once = format_system("x.system", &text).unwrap();
            assert_eq!(declared(&once).as_ref(), Some(&meaning), "{text}\n{once}");
            let content = |text: &str| -> Vec<String> {
                let (tokens, behind) = sections::tokens(text);
                let gaps = tokens.iter().map(|token| &token.gap).chain([&behind]);
                let comments = gaps.flat_map(|gap| &gap.comments).map(|comment| comment.text);
                let all = tokens.iter().map(|token| token.text).chain(comments);
                all.map(str::to_owned).collect()
            };
            assert_eq!(content(&once), content(&text));
            assert_eq!(format_system("x.system", &once).unwrap(), once);
            assert!(once.lines().all(|line| line.trim_end() == line), "{once}");
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}
