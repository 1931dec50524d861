//! Stages of a tick, for measuring the cost of each.

/// Stages of a tick, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Navdata since the last tick: decoding and estimation.
    Estimate,
    /// Percepts and the agent's step.
    Agent,
    /// The safety layer and the control law.
    Control,
    /// Encoding the datagram.
    Encode,
    /// The system call.
    Send,
}

impl Stage {
    /// All stages, in order.
    pub const ALL: [Self; 5] =
        [Self::Estimate, Self::Agent, Self::Control, Self::Encode, Self::Send];

    /// Its name, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Estimate => "estimate",
            Self::Agent => "agent",
            Self::Control => "control",
            Self::Encode => "encode",
            Self::Send => "send",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_named_like_their_variants() {
        for stage in Stage::ALL {
            assert_eq!(stage.name(), format!("{stage:?}").to_lowercase());
        }
    }
}
