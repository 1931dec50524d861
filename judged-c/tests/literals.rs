//! Each program that reads the printed C sees the same numbers in it.
#![forbid(unsafe_code)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use judged_c::{Rule, judge};
use translator::{Comparison, comparison, parse_configuration};

fn lamp() -> Comparison {
    let configuration =
        "settings { input = a.asl; output = lamp.c; header = lamp.h; basics = b.h; };
        basics { void on(void); }; types { light(void); }; triggerables { +!light; };";
    let configuration = parse_configuration("a.conf", configuration).unwrap();
    comparison(&configuration, "+!light <- on.").unwrap()
}

/// How a constant is printed.
fn printed(ctype: &str, constant: &str) -> Result<String, Rule> {
    let compared = lamp();
    let begin = "void next_step(void)\n{\n";
    let declared = format!("{begin}    const {ctype} x = {constant};\n    (void)x;\n");
    let c = compared.files[0].text.replacen(begin, &declared, 1);
    let judged = judge(&compared, &c, []).map_err(|refused| refused.rule)?;
    let behind = judged.text().split_once(" x = ").unwrap().1;
    Ok(behind.split_once(';').unwrap().0.to_owned())
}

/// A hair above and below the middle of two numbers, with this many zeros or nines before the hair.
#[test]
fn a_number_is_printed_as_the_shortest_one_with_its_value() {
    let middle = "1.000000059604644775390625";
    let hair = |count| format!("{middle}{}1", "0".repeat(count));
    let below = |count| format!("1.000000059604644775390624{}", "9".repeat(count));
    for count in [1, 10, 90, 700] {
        assert_eq!(printed("float", &format!("{}F", hair(count))).unwrap(), "1.0000001F");
        assert_eq!(printed("float", &format!("{}F", below(count))).unwrap(), "1.0F");
        assert_eq!(printed("double", &hair(count)).unwrap(), "1.0000000596046448");
    }
    for (ctype, given, expected) in [
        ("float", "1.000000059604644775390625F", "1.0F"),
        // The nearest of the doubles is in the middle of two floats.
        ("float", "1.00000005960464477539062500000001F", "1.0000001F"),
        ("float", "7.0064923216240854e-46F", "1e-45F"),
        ("float", "7.0064923216240853e-46F", "0.0F"),
        ("float", "3.4028235677973367e38F", ""),
        ("float", "3.4028235677973366e38F", "3.4028235e38F"),
        ("double", "2.4703282292062328e-324", "5e-324"),
        ("double", "1.7976931348623158e308", "1.7976931348623157e308"),
        ("double", "1.7976931348623159e308", ""),
        ("double", "00.5000", "0.5"),
        ("double", "1E3", "1000.0"),
        ("double", "-0e999999999", "-0.0"),
        ("float", "-0.0F", "-0.0F"),
        ("int32_t", "0", "0"),
        ("uint64_t", "18446744073709551615ULL", "18446744073709551615ULL"),
    ] {
        match printed(ctype, given) {
            Ok(found) => assert_eq!(found, expected, "{given}"),
            Err(rule) => assert!(rule == Rule::Number && expected.is_empty(), "{given}: {rule:?}"),
        }
    }
}

/// A comment that other compilers do not see.
#[test]
fn no_comment_depends_on_the_compiler() {
    for number in ["4 //* */ 2\n", "4 ///* */ 2\n", "4 /* /* */", "4 // /* \n"] {
        assert_eq!(printed("int32_t", number).unwrap_err(), Rule::Comment, "{number}");
    }
    for number in ["4 // 2\n", "4 /* https://example.org **/", "4 /**/", "4 //\n", "4 ////\n"] {
        assert_eq!(printed("int32_t", number).unwrap(), "4", "{number}");
    }
}
