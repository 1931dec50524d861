//! Translates small agents, compiles their C with all warnings as errors, and runs it.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use translator::{TranslateError, Translation, parse_configuration, translate};

/// The compilers' flags that generated C must pass.
pub(crate) const STRICT: [&str; 11] = [
    "-std=c99",
    translator::ROUNDED,
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wfloat-equal",
    "-Wshadow",
    "-Wstrict-prototypes",
    "-Wcast-qual",
    "-pedantic",
    "-Werror",
];

/// A number from an environment variable, or the default.
pub(crate) fn from_environment(variable: &str, usual: u32) -> u32 {
    std::env::var(variable).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Checks random cases, on all processors, and returns what was found in each. A failure is shrunk.
///
/// # Panics
/// If a check fails.
pub(crate) fn in_random_cases<S: Strategy, T: Send + 'static>(
    cases: u32,
    seed: u32,
    strategy: impl Fn() -> S + Copy + Send + 'static,
    check: impl Fn(S::Value) -> Result<T, TestCaseError> + Copy + Send + 'static,
) -> Vec<T> {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let workers = u32::try_from(processors).unwrap();
    let work = move |worker: u32| {
        let mut seed_bytes = [0; 32];
        seed_bytes[..4].copy_from_slice(&seed.to_le_bytes());
        seed_bytes[4..8].copy_from_slice(&worker.to_le_bytes());
        let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed_bytes);
        let config = Config {
            cases: cases.div_ceil(workers),
            max_shrink_iters: 400,
            failure_persistence: None,
            ..Config::default()
        };
        let found = RefCell::new(Vec::new());
        let result = TestRunner::new_with_rng(config, rng).run(&strategy(), |case| {
            found.borrow_mut().push(check(case)?);
            Ok(())
        });
        result.unwrap_or_else(|error| panic!("{error}"));
        found.into_inner()
    };
    let threads: Vec<_> =
        (0..workers).map(|worker| std::thread::spawn(move || work(worker))).collect();
    threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
}

/// Reports that a test was skipped because a tool is missing. In CI that is a failure, so that a skipped test
/// cannot look like a passed one.
///
/// # Panics
/// In CI.
#[allow(clippy::print_stdout, reason = "what is left out is said")]
pub(crate) fn skip(tool: &str) {
    assert!(std::env::var_os("CI").is_none(), "there is no {tool} here");
    println!("skipped: there is no {tool} here");
}

/// A small agent with its environment.
pub(crate) struct Case {
    /// `basics` entries. Actions print their call; functions are defined in `functions`.
    pub(crate) basics: &'static str,
    /// `types` entries.
    pub(crate) types: &'static str,
    /// The other sections, as in the configuration.
    pub(crate) sections: &'static str,
    /// The agent.
    pub(crate) agent: &'static str,
}

impl Case {
    pub(crate) fn configuration(&self, settings: &str) -> String {
        let Self { basics, types, sections, .. } = self;
        format!(
            "settings {{ input = agent.asl; output = agent.c; header = agent.h; \
             basics = actions.h; {settings} }};\nbasics {{ {basics} }};\ntypes {{ {types} }};\n{sections}\n"
        )
    }

    pub(crate) fn translate(&self, settings: &str) -> Result<Translation, TranslateError> {
        let configuration = parse_configuration("agent.conf", &self.configuration(settings))?;
        translate(&configuration, self.agent)
    }

    /// Compiles the C for both kinds of instance with all warnings as errors.
    pub(crate) fn compile(&self) {
        self.compile_with("");
    }

    /// As [`Self::compile`], with further settings.
    pub(crate) fn compile_with(&self, further: &str) {
        for instance in ["", "instance = context;"] {
            let settings = &format!("{instance} {further}");
            let folder = tempfile::tempdir().unwrap();
            self.write(settings, folder.path());
            for compiler in ["cc", "clang"] {
                let mut compile = Command::new(compiler);
                compile.current_dir(folder.path()).args(STRICT).args(["-c", "agent.c"]);
                let result = match compile.output() {
                    Err(_) if compiler == "clang" => {
                        skip(compiler);
                        continue;
                    }
                    result => result.unwrap(),
                };
                let message = String::from_utf8_lossy(&result.stderr);
                assert!(result.status.success(), "{compiler} {settings}\n{message}");
            }
        }
    }

    /// Runs `script`, C statements that call the agent's interface, and returns the output. `functions` are C
    /// definitions of the basic functions with a result.
    pub(crate) fn run(&self, functions: &str, script: &str) -> String {
        self.run_with("", functions, script)
    }

    /// As [`Self::run`], with further settings.
    pub(crate) fn run_with(&self, settings: &str, functions: &str, script: &str) -> String {
        let folder = tempfile::tempdir().unwrap();
        self.write(settings, folder.path());
        let mut main =
            String::from("#include <stdio.h>\n#include \"agent.h\"\n#include \"actions.h\"\n");
        for declaration in self.basics.split(';').map(str::trim).filter(|text| !text.is_empty()) {
            if let Some(action) = declaration.strip_prefix("void ") {
                main.push_str(&printing_action(action));
            }
        }
        main.push_str(functions);
        // The script may replace it.
        if !functions.contains("updateBeliefs") {
            main.push_str("void updateBeliefs(void) {}\n");
        }
        _ = write!(main, "int main(void) {{ init();\n{script}\nreturn 0; }}\n");
        std::fs::write(folder.path().join("main.c"), main).unwrap();
        let result =
            compiler(folder.path()).args(["-o", "agent", "main.c", "agent.c"]).output().unwrap();
        let message = String::from_utf8_lossy(&result.stderr);
        assert!(result.status.success(), "{message}");
        let result = Command::new(folder.path().join("agent")).output().unwrap();
        assert!(result.status.success());
        String::from_utf8(result.stdout).unwrap().split_whitespace().collect::<Vec<_>>().join(" ")
    }

