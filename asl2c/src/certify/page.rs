//! The evidence as one page that needs nothing else.

use std::collections::HashMap;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::evidence::{Evidence, PlanEvidence, PropertyEvidence, Status, Verdict};
use super::gather::Certified;
use super::reach::Reached;
use crate::checksum::checksum;

const STYLE: &str = include_str!("page.css");

/// The page.
pub(super) fn page(certified: &Certified) -> String {
    let Certified { evidence, files } = certified;
    let text = |name: &str| {
        files.iter().find(|(file, _)| file == name).map_or("", |(_, text)| text.as_str())
    };
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (evidence.agent) ": evidence" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { "Evidence for " (evidence.agent) }
                p.faint {
                    "Made by asl2c " (env!("CARGO_PKG_VERSION")) " from " code { (evidence.configuration) } ". "
                    "Everything here can be made again from these files by " code { "asl2c certify" }
                    "; " code { "evidence.json" } " has it as data."
                }
                (summary(evidence))
                (requirements(evidence))
                (properties(evidence))
                (comparison(evidence))
                (rules(evidence))
                h2 #bounds { "Memory and time" }
                @for missing in &evidence.bounds.missing { p.undecided { (missing) } }
                pre { (evidence.bounds.report) }
                p.faint {
                    "Counts of calls in a step are those of the paths through the C, also of paths that no execution takes: "
                    "a property can say more."
                }
                (tests(evidence, text(&evidence.c)))
                (plans(evidence))
                (trust(evidence))
                h2 #files { "Files" }
                p { "SHA-256 of the files; " code { "sha256sum -c SHA256SUMS" } " checks them." }
                table {
                    @for (name, text) in files {
                        tr { td { a href=(name) { (name) } } td { code { (checksum(text.as_bytes())) } } }
                    }
                }
                h2 #agent { (evidence.agent) }
                details open { summary { "The agent's text" } (listing(text(&evidence.agent), "a", &HashMap::new())) }
                h2 #c { (evidence.c) }
                (c_listing(evidence, text(&evidence.c)))
            }
        }
    };
    markup.into_string()
}

fn word(status: Status) -> (&'static str, &'static str) {
    match status {
        Status::Shown => ("shown", "shown"),
        Status::Undecided => ("undecided", "NOT DECIDED"),
        Status::Refuted => ("refuted", "REFUTED"),
    }
}

fn marked(status: Status) -> Markup {
    let (class, word) = word(status);
    html! { span class=(class) { (word) } }
}

fn summary(evidence: &Evidence) -> Markup {
    let proved = evidence.properties.iter().filter(|p| p.verdict == Verdict::Proved).count();
    let outcome = match evidence.status() {
        Status::Shown => "All of the following is shown.",
        Status::Undecided => "Some of the following is not decided.",
        Status::Refuted => "Some of the following is refuted.",
    };
    let validation = &evidence.validation;
    let passed = evidence.tests.iter().filter(|test| test.difference.is_none()).count();
    html! {
        p.outcome class=(word(evidence.status()).0) { (outcome) }
        table {
            tr { th { "Claim" } th { "Result" } th { "How" } }
            tr {
                td { a href="#comparison" { "The C does what the agent's text says" } }
                td.short { (marked(validation.status)) }
                td { (validation.proofs) " proofs by CBMC against a second translation: every environment, any number of steps" }
            }
            tr {
                td { a href="#properties" { "The properties hold" } }
                td.short { (marked(evidence.properties_status())) }
                td { (proved) " of " (evidence.properties.len()) " proved by CBMC: every environment, any number of steps" }
            }
            tr {
                td { a href="#properties" { "There is no error at run time" } }
                td.short { (marked(evidence.run_time_status())) }
                td { "CBMC and Frama-C: no access outside an object, no overflow, no division by zero, no conversion that loses" }
            }
            tr {
                td { a href="#rules" { "The C follows MISRA C:2012" } }
                td.short { (marked(evidence.rules_status())) }
                td { (evidence.deviations.len()) " deviations from the rules that cppcheck checks" }
            }
            tr {
                td { a href="#bounds" { "Memory and time are bounded" } }
                td.short { (marked(evidence.bounds_status())) }
                td { "No heap, no recursion, no unbounded loop; stack and longest path from the compiled code" }
            }
            tr {
                td { a href="#tests" { "The C passes the tests that are made from the agent's text" } }
                td.short { (marked(evidence.tests_status())) }
                td {
                    (passed) " of " (evidence.tests.len()) " tests. They reach all "
                    (evidence.reach.outcomes.all) " outcomes of conditions but "
                    (evidence.reach.outcomes.unreachable) " that are proved to be unreachable and "
                    (evidence.reach.outcomes.open()) " others"
                    @if let untested = evidence.untested_plans() && !untested.is_empty() {
                        "; " a href="#plans" { (untested.len()) " plans" } " are chosen by none"
                    }
                }
            }
        }
    }
}

