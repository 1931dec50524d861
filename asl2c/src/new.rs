//! `asl2c new`: a small agent as a starting point, which builds and runs at once.

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Errors on creating an agent.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NewError {
    #[error(
        "`{name}` is not a valid agent name: use a lower-case letter, then lower-case letters, digits and `_`"
    )]
    Name { name: String },
    #[error("`{name}` is taken: {owner}; choose another name")]
    Taken { name: String, owner: &'static str },
    #[error("cannot create {path}: {source}; nothing was created")]
    File { path: String, source: std::io::Error },
    #[error("cannot print the result: {0}; nothing was created")]
    Print(#[source] std::io::Error),
}

const CONFIGURATION: &str = "\
settings { input = NAME.asl; output = NAME.c; header = NAME.h; basics = actions.h; };

// Your C functions: actions of the agent, and queries.
basics {
  void sendHover(void);
  void sendLand(void);
  bool onGround(void);
};

// Beliefs and goals, with the types of their arguments.
types { wait(void); land(void); completeLand(void); battery(int32_t); };

// Beliefs that your program sets, and events that it raises.
settables { battery; };
triggerables { +!land; };
preemptive { +!land; };

properties { landing_is_honoured: within(1, +!land, sendLand); };
";

const AGENT: &str = "\
// The initial goal: hover until there is an order.
!wait.

+!wait : battery(B) & B < 20 <- sendLand; !completeLand.
+!wait <- sendHover; !!wait.

+!land <- sendLand; !completeLand.

// A recursive goal is the event of the next step.
+!completeLand : onGround <- !!wait.
+!completeLand <- sendLand; !completeLand.
";

const MAIN: &str = "\
#include <stdio.h>
#include \"NAME.h\"
#include \"actions.h\"

static int height = 3;

/* The basic actions, as actions.h declares them. */
void sendHover(void) { printf(\"  hover\\n\"); }
void sendLand(void)
{
    printf(\"  land\\n\");
    if (height > 0) { height--; }
}
bool onGround(void) { return height == 0; }

/* Called at the start of each step: sets the beliefs. */
void updateBeliefs(void) { set_battery(80); }

int main(void)
{
    init();
    for (int step = 1; step <= 8; step++)
    {
        printf(\"step %d\\n\", step);
        if (step == 3)
        {
            /* Whether the event was accepted. */
            if (!achieve_land()) { printf(\"refused\\n\"); }
        }
        next_step();
    }
    return 0;
}
";

const MAKEFILE: &str = "\
CFLAGS ?= -std=c99 -Wall -Wextra -O2 -ffp-contract=off
ASL2C ?= asl2c

run: NAME
\t./NAME

NAME: main.c NAME.c
\t$(CC) $(CFLAGS) -o $@ main.c NAME.c

main.c: NAME.c
NAME.c: NAME.asl NAME.conf
\t$(ASL2C) NAME.conf

verify:
\t$(ASL2C) verify NAME.conf

clean:
\trm -f NAME NAME.c NAME.h actions.h

.PHONY: run verify clean
";

/// File names, and target names of the Makefile, that the agent's files would collide with.
const TAKEN: [(&str, &str); 5] = [
    ("actions", "the header of the basic actions has this name"),
    ("main", "the C file with the environment has this name"),
    ("run", "a target of the Makefile has this name"),
    ("verify", "a target of the Makefile has this name"),
    ("clean", "a target of the Makefile has this name"),
];

/// Creates the folder `name` and prints the next steps. If printing or any file fails, nothing is left
/// behind.
pub(crate) fn make(
    name: &str,
    say: impl FnOnce(&str) -> std::io::Result<()>,
) -> Result<(), NewError> {
    let word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(word) {
        return Err(NewError::Name { name: name.to_owned() });
    }
    if let Some((_, owner)) = TAKEN.iter().find(|(taken, _)| *taken == name) {
        return Err(NewError::Taken { name: name.to_owned(), owner });
    }
    let folder = Path::new(name);
    // An existing folder is not touched.
    std::fs::create_dir(folder).map_err(failed(folder))?;
    let mut made: Vec<PathBuf> = Vec::new();
    let done = fill(folder, name, &mut made).and_then(|()| {
        let text =
            format!("created {name}/; `make -C {name}` translates, builds and runs the agent\n");
        say(&text).map_err(NewError::Print)
    });
    if done.is_err() {
        // A failing removal is not reported, because the original error matters more.
        for path in made {
            _ = std::fs::remove_file(path);
        }
        _ = std::fs::remove_dir(folder);
    }
    done
}

/// Writes the files; `made` lists those that were created.
fn fill(folder: &Path, name: &str, made: &mut Vec<PathBuf>) -> Result<(), NewError> {
    for (file, text) in [
        (format!("{name}.conf"), CONFIGURATION),
        (format!("{name}.asl"), AGENT),
        ("main.c".to_owned(), MAIN),
        ("Makefile".to_owned(), MAKEFILE),
    ] {
        let path = folder.join(file);
        let mut created = File::create_new(&path).map_err(failed(&path))?;
        made.push(path.clone());
        created.write_all(text.replace("NAME", name).as_bytes()).map_err(failed(&path))?;
    }
    Ok(())
}

fn failed(path: &Path) -> impl FnOnce(std::io::Error) -> NewError {
    let path = path.display().to_string();
    |source| NewError::File { path, source }
}
