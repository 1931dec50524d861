//! The headers of an agent's own, and that no other file can take the place of a header.
//!
//! The C of an agent is compiled, proved and executed in folders that hold nothing but what was generated and the headers
//! that are found here. The folders of the agent or of edited C are searched by no compiler: a `stdint.h` that lies there
//! would otherwise be taken for that of the compiler.

use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};

use judged_c::{Refused, judge_header, macros, words};
use translator::{GeneratedFile, TranslateError, is_c_word, translate};

use crate::agent::{Agent, read};
use crate::tool::{ToolError, run, write};

/// Why a header cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HeaderError {
    /// It would be taken in place of another one.
    #[error(
        "{path} has the name of {name}, a header of the compiler, and could be taken in its place; rename it"
    )]
    Compilers {
        /// The header.
        path: PathBuf,
        /// The compiler's.
        name: String,
    },
    /// It defines, or could, what the generated C means by a name.
    #[error(
        "{path} defines a macro `{name}`, a name that the generated files use, or could; rename it"
    )]
    Macro {
        /// The header.
        path: PathBuf,
        /// The macro.
        name: String,
    },
    /// It is more than declarations.
    #[error("{path}, {refused}")]
    Judged {
        /// The header.
        path: PathBuf,
        /// What is not.
        refused: Refused,
    },
    /// It is neither in the agent's folder nor one of the compiler's.
    #[error(
        "{name} is included, which is neither a header of the compiler nor found, by its plain name, in the agent's \
         folder or below"
    )]
    Elsewhere {
        /// The file.
        name: String,
    },
    /// A header is missing, or has an error.
    #[error(
        "the C cannot be compiled: {said}; headers that the agent includes, and those that they include, are looked for \
         beside its configuration or below, and nowhere else"
    )]
    NotCompiled {
        /// What the compiler says.
        said: String,
    },
    /// The agent has errors.
    #[error(transparent)]
    Translate(#[from] TranslateError),
    /// The compiler is missing.
    #[error(transparent)]
    Tool(#[from] ToolError),
}

impl Agent {
    /// The headers of the agent's folder or below that its configuration includes, and those that they include in turn, for
    /// generated files: C that is compiled elsewhere needs them beside it.
    ///
    /// # Errors
    /// If one could take the place of a header of the compiler, is more than declarations, or includes anything that is
    /// neither such a header nor one of the compiler.
    pub fn own_headers(
        &self,
        generated: &[GeneratedFile],
    ) -> Result<Vec<GeneratedFile>, HeaderError> {
        let headers = self.named_headers(generated)?;
        // In proofs some of the agent's own names have others.
        let own = translate(&self.configuration, &self.text)?.files;
        let files = generated.iter().chain(&own);
        let used: HashSet<String> = files.flat_map(|file| words(&file.text)).collect();
        self.check_macros(&headers, &used)?;
        let includes = &self.configuration.declarations().includes;
        let is_usual =
            |line: &String| matches!(line.as_str(), "#include <stdbool.h>" | "#include <stdint.h>");
        if !includes.iter().all(is_usual) {
            check_included(&headers, generated)?;
        }
        for header in &headers {
            judge_header(&header.text, &used).map_err(|refused| {
                let path = self.folder().join(&header.name);
                HeaderError::Judged { path, refused }
            })?;
        }
        Ok(headers)
    }

    /// The files that it is made of: configuration, text and headers.
    ///
    /// # Errors
    /// If a header could take the place of one of the compiler.
    pub(crate) fn inputs(&self) -> Result<Vec<PathBuf>, HeaderError> {
        let headers = self.named_headers(&[])?;
        let headers = headers.iter().map(|header| self.folder().join(&header.name));
        Ok(self.sources().into_iter().chain(headers).collect())
    }

    /// The headers in the folder or below that are included, but for those that are generated.
    fn named_headers(
        &self,
        generated: &[GeneratedFile],
    ) -> Result<Vec<GeneratedFile>, HeaderError> {
        let lines = self.configuration.declarations().includes.join("\n");
        // They stand in the generated headers.
        let folders = generated.iter().filter_map(|file| file.name.rsplit_once('/'));
        let folders: BTreeSet<&str> = folders.map(|(folder, _)| folder).chain(["."]).collect();
        let mut names: Vec<Included> =
            included(&lines).flat_map(|one| one.beside(folders.iter().copied())).collect();
        let mut known: BTreeSet<String> =
            generated.iter().filter_map(|file| plain(&file.name)).collect();
        let mut headers: Vec<GeneratedFile> = Vec::new();
        while let Some(Included { name, is_quoted }) = names.pop() {
            let Some(name) = plain(&name).filter(|name| !known.contains(name)) else { continue };
            // Most of the names are those of the compiler's headers.
            let path = self.folder().join(&name);
            let Ok(text) = read(&path) else { continue };
            match of_compiler(&name)? {
                // A compiler finds its own for these brackets, whatever lies here.
                Some(_) if !is_quoted => continue,
                Some(name) => return Err(HeaderError::Compilers { path, name }),
                None => _ = known.insert(name.clone()),
            }
            let beside = name.rsplit_once('/').map_or(".", |(folder, _)| folder);
            names.extend(included(&text).flat_map(|one| one.beside([beside, "."])));
            let mut header = GeneratedFile::default();
            (header.name, header.text) = (name, text);
            headers.push(header);
        }
        headers.sort_by(|one, other| one.name.cmp(&other.name));
        Ok(headers)
    }

    /// No header defines what the generated files mean: a macro could take away what is asserted.
    fn check_macros(
        &self,
        headers: &[GeneratedFile],
        used: &HashSet<String>,
    ) -> Result<(), HeaderError> {
        // Names with an underscore belong to the compiler, but are often those of guards against double inclusion.
        let is_of_c = |name: &str| {
            is_c_word(name) && !(name.starts_with('_') && name.to_uppercase().contains("_H"))
                // What is added to C that is proved.
                || name.starts_with("plain_")
        };
        for header in headers {
            let found: BTreeSet<String> = macros(&header.text).into_iter().collect();
            if let Some(name) = found.into_iter().find(|name| used.contains(name) || is_of_c(name))
            {
                return Err(HeaderError::Macro { path: self.folder().join(&header.name), name });
            }
        }
        Ok(())
    }
}

/// The compiler's header that has this name of a header, or its end behind a folder: that is how it is included beside it.
fn of_compiler(name: &str) -> Result<Option<String>, ToolError> {
    let ends = name.match_indices('/').map(|(place, _)| &name[place + 1..]);
    let ends: Vec<&str> = std::iter::once(name).chain(ends).collect();
    let asked = ends
        .iter()
        .enumerate()
        .map(|(number, end)| format!("#if __has_include(<{end}>)\nknown {number}\n#endif\n"));
    let folder = temporary_folder()?;
    write(folder.path(), "asked.c", &asked.collect::<String>())?;
    let said = run(folder.path(), "gcc", &["-E", "-P", "asked.c"])?;
    let first = said.lines().find_map(|line| line.strip_prefix("known ")?.parse().ok());
    Ok(first.and_then(|number: usize| ends.get(number)).map(|end| format!("<{end}>")))
}

/// Whatever the compiler reads, however its inclusion is written, is generated, one of the headers, or the compiler's own.
fn check_included(
    headers: &[GeneratedFile],
    generated: &[GeneratedFile],
) -> Result<(), HeaderError> {
    let folder = temporary_folder()?;
    let files = || generated.iter().chain(headers);
    files().try_for_each(|file| write(folder.path(), &file.name, &file.text))?;
    let c = generated.first().map_or("", |file| file.name.as_str());
    // It leaves out the compiler's own headers, and what only these include.
    let said = run(folder.path(), "gcc", &["-std=c99", "-MM", "-MT", "c", "-I.", c]);
    let said = said.map_err(|error| match error {
        ToolError::Failed { said, .. } => HeaderError::NotCompiled { said },
        error => error.into(),
    })?;
    let known: HashSet<String> = files().filter_map(|file| plain(&file.name)).collect();
    let read = said.trim_start_matches("c:").replace("\\\n", " ").replace("\\ ", "\0");
    for name in read.split_whitespace().map(|name| name.replace('\0', " ")) {
        if !plain(&name).is_some_and(|name| known.contains(&name)) {
            return Err(HeaderError::Elsewhere { name });
        }
    }
    Ok(())
}

fn temporary_folder() -> Result<tempfile::TempDir, ToolError> {
    tempfile::tempdir()
        .map_err(|source| ToolError::Io { what: "no temporary folder".to_owned(), source })
}

/// The path of a header below a folder, without `.` and `..`; `None` if it is not below.
fn plain(name: &str) -> Option<String> {
    if Path::new(name).is_absolute() {
        return None;
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in name.split('/') {
        match part {
            "" | "." => {}
            ".." => _ = parts.pop()?,
            part => parts.push(part),
        }
    }
    (!parts.is_empty()).then(|| parts.join("/"))
}

/// A file that is included.
struct Included {
    name: String,
    /// `"x.h"`, and not `<x.h>`.
    is_quoted: bool,
}

impl Included {
    /// It may be in each of these folders, if it is quoted, and in that of the configuration, as compilers look for it.
    fn beside<'a>(self, folders: impl IntoIterator<Item = &'a str>) -> Vec<Self> {
        let Self { name, is_quoted } = self;
        let in_folder = |folder: &str| Self { name: format!("{folder}/{name}"), is_quoted };
        folders.into_iter().filter(|folder| is_quoted || *folder == ".").map(in_folder).collect()
    }
}

/// The files that a header includes.
fn included(text: &str) -> impl Iterator<Item = Included> {
    text.lines().filter_map(|line| {
        let rest = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("include")?;
        let rest = rest.trim_start();
        let is_quoted = rest.starts_with('"');
        let end = if is_quoted { '"' } else { '>' };
        let name = rest.strip_prefix(['<', '"'])?.split(end).next()?.to_owned();
        Some(Included { name, is_quoted })
    })
}
