//! The stages of a tick, for those who measure what each costs.

/// Stages of a tick, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Navdata since the last tick: decoded, and taken into the estimate.
    Estimate,
    /// The agent's step, and what it looks at.
    Agent,
    /// The safety layer and the control law.
    Control,
    /// The datagram.
    Encode,
    /// The system's call.
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
