//! Products and sums of floating-point numbers are rounded one by one, as the interpreter and all proofs do: with the option
//! that the C asks for, also where the processor multiplies and adds at once.

use std::path::Path;
use std::process::Command;

use translator::{ROUNDED, parse_configuration, translate};

use crate::harness::skip;

const CONFIGURATION: &str =
    "settings { input = m.asl; output = m.c; header = m.h; basics = actions.h; };
    basics { void put(double); void put_small(float); };
    types { tick(void); x(double); y(double); z(double); u(float); v(float); w(float); };
    settables { x; y; z; u; v; w; };";
const AGENT: &str = "!tick. +!tick : x(X) & y(Y) & z(Z) & u(U) & v(V) & w(W) <- put(X * Y + Z); put_small(U * V - W).";
const MAIN: &str = "#include <stdio.h>
#include \"m.h\"
#include \"actions.h\"
void put(double value) { printf(\"%a\\n\", value); }
void put_small(float value) { printf(\"%a\\n\", (double)value); }
void updateBeliefs(void) {}
int main(void)
{
    init();
    set_x(1.0 + 0x1p-27); set_y(1.0 + 0x1p-27); set_z(-1.0);
    set_u(1.0F + 0x1p-12F); set_v(1.0F + 0x1p-12F); set_w(1.0F);
    next_step();
    return 0;
}
";
/// With one rounding the last bits of the products remain.
const EACH_ROUNDED: &str = "0x1p-26\n0x1p-11\n";

fn prints(folder: &Path, compiler: &str, options: &[&str]) -> String {
    let mut compile = Command::new(compiler);
    compile.args(["-std=gnu99", "-O2", "-o", "m"]).args(options).args(["main.c", "m.c"]);
    let output = compile.current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = Command::new(folder.join("m")).output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn each_operation_is_rounded() {
    let configuration = parse_configuration("m.conf", CONFIGURATION).unwrap();
    let translation = translate(&configuration, AGENT).unwrap();
    let c = &translation.files[0].text;
    assert!(c.lines().nth(1).unwrap().contains(ROUNDED), "{c}");
    let sums = AGENT.replace("X * Y", "X - Y").replace("U * V", "U + V");
    assert!(!translate(&configuration, &sums).unwrap().files[0].text.contains(ROUNDED));
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("main.c"), MAIN).unwrap();
    for file in &translation.files {
        std::fs::write(folder.join(&file.name), &file.text).unwrap();
    }
    for compiler in ["gcc", "clang"] {
        if Command::new(compiler).arg("--version").output().is_err() {
            skip(compiler);
            continue;
        }
        assert_eq!(prints(folder, compiler, &[ROUNDED]), EACH_ROUNDED, "{compiler}");
        #[cfg(target_arch = "x86_64")]
        if std::is_x86_feature_detected!("fma") {
            assert_eq!(prints(folder, compiler, &[ROUNDED, "-mfma"]), EACH_ROUNDED, "{compiler}");
            let at_once = prints(folder, compiler, &["-ffp-contract=fast", "-mfma"]);
            assert_ne!(at_once, EACH_ROUNDED, "{compiler} has no use for the option");
        }
    }
}