    fn write(&self, settings: &str, folder: &Path) {
        let translation = self.translate(settings).unwrap_or_else(|error| panic!("{error}"));
        for file in &translation.files {
            std::fs::write(folder.join(&file.name), &file.text).unwrap();
        }
    }
}

/// Translates, compiles and runs a program whose basic actions print their calls; a function `f` returns the
/// variable `f_result`, which the script may set. Lines are kept.
pub(crate) fn run_program(configuration: &str, agent: &str, script: &str) -> String {
    let parsed = parse_configuration("a.conf", configuration).unwrap_or_else(|e| panic!("{e}"));
    let translation = translate(&parsed, agent).unwrap_or_else(|error| panic!("{error}"));
    let folder = tempfile::tempdir().unwrap();
    for file in &translation.files {
        std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
    }
    let mut main = format!(
        "#include <stdint.h>\n#include <stdio.h>\n#include \"{}\"\n",
        translation.files[0].name
    );
    main.push_str("void updateBeliefs(void) {}\n");
    if configuration.contains("trace = chosen;") {
        main.push_str(&printing_action("chosen(uint32_t)"));
    }
    let (_, basics) = configuration.split_once("basics {").unwrap();
    for declaration in basics.split('}').next().unwrap().split(';').map(str::trim) {
        if let Some(action) = declaration.strip_prefix("void ") {
            main.push_str(&printing_action(action));
        } else if let Some((result, function)) = declaration.split_once(' ') {
            let (name, types) = function.split_once('(').unwrap();
            let types = types.trim_end_matches(')').split(',').map(str::trim);
            let types = types.filter(|ctype| !matches!(*ctype, "void" | "")).enumerate();
            let (parameters, unused): (Vec<String>, Vec<String>) =
                types.map(|(i, ctype)| (format!("{ctype} a{i}"), format!("(void)a{i}; "))).unzip();
            let parameters =
                if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") };
            main.push_str(&format!(
                "static {result} {name}_result = 0;\n{result} {name}({parameters}) {{ {}return {name}_result; }}\n",
                unused.concat()
            ));
        }
    }
    for action in parsed.declarations().sending() {
        let types: Vec<&str> = action.parameters.iter().map(|ctype| ctype.name.as_str()).collect();
        main.push_str(&printing_action(&format!("{}({})", action.name.text, types.join(", "))));
    }
    // An agent with peers begins as the first of them.
    let me = if parsed.declarations().peers.is_empty() { "" } else { "0U" };
    main.push_str(&format!("int main(void) {{ init({me});\n{script}\nreturn 0; }}\n"));
    std::fs::write(folder.path().join("main.c"), main).unwrap();
    let result = compiler(folder.path()).args(["-o", "agent", "main.c"]).output().unwrap();
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
    let result = Command::new(folder.path().join("agent")).output().unwrap();
    String::from_utf8(result.stdout).unwrap().trim_end().to_owned()
}

/// Compiles the agent and `environment` as one unit and returns the program's output.
pub(crate) fn compile_and_run(translation: &Translation, environment: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    for file in &translation.files {
        std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
    }
    let main = format!("#include \"{}\"\n{environment}", translation.files[0].name);
    std::fs::write(folder.path().join("main.c"), main).unwrap();
    let result = compiler(folder.path()).args(["-o", "agent", "main.c"]).output().unwrap();
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
    let result = Command::new(folder.path().join("agent")).output().unwrap();
    assert!(result.status.success());
    trimmed_lines(&String::from_utf8_lossy(&result.stdout))
}

/// The lines of a trace, side by side.
pub(crate) fn trimmed_lines(trace: &str) -> String {
    trace.lines().collect::<Vec<_>>().join(" ").trim().to_owned()
}

fn compiler(folder: &Path) -> Command {
    let mut compiler = Command::new("cc");
    compiler.current_dir(folder).args(STRICT);
    compiler
}

/// `act(int, double)` → a definition that prints `act(1,2.5)`.
fn printing_action(declaration: &str) -> String {
    let (name, types) = declaration.split_once('(').unwrap();
    let types = types.trim_end_matches(')');
    let types = types.split(',').map(str::trim).filter(|t| *t != "void");
    let types: Vec<&str> = types.map(|t| if t == "peer" { "peer_t" } else { t }).collect();
    let parameters: Vec<String> =
        types.iter().enumerate().map(|(i, ctype)| format!("{ctype} a{i}")).collect();
    let formats: Vec<&str> = types
        .iter()
        .map(|ctype| match *ctype {
            "double" => "%g",
            "const char *" => "%s",
            "unsigned int" | "uint32_t" => "%u",
            _ => "%d",
        })
        .collect();
    let arguments = (0..types.len()).fold(String::new(), |text, i| text + &format!(", a{i}"));
    let parameters = if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") };
    format!(
        "void {name}({parameters}) {{ printf(\"{name}({})\\n\"{arguments}); }}\n",
        formats.join(",")
    )
}
