//! Whether the files that lie where people compile them are those that a verdict is about.
//!
//! What is proved is generated anew, in a folder of its own. A file of the same name that lies beside the agent, or beside C
//! that is judged in its place, is what a compiler would take.

use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use translator::{GeneratedFile, TranslateError, include_path, translate};

use crate::agent::{Agent, ReadError, read};
use crate::output::known_again;

/// Why a verdict could be taken for one about other files.
#[derive(Debug, thiserror::Error)]
pub(crate) enum StaleError {
    /// A file that is not what would be judged.
    #[error(
        "nothing is proved: {path}, line {line}, differs from {of}, and a verdict would not be about the file that lies \
         there; {help}"
    )]
    Differs { path: PathBuf, line: usize, of: String, help: String },
    /// A file that cannot be compared.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The agent has errors.
    #[error(transparent)]
    Translate(#[from] TranslateError),
}

/// A file of a verdict, and the texts by which it is known; none if there must not be such a file.
struct Expected {
    name: String,
    /// The same C; the first one is what would be written now.
    texts: Vec<String>,
    of: String,
    help: String,
}

/// Compares the C and the headers of an agent with the files of their names in its folder, in another one, and beside the C
/// that is judged in place of the translation, as this would include them. `own` are the agent's own headers.
pub(crate) fn check_current(
    agent: &Agent,
    own: &[GeneratedFile],
    folder: &Path,
    judged: Option<&Path>,
) -> Result<(), StaleError> {
    let Agent { configuration, text, .. } = agent;
    let generated = translate(configuration, text)?.files;
    let c = generated.first().map(|file| file.name.clone()).unwrap_or_default();
    let beside = judged.map(|judged| judged.parent().unwrap_or(Path::new("")));
    for expected in expected(agent, generated, own, judged.is_some())? {
        let Expected { name, texts, of, help } = expected;
        let places = [agent.folder(), folder].map(|folder| folder.join(&name));
        let included = beside.map(|beside| beside.join(include_path(&c, &name)));
        for place in places.into_iter().chain(included) {
            let Some(found) = lying(&place)? else { continue };
            if !texts.contains(&found) {
                let line = first_difference(texts.first().map_or("", String::as_str), &found);
                return Err(StaleError::Differs { path: place, line, of, help });
            }
        }
    }
    Ok(())
}

/// The files of a verdict that a compiler reads.
fn expected(
    agent: &Agent,
    generated: Vec<GeneratedFile>,
    own: &[GeneratedFile],
    is_judged: bool,
) -> Result<Vec<Expected>, ReadError> {
    let Agent { configuration, path, .. } = agent;
    let path = path.display();
    let written = known_again(generated.clone()).into_iter().zip(generated);
    // Others are not judged, and C that is named is judged as it is.
    let kinds = if is_judged { &["header", "basics"][..] } else { &["header", "basics", "output"] };
    let written = written.filter(|(file, _)| kinds.contains(&file.setting));
    let written = written.map(|(marked, plain)| Expected {
        help: match marked.setting {
            "output" => format!(
                "write it anew by `asl2c {path}`, or judge it by `asl2c validate {path} --c FILE`"
            ),
            _ => format!("write it anew by `asl2c {path}`"),
        },
        name: marked.name,
        // Build scripts write files without the line by which they are known again.
        texts: vec![marked.text, plain.text],
        of: format!("what asl2c makes of {path} now"),
    });
    let own = own.iter().map(|header| header.name.clone());
    let headers: BTreeSet<String> = configuration.included_files().chain(own).collect();
    let headers = headers.into_iter().map(|name| {
        let text = lying(&agent.folder().join(&name))?;
        let of = if text.is_some() { "that of the agent's folder" } else { "the compiler's" };
        let (texts, help) = (text.into_iter().collect(), "remove it".to_owned());
        Ok(Expected { name, texts, of: of.to_owned(), help })
    });
    written.map(Ok).chain(headers).collect()
}

/// The text of a file, if there is one.
fn lying(path: &Path) -> Result<Option<String>, ReadError> {
    let failed = |source| ReadError::File { path: path.to_owned(), source };
    match std::fs::metadata(path) {
        Ok(data) if data.is_file() => read(path).map(Some),
        // It may be a pipe, which has no end.
        Ok(_) => Err(failed(std::io::Error::other("it is not a regular file"))),
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            Ok(None)
        }
        Err(error) => Err(failed(error)),
    }
}

/// The number of the first line in which two texts differ.
fn first_difference(one: &str, other: &str) -> usize {
    let same = one.split('\n').zip(other.split('\n')).take_while(|(one, other)| one == other);
    same.count() + 1
}
