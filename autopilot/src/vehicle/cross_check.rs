//! What the claimed place rests on, and what may contradict it.

use std::fmt;
use std::time::Duration;

use estimator::TagStatus;

/// A tag that was seen this recently is in view.
pub(super) const IN_VIEW: Duration = Duration::from_secs(1);

/// What the claimed deviation of the horizontal position rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RestsOn {
    /// The drone's own velocity alone, since the start.
    Velocity,
    /// A tag on the floor, and the drone's own velocity since it was seen.
    Tag {
        /// Time since then.
        seen_ago: Duration,
    },
}

impl RestsOn {
    /// What the place rests on, if this is known by tags.
    pub fn of(tags: Option<&TagStatus>) -> Self {
        let seen_ago = tags.and_then(|tags| tags.seen_ago);
        seen_ago.map_or(Self::Velocity, |seen_ago| Self::Tag { seen_ago })
    }

    /// Its name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Tag { .. } => "tag",
        }
    }
}

impl fmt::Display for RestsOn {
    /// The condition under which the claim holds.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Velocity => f.write_str("if the drone's velocity is right"),
            Self::Tag { seen_ago } if *seen_ago <= IN_VIEW => f.write_str("by a tag in view"),
            Self::Tag { seen_ago } => write!(
                f,
                "by a tag {:.0} s ago, if the drone's velocity is right since",
                seen_ago.as_secs_f64()
            ),
        }
    }
}

/// What contradicts the claimed place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrossCheck {
    /// A tag on the floor moved against the drone's velocity, or was not seen where the place would have it.
    Tags,
    /// The flight recorder's GPS is further away than it and the place may be off.
    Gps,
}

impl CrossCheck {
    /// Its name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tags => "tags",
            Self::Gps => "gps",
        }
    }
}

impl fmt::Display for CrossCheck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Tags => "a tag on the floor",
            Self::Gps => "the GPS",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_told_with_what_it_rests_on() {
        let of = |seen_ago: Option<u64>| {
            let seen_ago = seen_ago.map(Duration::from_secs);
            RestsOn::of(Some(&TagStatus { seen_ago, ..TagStatus::default() })).to_string()
        };
        assert_eq!(RestsOn::of(None).to_string(), "if the drone's velocity is right");
        assert_eq!(of(None), "if the drone's velocity is right");
        assert_eq!(of(Some(0)), "by a tag in view");
        assert_eq!(of(Some(40)), "by a tag 40 s ago, if the drone's velocity is right since");
    }

    #[test]
    fn what_a_claim_rests_on_and_what_contradicts_it_have_names() {
        let tag = RestsOn::Tag { seen_ago: IN_VIEW };
        assert_eq!([RestsOn::Velocity.name(), tag.name()], ["velocity", "tag"]);
        for (by, name, text) in
            [(CrossCheck::Tags, "tags", "a tag on the floor"), (CrossCheck::Gps, "gps", "the GPS")]
        {
            assert_eq!((by.name(), by.to_string().as_str()), (name, text));
        }
    }
}
