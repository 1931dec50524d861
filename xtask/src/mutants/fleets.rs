//! Mutants of what keeps vehicles apart, which `cargo xtask fleets` must detect.

use super::list::{Mutant, SAFETY, mutant};
use crate::edit::{edit, layered};

const SEPARATION: &str = "autopilot/src/separation.rs";
const NEIGHBOURS: &str = "autopilot/src/vehicle/neighbours.rs";

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    mutant(
        "nobody is kept apart",
        SAFETY,
        "if others.is_empty() || !now.airborne || !moves {",
        "if others.len() < usize::MAX || !now.airborne || !moves {",
    ),
    mutant(
        "what was told is believed however old it is",
        SEPARATION,
        "let age = now.saturating_sub(self.at);",
        "let age = now.saturating_sub(self.at) * 0;",
    ),
    mutant(
        "of two that are about to take off nobody is the first",
        SEPARATION,
        "away_m < other.separation_m || is_beyond && system < oneself.system",
        "away_m < other.separation_m || is_beyond && system < u8::MAX",
    ),
    mutant(
        "a place is believed that nobody can have got to",
        SEPARATION,
        "let has_jumped = jump_m > furthest_m && !stands;",
        "let has_jumped = jump_m > furthest_m.max(f64::MAX) && !stands;",
    ),
    mutant(
        "who is not heard any more is forgotten at once",
        SEPARATION,
        "self.0.iter().filter(|known| known.told.presence != Presence::Stands);",
        "self.0.iter().filter(|known| known.told.presence != Presence::Stands && now.saturating_sub(known.told.at) < GOES_ON);",
    ),
    // The judge excuses what the error of a place leads to, and nothing else.
    layered(
        mutant(
            "who has had a wrong sensor keeps away from nobody",
            NEIGHBOURS,
            "let others = self.neighbours.others(now, &oneself);",
            "self.neighbours.1 |= self.flight.estimator.trust() != estimator::Trust::Sound;\n        let mut others = self.neighbours.others(now, &oneself);\n        if self.neighbours.1 { others.clear(); }",
        ),
        &[edit(
            SEPARATION,
            "pub(crate) struct Neighbours(ArrayVec<Known, MAX_NEIGHBOURS>);",
            "pub(crate) struct Neighbours(ArrayVec<Known, MAX_NEIGHBOURS>, pub(crate) bool);",
        )],
    ),
];