fn plan_link(plan: &PlanEvidence) -> Markup {
    let label = if plan.label.is_empty() { String::new() } else { format!(" @{}", plan.label) };
    html! {
        a href=(format!("#a{}", plan.lines.0)) { "line " (plan.lines.0) } " " code { (plan.trigger) (label) }
        " → " a href=(format!("#c{}", plan.c_lines.0)) { code { (plan.function) } }
    }
}

fn test_links(evidence: &Evidence, numbers: &[usize]) -> Markup {
    const SHOWN: usize = 8;
    html! {
        @for number in numbers.iter().take(SHOWN) {
            @if let Some(test) = evidence.tests.get(number - 1) { a href=(test.file) { (number) } " " }
        }
        @if numbers.len() > SHOWN { span.faint { "and " (numbers.len() - SHOWN) " more" } }
        @if numbers.is_empty() { span.undecided { "none" } }
    }
}

fn requirements(evidence: &Evidence) -> Markup {
    html! {
        h2 #requirements { "Requirements" }
        @if evidence.requirements.is_empty() {
            p { "Neither plans nor properties name any." }
        } @else {
            p.faint { "From the requirement to the plans that implement it and their C, to the properties that are proved, and to the tests in which its plans are chosen." }
            table {
                tr { th { "Requirement" } th { "Plans and their C" } th { "Properties" } th { "Tests" } }
                @for requirement in &evidence.requirements {
                    tr {
                        td.short { (requirement.tag) }
                        td {
                            @for index in &requirement.plans { (plan_link(&evidence.plans[*index])) br; }
                            @if requirement.plans.is_empty() { span.faint { "none" } }
                        }
                        td {
                            @for index in &requirement.properties {
                                @let property = &evidence.properties[*index];
                                a href=(format!("#p-{}", property.name)) { (property.name) }
                                " " (marked(property.verdict.status())) br;
                            }
                            @if requirement.properties.is_empty() { span.faint { "none" } }
                        }
                        td { (test_links(evidence, &requirement.tests)) }
                    }
                }
            }
        }
    }
}

fn verdict(property: &PropertyEvidence) -> Markup {
    html! {
        (marked(property.verdict.status()))
        @if let Verdict::Fails { story, script } = &property.verdict {
            details {
                summary { "counterexample" }
                pre { (story.join("\n")) }
                p { "To replay it: " code { "asl2c run" } " with " a href=(script) { (script) } }
            }
        }
    }
}

fn properties(evidence: &Evidence) -> Markup {
    html! {
        h2 #properties { "Properties" }
        @if evidence.properties.is_empty() { p { "The configuration declares none." } }
        table {
            @if !evidence.properties.is_empty() {
                tr { th { "Property" } th { "Requirement" } th { "What must hold" } th { "Result" } }
            }
            @for property in &evidence.properties {
                tr id=(format!("p-{}", property.name)) {
                    td { (property.name) }
                    td { (property.requirements.join(", ")) }
                    td { code { (property.formula) } }
                    td { (verdict(property)) }
                }
            }
        }
        @for error in &evidence.run_time_errors {
            p { "At run time: " code { (error.name) } " " (verdict(error)) }
        }
        details {
            summary { "The invariant: " (evidence.invariant.len()) " conditions on the agent's state" }
            p.faint { "The initial state satisfies it, and from any state that satisfies it each call leads to one that does." }
            pre { (evidence.invariant.join("\n")) }
        }
    }
}

fn comparison(evidence: &Evidence) -> Markup {
    let validation = &evidence.validation;
    html! {
        h2 #comparison { "The C and the agent's text" }
        p {
            (marked(validation.status)) ": the text is translated a second time, into plain C by code that shares nothing "
            "with the back end. From any two related states, with the same answers of the environment, each call makes the "
            "same calls in the same order and ends in related states (" (validation.proofs) " proofs, up to "
            (validation.calls) " answers of an action in a step)."
        }
        @if validation.timeouts > 0 { p.undecided { (validation.timeouts) " proofs reached their time limit." } }
        @for said in &validation.open { p { "Open: " code { (said) } } }
    }
}

fn rules(evidence: &Evidence) -> Markup {
    html! {
        h2 #rules { "MISRA C:2012" }
        p {
            "cppcheck and its MISRA addon find " (evidence.deviations.len()) " deviations. The addon does not check all "
            "rules. That the interface's functions are not called in the C itself is no finding."
        }
        @if !evidence.deviations.is_empty() {
            table {
                tr { th { "Place" } th { "Rule" } th { "Finding" } }
                @for deviation in &evidence.deviations {
                    tr {
                        td.short { (deviation.file) ":" (deviation.line) }
                        td.short { (deviation.rule) }
                        td { (deviation.said) }
                    }
                }
            }
        }
    }
}

