//! The agent's source text.

/// Source of the agent in use.
pub const SOURCE: &str = include_str!("../../agent/autopilot.asl");

/// Text of the plan that begins at `line`, counted from 1, up to its full stop; empty behind the last line.
pub fn plan_text(agent: &str, line: u32) -> &str {
    let first = usize::try_from(line).unwrap_or(1).saturating_sub(1);
    let start: usize = agent.split_inclusive('\n').take(first).map(str::len).sum();
    let rest = agent.get(start..).unwrap_or_default();
    let end = rest.split_inclusive('\n').scan(0, |end, line| {
        *end += line.len();
        Some((*end, line.trim_end().ends_with('.')))
    });
    let end = end.into_iter().find(|(_, last)| *last).map_or(rest.len(), |(end, _)| end);
    rest[..end].trim_end()
}

#[cfg(test)]
mod tests {
    use super::plan_text;

    #[test]
    fn a_plan_goes_to_its_full_stop() {
        let agent = "!wait.\n// A comment.\n+!wait : a\n  <- b;\n     !!wait.\n+!c <- d.\n";
        assert_eq!(plan_text(agent, 3), "+!wait : a\n  <- b;\n     !!wait.");
        assert_eq!(plan_text(agent, 6), "+!c <- d.");
        assert_eq!(plan_text(agent, 99), "");
    }
}
