//! HTML of the report.

use std::fmt::Write as _;
use std::time::Duration;

use diagnostic::printable;
use serde_json::json;
use time::UtcDateTime;

use super::data::Flight;
use super::events::Kind;
use super::findings::Finding;
use super::pictures::EmbeddedPicture;
use super::series::Series;
use crate::json;
use crate::recording::Log;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// Maximum rows of the tables of decisions and events; the plots show everything.
const MOST_ROWS: usize = 400;
const MOST_EVENTS: usize = 1000;
/// Lateness of ticks is counted in tenths of a millisecond; the last count is all that is later.
const LATE_COUNTS: usize = 51;
const LATE_COUNTS_A_MS: f64 = 10.0;

/// What a page is about, besides what happened in the flight.
pub(super) struct About<'a> {
    /// The plan's name; empty without one.
    pub(super) plan: &'a str,
    /// Whether it is a warning, and text; `None` for a recording that was cut off.
    pub(super) outcome: Option<(bool, String)>,
    /// The flight among those of the recording, from 0.
    pub(super) index: usize,
    /// Addresses of the pages of all flights.
    pub(super) links: Vec<String>,
    /// What led to the outcome.
    pub(super) findings: Vec<Finding>,
}

/// The whole page.
pub(super) fn html(
    log: &Log,
    flight: &Flight<'_>,
    about: &About<'_>,
    pictures: &[EmbeddedPicture],
) -> String {
    let mut page = String::new();
    let title = escaped(&title(log, about));
    // Writing to a string cannot fail.
    _ = write!(
        page,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}: flight report</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n"
    );
    other_flights(&mut page, about);
    head(&mut page, log, flight, about);
    findings(&mut page, &about.findings);
    let picture = if pictures.is_empty() {
        ""
    } else {
        "<canvas id=\"picture\" width=\"640\" height=\"360\" role=\"img\" \
         aria-label=\"what the camera saw\"></canvas>\n<p class=\"faint\" id=\"nopicture\"></p>\n"
    };
    let tag_text =
        if flight.tags.is_empty() { "" } else { "<p class=\"faint\" id=\"tagtext\"></p>\n" };
    _ = write!(
        page,
        "<noscript><p>The plots and the map are drawn by a script.</p></noscript>\n\
         <div class=\"columns\">\n<div class=\"side\">\n\
         <section class=\"card mapcard\"><h2>Map</h2>\n<div class=\"map\"><svg id=\"map\" role=\"img\" \
         aria-label=\"the way from above: the part flown at the cursor, the drone, other vehicles, targets, tags, the fence, and the wind\"></svg></div>\n\
         {tag_text}</section>\n\
         <section class=\"card whycard\"><h2>At the cursor</h2>\n{picture}<div id=\"moment\"></div></section>\n\
         </div>\n<div id=\"plots\">\n<div id=\"axis\"><div class=\"plot\" id=\"overview\"></div>\n\
         <div id=\"zoom\"><button id=\"in\" aria-label=\"zoom in\">+</button>\
         <button id=\"out\" aria-label=\"zoom out\">−</button><button id=\"whole\">whole flight</button>\
         <span id=\"part\"></span></div></div>\n\
         <p class=\"legend\"><span><span class=\"band ground\"></span>on the ground</span>\
         <span><span class=\"band odd\"></span>every other step of the plan</span>\
         <span><span class=\"band other\"></span>in the air without a step</span>\
         <span>Ctrl and the wheel, or two fingers, zoom; a drag moves; arrow keys move the cursor</span></p>\n\
         <div id=\"all\"></div>\n<h3>How late ticks were (a logarithmic scale; the last bar is all that is later)</h3>\n\
         <svg id=\"late\" role=\"img\" aria-label=\"how late ticks were\" viewBox=\"0 0 330 102\" width=\"330\" height=\"102\">\
         </svg>\n</div>\n</div>\n"
    );
    timeline(&mut page, flight);
    events(&mut page, flight);
    _ = write!(
        page,
        "</main>\n<script type=\"application/json\" id=\"decided\">{}</script>\n\
         <script type=\"application/json\" id=\"pictures\">{}</script>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        json::text(&decided(flight)),
        json::text(&json!(pictures)),
    );
    page
}

