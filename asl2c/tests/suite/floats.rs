//! `asl2c validate` leaves open first what floating-point operations result in: what differs is still found, and what only
//! looks different is proved.

use std::time::Duration;

use asl2c::{Cbmc, Validated, validate};
use judged_c::judge;
use translator::{comparison, parse_configuration};

use crate::harness::{cbmc, skip};

const CONFIGURATION: &str = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
    includes { #include <stdbool.h>
    #include <stdint.h> };
    basics { void act(double); void show(float); };
    types { go(double, double); turn(float, float); };
    triggerables { +!go; +!turn; };";
const AGENT: &str = "+!go(X, Y) <- act(X * Y - X / Y); act(X - Y + X).\n\
                     +!turn(A, B) <- show(A + B).\n";
const TIME: Duration = Duration::from_mins(5);

/// With an edited C.
fn judged(cbmc: &Cbmc, from: &str, to: &str) -> Validated {
    let configuration = parse_configuration("a.conf", CONFIGURATION).unwrap();
    let mut compared = comparison(&configuration, AGENT).unwrap();
    let c = &compared.files[0].text;
    assert_eq!(c.matches(from).count(), 1, "{from} in\n{c}");
    let edited = c.replacen(from, to, 1);
    judge(&compared, &edited, []).unwrap().put_into(&mut compared);
    let folder = tempfile::tempdir().unwrap();
    validate(&compared, cbmc, folder.path(), TIME).unwrap()
}

#[test]
fn floating_point_operations_are_compared() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    let right = [
        // What a solver does not multiply and divide in an hour.
        ("(var_X * var_Y)", "(var_X * var_Y)"),
        // Other operands, and the same sum.
        ("(var_A + var_B)", "(var_B + var_A)"),
    ];
    for (from, to) in right {
        let result = judged(&cbmc, from, to);
        assert!(result.is_proved(), "{to}: {result:?}");
    }
    let wrong = [
        ("(var_X * var_Y)", "(var_X + var_Y)"),
        ("(var_X - var_Y)", "(var_Y - var_X)"),
        ("(var_X - var_Y)", "(var_X + var_Y)"),
        ("(var_A + var_B)", "(var_A - var_B)"),
        ("(var_A + var_B)", "(var_A + var_A)"),
    ];
    for (from, to) in wrong {
        let result = judged(&cbmc, from, to);
        let differs = result.open.iter().any(|open| open.said.starts_with("another value"));
        assert!(differs, "{to}: {result:?}");
    }
}
