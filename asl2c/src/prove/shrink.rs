//! Minimizes counterexamples and simplifies their values; the reference interpreter checks what still fails.

use translator::interpreter::Value;

use super::trace::{Kind, Way};
use crate::run::{Runs as _, Session};

/// Maximum number of attempts, whatever the length.
const MOST: u32 = 4000;

/// The counterexample up to the violation, without unnecessary lines; `None` if it violates nothing.
pub(super) fn shortest(way: &Way, property: &str, session: &Session) -> Option<Way> {
    let mut way = Way { acts: way.acts[..=breaks(way, property, session)?].to_vec() };
    let mut left = MOST;
    // A removal may make further lines unnecessary.
    loop {
        let before = way.acts.len();
        for index in (0..before).rev() {
            attempt(&mut way, property, session, &mut left, |acts| {
                if index < acts.len() {
                    acts.remove(index);
                }
            });
        }
        if way.acts.len() == before || left == 0 {
            break;
        }
    }
    for index in 0..way.acts.len() {
        for value in (0..way.acts.get(index).map_or(0, |act| act.values.len())).rev() {
            if way.acts.get(index).is_some_and(|act| act.kind == Kind::Answers && value > 0) {
                attempt(&mut way, property, session, &mut left, |acts| {
                    acts[index].values.remove(value);
                });
            }
            plainer(&mut way, (index, value), property, session, &mut left);
        }
    }
    Some(way)
}

/// Tries to replace a value by a simpler one.
fn plainer(
    way: &mut Way,
    (index, place): (usize, usize),
    property: &str,
    session: &Session,
    left: &mut u32,
) {
    let Some(value) = way.acts.get(index).and_then(|act| act.values.get(place)).cloned() else {
        return;
    };
    let plain: Vec<Value> = match &value {
        Value::Bool(_) => vec![Value::Bool(false)],
        Value::Integer(_) => [0, 1, 10, 100, 1000, 100_000, -1].map(Value::Integer).to_vec(),
        Value::Float(_) => [0.0, 1.0, 10.0, 100.0, 1000.0, -1.0].map(Value::Float).to_vec(),
        Value::Text(_) | Value::Struct(_) => Vec::new(),
    };
    // Ordered by simplicity.
    for plain in plain.into_iter().take_while(|plain| *plain != value) {
        if attempt(way, property, session, left, |acts| acts[index].values[place] = plain) {
            return;
        }
    }
}

/// Applies a change if the property is still violated.
fn attempt(
    way: &mut Way,
    property: &str,
    session: &Session,
    left: &mut u32,
    change: impl FnOnce(&mut Vec<super::trace::Act>),
) -> bool {
    if *left == 0 {
        return false;
    }
    *left -= 1;
    let mut changed = way.clone();
    change(&mut changed.acts);
    let Some(end) = breaks(&changed, property, session) else { return false };
    changed.acts.truncate(end + 1);
    *way = changed;
    true
}

/// The first line at which the property is violated.
fn breaks(way: &Way, property: &str, session: &Session) -> Option<usize> {
    let mut session = session.clone();
    way.lines().position(|line| {
        session.execute(&line).is_ok() && session.broken().iter().any(|name| name == property)
    })
}