/// What the script draws.
fn decided(flight: &Flight<'_>) -> serde_json::Value {
    let tags: Vec<_> =
        flight.tags.iter().map(|(at_s, tags)| json!({ "at_s": at_s, "tags": tags.tags })).collect();
    let mut late = [0_u32; LATE_COUNTS];
    for late_ms in flight.lateness_ms() {
        // Lateness is not negative; what is later than the last count is in it.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let count = (late_ms * LATE_COUNTS_A_MS) as usize;
        late[count.min(LATE_COUNTS - 1)] += 1;
    }
    json!({
        "begin": flight.begin_s,
        "end": flight.end_s,
        "fence": flight.fence.as_ref().map(|border| json!({
            "text": border.to_string(),
            "corners": border.sides_m().map(|[corner, _]| corner).collect::<Vec<_>>(),
        })),
        "series": Series::new(&flight.rows, &flight.scales),
        "bands": flight.bands,
        "beliefs": flight.beliefs,
        "states": flight.states,
        "events": flight.events,
        "decisions": flight.decisions,
        "plans": flight.plans,
        "tags": tags,
        "others": flight.others,
        "start": flight.start_m,
        "late": late.as_slice(),
    })
}

/// Links to the other flights of the recording.
fn other_flights(page: &mut String, about: &About<'_>) {
    let count = about.links.len();
    if count < 2 || about.links.iter().any(String::is_empty) {
        return;
    }
    *page += "<nav aria-label=\"flights of this recording\">";
    for (index, link) in about.links.iter().enumerate() {
        let number = index + 1;
        if index == about.index {
            _ = write!(page, "<b>flight {number} of {count}</b>");
        } else {
            _ = write!(page, "<a href=\"{}\">flight {number}</a>", escaped(link));
        }
    }
    *page += "</nav>\n";
}

/// What led to the outcome, each with its time.
fn findings(page: &mut String, findings: &[Finding]) {
    *page += "<section class=\"card\"><h2>What led to it</h2>\n";
    if findings.is_empty() {
        *page += "<p>Nothing that was recorded is out of the ordinary.</p>\n";
    }
    *page += "<ol id=\"findings\">\n";
    for Finding { at_s, text } in findings {
        _ = writeln!(
            page,
            "<li><button data-at=\"{at_s}\">{at_s:.2} s</button><span>{}</span></li>",
            escaped(text)
        );
    }
    *page += "</ol>\n</section>\n";
}

/// What was flown.
fn title(log: &Log, about: &About<'_>) -> String {
    match (about.plan, log.mission_agent.as_str()) {
        ("", "") => "flown by orders".to_owned(),
        ("", agent) => format!("flown by the agent {agent}"),
        (plan, _) => plan.to_owned(),
    }
}

/// Summary at the top.
fn head(page: &mut String, log: &Log, flight: &Flight<'_>, about: &About<'_>) {
    let (plan, drone) = (escaped(&title(log, about)), escaped(&log.drone));
    _ = write!(
        page,
        "<h1>{plan}</h1>\n<p class=\"faint\">{}{}, {drone}, ardrone-pilot {}</p>\n",
        date(log, flight.begin_s),
        log.vehicle,
        escaped(&log.version)
    );
    let warning = flight.events.iter().find(|event| event.kind == Kind::Warning);
    let warning =
        warning.map(|event| format!("; first warning at {:.1} s: {}", event.at_s, event.text));
    let (ill, ended) = match &about.outcome {
        Some((warns, text)) => (*warns, text.as_str()),
        None => (true, "the log was cut off: what is here is what was written before"),
    };
    let class = if ill || warning.is_some() { "outcome warn" } else { "outcome" };
    let summary = format!("{ended}{}", warning.unwrap_or_default());
    _ = writeln!(page, "<p class=\"{class}\">{}</p>\n<div class=\"facts\">", escaped(&summary));
    let mut fact = |name: &str, value: String| {
        _ = writeln!(page, "<div><b>{value}</b>{name}</div>");
    };
    let [done, all] = flight.steps;
    fact("steps done", format!("{done} of {all}"));
    fact("in the air", format!("{:.1} s", flight.flown_s()));
    if let Some((begin, end)) = flight.battery_percent() {
        fact("battery", format!("{begin} to {end} %"));
    }
    if let Some((begin, end)) = flight.battery_v() {
        fact("battery voltage", format!("{begin:.2} to {end:.2} V"));
    }
    let estimates = || flight.ticks().filter_map(|(_, tick)| tick.estimate);
    let [x_m, y_m] = estimates().next().map_or([0.0; 2], |at| [at.x_m, at.y_m]);
    let away = estimates().map(|at| (at.x_m - x_m).hypot(at.y_m - y_m));
    fact("furthest from the start", format!("{:.2} m", away.fold(0.0, f64::max)));
    if let Some(last) = estimates().next_back() {
        let uncertainty = format!("uncertainty at the end, {}", last.rests_on());
        fact(&escaped(&uncertainty), format!("{:.2} m", last.uncertainty_m));
    }
    let height = estimates().map(|at| at.z_m);
    fact("highest", format!("{:.2} m", height.fold(0.0, f64::max)));
    let late = flight.lateness_ms();
    let at = |share: f64| {
        // Index of a quantile.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let index = (share * late.len() as f64) as usize;
        late.get(index.min(late.len().saturating_sub(1))).copied().unwrap_or_default()
    };
    fact("late, 99 of 100 ticks at most", format!("{:.2} ms", at(0.99)));
    fact("ticks", late.len().to_string());
    *page += "</div>\n";
}

