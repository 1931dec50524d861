//! The wind in the frame of the plan, for people.

/// Where it comes from, clockwise by eighths, beginning with one that blows forward.
pub(super) const FROM: [&str; 8] = [
    "from behind",
    "from behind left",
    "from the left",
    "from the front left",
    "from the front",
    "from the front right",
    "from the right",
    "from behind right",
];

/// Where a wind comes from that pushes the drone towards right and forward like this.
pub(super) fn from([right, forward]: [f64; 2]) -> &'static str {
    let eighths = (right.atan2(forward).to_degrees() / 45.0).round().rem_euclid(8.0);
    // One of 0 to 7; what is no number is 0.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    FROM[eighths as usize % FROM.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wind_comes_from_the_other_side_than_it_pushes_to() {
        for (towards, side) in [
            ([0.0, 1.0], "from behind"),
            ([2.0, 0.3], "from the left"),
            ([1.0, -1.0], "from the front left"),
            ([0.0, -3.0], "from the front"),
            ([-1.0, 0.0], "from the right"),
            ([-1.0, 1.2], "from behind right"),
        ] {
            assert_eq!(from(towards), side, "{towards:?}");
        }
    }
}
