//! Any text as an agent: it is translated or refused, without a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use translator::{parse_configuration, translate};

const CONFIGURATION: &str = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; clock = f0; };
basics { void act(int); int f0(void); int f(int); bool q(double); double g(void); void say(const char *); };
types { a(void); b(int); c(int, double); d(bool); };
settables { b; }; triggerables { +!a; +b; -b; };";

fuzz_target!(|text: &str| {
    let configuration = parse_configuration("a.conf", CONFIGURATION).expect("it is valid");
    let _ = translate(&configuration, text);
});