/// Date and time of a moment of the recording, if it has one.
fn date(log: &Log, at_s: f64) -> String {
    let begun = Duration::try_from_secs_f64(at_s).unwrap_or_default();
    let date = i64::try_from(log.start.saturating_add(begun).as_secs()).ok();
    let date = date.and_then(|seconds| UtcDateTime::from_unix_timestamp(seconds).ok());
    date.map_or_else(String::new, |date| {
        let (day, time) = (date.date(), date.time());
        format!(
            "{:04}-{:02}-{:02} {:02}:{:02} UTC, ",
            day.year(),
            u8::from(day.month()),
            day.day(),
            time.hour(),
            time.minute()
        )
    })
}

/// Table of the agent's decisions and how long each lasted.
fn timeline(page: &mut String, flight: &Flight<'_>) {
    *page += "<h2>Decisions</h2>\n<table id=\"timeline\">\n<thead><tr><th>from</th><th>for</th><th>step</th>\
              <th>ordered</th><th>because of</th><th></th></tr></thead>\n<tbody>\n";
    for (index, decision) in flight.decisions.iter().enumerate().take(MOST_ROWS) {
        let plans: Vec<String> = decision
            .plans
            .iter()
            .map(|(trigger, line)| {
                let source = flight.plans.get(line).map_or("", String::as_str);
                let head = source.split("<-").next().unwrap_or_default();
                let head = head.split_whitespace().collect::<Vec<_>>().join(" ");
                let head = if head.is_empty() { trigger.clone() } else { head };
                format!("<pre>{line}: {}</pre>", escaped(&head))
            })
            .collect();
        _ = writeln!(
            page,
            "<tr data-index=\"{index}\" data-at=\"{}\"><td class=\"time\">{:.2} s</td><td class=\"time\">{:.2} s</td><td>{}</td>\
             <td>{}</td><td>{}</td><td>{} <span class=\"warn\">{}</span></td></tr>",
            decision.from_s,
            decision.from_s,
            decision.to_s - decision.from_s,
            escaped(&decision.step),
            escaped(&decision.command),
            plans.concat(),
            escaped(decision.said.as_deref().unwrap_or_default()),
            escaped(&decision.warnings.join("; "))
        );
    }
    *page += "</tbody>\n</table>\n";
    let more = flight.decisions.len().saturating_sub(MOST_ROWS);
    if more > 0 {
        _ = writeln!(page, "<p class=\"faint\">… and {more} more; the plots show all of them.</p>");
    }
}

/// Everything that happened, in the order of time.
fn events(page: &mut String, flight: &Flight<'_>) {
    *page += "<h2>Events</h2>\n<table id=\"events\">\n<tbody>\n";
    for event in flight.events.iter().take(MOST_EVENTS) {
        let class = if event.kind.warns() { " class=\"warn\"" } else { "" };
        _ = writeln!(
            page,
            "<tr data-at=\"{0}\"><td class=\"time\">{0:.2} s</td><td class=\"faint\">{1}</td><td{class}>{2}</td></tr>",
            event.at_s,
            event.kind.name(),
            escaped(&event.text)
        );
    }
    *page += "</tbody>\n</table>\n";
    let more = flight.events.len().saturating_sub(MOST_EVENTS);
    if more > 0 {
        _ = writeln!(page, "<p class=\"faint\">… and {more} more; the plots show all of them.</p>");
    }
}

/// Escapes text for HTML content and quoted attributes, in one line.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in printable(text).chars() {
        match character {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\'' => escaped += "&#39;",
            other => escaped.push(other),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    #[test]
    fn text_is_no_markup() {
        assert_eq!(super::escaped("<b a=\"1\">&'"), "&lt;b a=&quot;1&quot;&gt;&amp;&#39;");
        assert_eq!(super::escaped("\u{202e}\x1b"), "\\u{202e}\\u{1b}");
    }
}
