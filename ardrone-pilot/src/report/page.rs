//! HTML of the report.

use std::fmt::Write as _;

use diagnostic::printable;
use serde_json::json;
use time::UtcDateTime;

use super::data::Flight;
use super::pictures::EmbeddedPicture;
use super::plots::{LEFT, Plot, RIGHT, WIDTH};
use crate::json;
use crate::recording::Log;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// Maximum rows of the decision table; the plots show all decisions.
const MOST_ROWS: usize = 400;

/// The whole page.
pub(super) fn html(
    log: &Log,
    flight: &Flight<'_>,
    plots: &[Plot],
    pictures: &[EmbeddedPicture],
) -> String {
    let mut page = String::new();
    let title = escaped(&title(log));
    // Writing to a string cannot fail.
    _ = write!(
        page,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}: flight report</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n"
    );
    head(&mut page, log, flight);
    _ = write!(
        page,
        "<div class=\"columns\">\n<div id=\"plots\" data-end=\"{}\" data-width=\"{WIDTH}\" data-left=\"{LEFT}\" \
         data-right=\"{RIGHT}\">\n",
        flight.end_s
    );
    page += "<p class=\"legend faint\">Background: <span style=\"background:#e9e9e9\">on the ground</span>\
             <span style=\"background:#eff5fa\">every other step of the plan</span>\
             <span style=\"background:#f9e7dc\">in the air without a step</span></p>\n";
    for plot in plots {
        let Plot { title, over_time, legend, svg, map } = plot;
        let legend: Vec<String> = legend
            .iter()
            .map(|(name, colour)| format!("<span style=\"color:{colour}\">{name}</span>"))
            .collect();
        let legend = legend.concat();
        let (kind, cursor) = match map {
            _ if *over_time => ("plot", "<div class=\"cursor\"></div>"),
            Some(_) => ("still map", ""),
            None => ("still", ""),
        };
        let svg = svg.replace("<svg ", &format!("<svg role=\"img\" aria-label=\"{title}\" "));
        // The keyboard moves the cursor of a plot that has the focus.
        let focus = if *over_time { " tabindex=\"0\"" } else { "" };
        _ = writeln!(
            page,
            "<h2>{title} <small>{legend}</small></h2>\n<div class=\"{kind}\"{focus}>{svg}{cursor}</div>"
        );
        if map.is_some() && !flight.tags.is_empty() {
            page += "<p class=\"faint\" id=\"tagtext\"></p>\n";
        }
    }
    let picture = if pictures.is_empty() {
        ""
    } else {
        "<canvas id=\"picture\" width=\"640\" height=\"360\" role=\"img\" \
         aria-label=\"what the camera saw\"></canvas>\n<p class=\"faint\" id=\"nopicture\"></p>\n"
    };
    _ = write!(
        page,
        "</div>\n<div class=\"why\"><h2>Why?</h2>\n{picture}<div id=\"moment\"><p class=\"faint\">Move over a \
         plot, or with the arrow keys in it: the moment, what was ordered, and the agent's plan behind it.</p></div>\
         </div>\n</div>\n"
    );
    timeline(&mut page, flight);
    events(&mut page, flight);
    let tags: Vec<_> =
        flight.tags.iter().map(|(at_s, tags)| json!({ "at_s": at_s, "tags": tags.tags })).collect();
    let decided = json!({
        "decisions": flight.decisions,
        "plans": flight.plans,
        "tags": tags,
        "map": plots.iter().find_map(|plot| plot.map),
    });
    _ = write!(
        page,
        "<script type=\"application/json\" id=\"decided\">{}</script>\n\
         <script type=\"application/json\" id=\"pictures\">{}</script>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        json::text(&decided),
        json::text(&json!(pictures)),
    );
    page
}

/// The plans that were flown.
fn title(log: &Log) -> String {
    let mut names = vec![log.plan_name.as_str()];
    names.extend(log.missions().map(|(_, mission)| mission.name.as_str()));
    names.retain(|name| !name.is_empty());
    names.dedup();
    match names.as_slice() {
        [] => "flown by orders".to_owned(),
        [first, .., last] if names.len() > 3 => {
            format!("{first} to {last}, {} missions", names.len())
        }
        names => names.join(", "),
    }
}

/// Summary at the top.
fn head(page: &mut String, log: &Log, flight: &Flight<'_>) {
    let date = i64::try_from(log.start.as_secs()).ok();
    let date = date.and_then(|seconds| UtcDateTime::from_unix_timestamp(seconds).ok());
    let date = date.map_or_else(String::new, |date| {
        let (day, time) = (date.date(), date.time());
        format!(
            "{:04}-{:02}-{:02} {:02}:{:02} UTC, ",
            day.year(),
            u8::from(day.month()),
            day.day(),
            time.hour(),
            time.minute()
        )
    });
    let (plan, drone, version) = (escaped(&title(log)), escaped(&log.drone), escaped(&log.version));
    _ = write!(
        page,
        "<h1>{plan}</h1>\n<p class=\"faint\">{date}{}, {drone}, ardrone-pilot {version}</p>\n",
        log.vehicle
    );
    let warning = flight.events.iter().find(|(_, warns, _)| *warns);
    let warning = warning.map(|(at_s, _, text)| format!("; first warning at {at_s:.1} s: {text}"));
    let (ill, ended) = match log.outcome() {
        Some((warns, text)) => (warns, text),
        None => (true, "the log was cut off: what is here is what was written before"),
    };
    let class = if ill || warning.is_some() { "outcome warn" } else { "outcome" };
    let summary = format!("{ended}{}", warning.unwrap_or_default());
    _ = writeln!(page, "<p class=\"{class}\">{}</p>\n<div class=\"facts\">", escaped(&summary));
    let mut fact = |name: &str, value: String| {
        _ = writeln!(page, "<div><b>{value}</b>{name}</div>");
    };
    let done = flight
        .events
        .iter()
        .filter(|(_, _, text)| text.starts_with("step ") && text.ends_with(" done"));
    fact("steps done", done.count().to_string());
    fact("in the air", format!("{:.1} s", flight.flown_s()));
    if let Some((begin, end)) = flight.battery_percent() {
        fact("battery", format!("{begin} to {end} %"));
    }
    let away =
        flight.ticks.iter().filter_map(|(_, tick)| tick.estimate).map(|at| at.x_m.hypot(at.y_m));
    fact("furthest from the start", format!("{:.2} m", away.fold(0.0, f64::max)));
    if let Some(last) = flight.ticks.iter().rev().find_map(|(_, tick)| tick.estimate) {
        let known = format!("place known to at the end, {}", last.rests_on());
        fact(&escaped(&known), format!("{:.2} m", last.horizontal_deviation_m));
    }
    let height = flight.ticks.iter().filter_map(|(_, tick)| tick.estimate).map(|at| at.z_m);
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
            "<tr data-index=\"{index}\"><td class=\"time\">{:.2} s</td><td class=\"time\">{:.2} s</td><td>{}</td>\
             <td>{}</td><td>{}</td><td>{} <span class=\"warn\">{}</span></td></tr>",
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

/// Messages shown to the operator during the flight.
fn events(page: &mut String, flight: &Flight<'_>) {
    *page += "<h2>Messages</h2>\n<table>\n<tbody>\n";
    for (at_s, warns, text) in &flight.events {
        let class = if *warns { " class=\"warn\"" } else { "" };
        _ = writeln!(
            page,
            "<tr><td class=\"time\">{at_s:.2} s</td><td{class}>{}</td></tr>",
            escaped(text)
        );
    }
    *page += "</tbody>\n</table>\n";
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