fn tests(evidence: &Evidence, c: &str) -> Markup {
    let lines: Vec<&str> = c.lines().collect();
    let failed: Vec<_> = (1..)
        .zip(&evidence.tests)
        .filter_map(|(number, test)| Some((number, test, test.difference.as_ref()?)))
        .collect();
    html! {
        h2 #tests { "Tests" }
        p {
            "The tests are made by running the agent's text in the reference interpreter with random calls and answers, and "
            "keeping what reaches something new: a plan, an outcome of a condition, values that are less, equal or greater in a "
            "comparison. Each is executed on the C by " code { "tests/tests.c" }
            "; all calls in either direction must be the same, in order and with all values. "
            (evidence.tests.len()) " tests, " (failed.len()) " differ."
        }
        @for (number, test, difference) in failed {
            p.refuted { "Test " (number) " (" a href=(test.file) { (test.file) } "): " (difference) }
        }
        table {
            tr { th { "Of the C" } th { "Tested" } th { "Proved to be unreachable" } th { "Open" } th { "All" } }
            (reached("Statements (lines)", evidence.reach.statements))
            (reached("Decisions (outcomes of conditions)", evidence.reach.outcomes))
            (reached("MC/DC (conditions that decide independently)", evidence.reach.conditions))
        }
        @for line in &evidence.reach.contradictions {
            p.refuted {
                "A test reaches in " a href=(format!("#c{line}")) { "line " (line) }
                " what is proved to be unreachable: the proof or the measurement is wrong."
            }
        }
        p.faint {
            "Measured by gcov. Nearly all decisions of the C are single conditions, for which MC/DC is both outcomes; "
            "conditions of a chain count if both outcomes of each were seen, and as unreachable if all that are missing are. "
            (evidence.not_measured)
            " conditions in mixtures of && and || count as open, because the counts do not tell. What is unreachable is "
            "proved by CBMC from the invariant, for executions without a call of clear() and a second call of init(). "
            "The overflow of a counter of events is open: it would take 4 294 967 295 events."
        }
        @if !evidence.reach.open_lines.is_empty() {
            details {
                summary { (evidence.reach.open_lines.len()) " lines with something open" }
                @for number in &evidence.reach.open_lines {
                    a href=(format!("#c{number}")) { "line " (number) } " "
                    code { (lines.get(number - 1).map_or("", |line| line.trim())) } br;
                }
            }
        }
    }
}

fn reached(what: &str, reached: Reached) -> Markup {
    html! {
        tr {
            td { (what) }
            td { (reached.tested) }
            td { (reached.unreachable) }
            td { (reached.open()) }
            td { (reached.all) }
        }
    }
}

fn plans(evidence: &Evidence) -> Markup {
    html! {
        h2 #plans { "Plans" }
        table {
            tr { th { "Plan" } th { "C" } th { "Statements" } th { "Outcomes" } th { "Chosen in tests" } }
            @for plan in &evidence.plans {
                tr {
                    td {
                        a href=(format!("#a{}", plan.lines.0)) { "line " (plan.lines.0) } " " code { (plan.trigger) }
                        @if !plan.label.is_empty() { " " code { "@" (plan.label) } }
                    }
                    td { a href=(format!("#c{}", plan.c_lines.0)) { "lines " (plan.c_lines.0) " to " (plan.c_lines.1) } }
                    td.short { (plan.statements) }
                    td.short { (plan.outcomes) }
                    td { (test_links(evidence, &plan.tests)) }
                }
            }
        }
    }
}

fn trust(evidence: &Evidence) -> Markup {
    html! {
        h2 #trust { "What has to be believed" }
        table {
            tr { th { "Program" } th { "Version" } th { "For what" } }
            @for tool in &evidence.tools {
                tr { td.short { (tool.name) } td { (tool.version) } td { (tool.trust) } }
            }
        }
        ul { @for assumption in &evidence.assumptions { li { (assumption) } } }
    }
}

fn c_listing(evidence: &Evidence, text: &str) -> Markup {
    let mut classes = HashMap::new();
    classes.extend(evidence.reach.open_lines.iter().map(|line| (*line, "part")));
    classes.extend(evidence.reach.unreachable_lines.iter().map(|line| (*line, "no")));
    html! {
        details open {
            summary { "The C" }
            p.faint {
                span.part { (evidence.reach.open_lines.len()) " lines" } " have a statement or an outcome that no test reaches; "
                span.no { (evidence.reach.unreachable_lines.len()) " lines" } " one that is proved to be unreachable."
            }
            (listing(text, "c", &classes))
        }
    }
}

/// A text with numbers of lines, to which links lead.
fn listing(text: &str, prefix: &str, classes: &HashMap<usize, &str>) -> Markup {
    html! {
        pre.text {
            @for (number, line) in (1_usize..).zip(text.lines()) {
                span id=(format!("{prefix}{number}")) class=[classes.get(&number)] { i { (number) } (line) }
                "\n"
            }
        }
    }
}
