//! The table of known tags, and their marks on the map.

use std::cmp::Reverse;

use autopilot::vehicle::{KnownTag, Status};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::text::Span;
use ratatui::widgets::canvas::{Circle, Context};
use ratatui::widgets::{Block, Paragraph};

const TAG: Color = Color::Green;
/// Lines of the border.
const BORDER: usize = 2;

/// Lines of the table if there are `most` lines; zero without tags, or without room for one of them.
pub(super) fn lines(status: Option<&Status>, most: usize) -> usize {
    let known = known(status).count();
    if known == 0 || most <= BORDER { 0 } else { most.min(known + BORDER) }
}

/// Draws the table. If there is no room for all, it has those that were seen last.
pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, status: Option<&Status>) {
    let mut shown: Vec<&KnownTag> = known(status).collect();
    if shown.is_empty() {
        return;
    }
    let room = usize::from(area.height).saturating_sub(BORDER);
    if shown.len() > room {
        shown.sort_by_key(|tag| Reverse(tag.seen_ago.map(Reverse)));
    }
    let more = shown.len().saturating_sub(room);
    let title = match more {
        0 => "tags, * surveyed".to_owned(),
        more => format!("tags, * surveyed; {more} more"),
    };
    let rows: Vec<String> = shown.into_iter().take(room).map(row).collect();
    frame
        .render_widget(Paragraph::new(rows.join("\n")).block(Block::bordered().title(title)), area);
}

/// Number, position, standard deviation, heading, and time since the last sighting: 34 columns.
fn row(tag: &KnownTag) -> String {
    let KnownTag { id, place_m, heading_deg, uncertainty_m, surveyed, seen_ago } = tag;
    let mark = if *surveyed { '*' } else { ' ' };
    let heading =
        heading_deg.map_or("-".to_owned(), |heading_deg| format!("{:+.0}°", heading_deg + 0.0));
    let seen = match seen_ago.map(|ago| ago.as_secs()) {
        None => "never".to_owned(),
        Some(0) => "now".to_owned(),
        Some(ago_s @ 1..1000) => format!("{ago_s} s"),
        Some(ago_s) => format!("{}min", ago_s / 60),
    };
    format!(
        "{id:<2}{mark}{:+6.2} {:+6.2} ±{uncertainty_m:.2} {heading:>5} {seen:>5}",
        place_m.x, place_m.y
    )
}

/// Positions of the known tags: right and forward.
pub(super) fn places_m(status: Option<&Status>) -> impl Iterator<Item = (f64, f64)> + '_ {
    known(status).map(|tag| (tag.place_m.x, tag.place_m.y))
}

fn known(status: Option<&Status>) -> impl Iterator<Item = &KnownTag> {
    let tags = status.and_then(|status| status.tags.as_ref());
    tags.into_iter().flat_map(|tags| tags.known.iter())
}

/// Draws the tags and their standard deviations on the map.
pub(super) fn mark(context: &mut Context<'_>, status: Option<&Status>) {
    for tag in known(status) {
        let (x, y) = (tag.place_m.x, tag.place_m.y);
        context.draw(&Circle { x, y, radius: tag.uncertainty_m, color: TAG });
        context.print(x, y, Span::styled("@", Style::new().fg(TAG)));
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn tag(id: u32, seen_ago: Option<Duration>) -> KnownTag {
        KnownTag {
            id,
            place_m: [-12.345, 0.5].into(),
            heading_deg: None,
            uncertainty_m: 0.034,
            surveyed: true,
            seen_ago,
        }
    }

    #[test]
    fn a_row_fits_beside_a_map_on_eighty_columns() {
        let seconds = |s| Some(Duration::from_secs(s));
        assert_eq!(row(&tag(1, None)), "1 *-12.35  +0.50 ±0.03     - never");
        let found = KnownTag {
            heading_deg: Some(-119.6),
            surveyed: false,
            ..tag(12, Some(Duration::from_millis(400)))
        };
        assert_eq!(row(&found), "12 -12.35  +0.50 ±0.03 -120°   now");
        for (ago, text) in [(999, "999 s"), (3600, "60min")] {
            let row = row(&KnownTag { heading_deg: Some(180.0), ..tag(3, seconds(ago)) });
            assert!(row.ends_with(text), "{row}");
            assert_eq!(row.chars().count(), 34);
        }
    }
}
