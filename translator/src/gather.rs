//! Orders the diagnostics of an agent's texts by importance.

use std::cmp::Reverse;

use diagnostic::{Diagnostic, Diagnostics, Source};

use crate::code::Code;

/// All findings in some texts: errors before warnings, warnings by importance, otherwise in the order of the
/// texts.
pub(crate) fn gather<const N: usize>(found: [(Vec<Diagnostic>, Source<'_>); N]) -> Diagnostics {
    let mut all = Vec::new();
    let mut sources = Vec::new();
    for (index, (diagnostics, source)) in found.into_iter().enumerate() {
        sources.push(source.into());
        all.extend(diagnostics.into_iter().map(|mut diagnostic| {
            diagnostic.source = index;
            diagnostic
        }));
    }
    let rank = |code: &str| Code::warnings().position(|warning| warning.name() == code);
    all.sort_by_key(|diagnostic| {
        let Diagnostic { severity, code, source, span, .. } = diagnostic;
        (Reverse(*severity), rank(code), *source, span.start)
    });
    Diagnostics::new(sources, all)
}
