//! The channels between the agents of a system: messages that are under way.

use std::collections::BTreeMap;

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use translator::interpreter::Value;
use translator::syntax::ast::Performative;
use translator::system::Channels;

/// What the channels of a run do. The system's bounds of losses and of capacity hold besides, that of the delay does not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NetworkConditions {
    /// How many messages of a hundred are lost, 0 to 100; fewer where the system's bound lets them arrive.
    pub loss_percent: u32,
    /// How many rounds a message is late at most, each number with the same probability.
    pub delay_rounds: u32,
    /// Start of the random numbers: the same seed and script give the same run.
    pub seed: u64,
}

impl NetworkConditions {
    /// Nothing is lost or late.
    pub const PERFECT: Self = Self { loss_percent: 0, delay_rounds: 0, seed: 1 };
}

/// A message. Agents are indices into the system's members.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Message {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) performative: Performative,
    pub(super) about: String,
    pub(super) values: Vec<Value>,
    /// The round in which it was sent.
    sent: u64,
    /// The round at whose end it arrives or is lost.
    due: u64,
    will_be_lost: bool,
}

/// A sent message that is lost at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ChannelFull;

/// A message that cannot be lost, because too many before it were.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct MustArrive;

#[derive(Debug, Clone)]
pub(super) struct Network {
    channels: Channels,
    conditions: NetworkConditions,
    random: ChaCha8Rng,
    /// In the order in which they were sent.
    under_way: Vec<Message>,
    /// How many messages of one agent to another were lost one after the other.
    lost: BTreeMap<(usize, usize), u32>,
}

impl Network {
    pub(super) fn new(channels: Channels, conditions: NetworkConditions) -> Self {
        let random = ChaCha8Rng::seed_from_u64(conditions.seed);
        Self { channels, conditions, random, under_way: Vec::new(), lost: BTreeMap::new() }
    }

    /// A message is sent.
    pub(super) fn put(
        &mut self,
        (from, to): (usize, usize),
        (performative, about): (Performative, &str),
        values: Vec<Value>,
        round: u64,
    ) -> Result<(), ChannelFull> {
        let NetworkConditions { loss_percent, delay_rounds, .. } = self.conditions;
        let due = round + u64::from(self.random.random_range(0..=delay_rounds));
        let will_be_lost = self.random.random_range(0..100) < loss_percent;
        let load = self.between(from, to).count();
        if load >= self.channels.capacity as usize {
            return Err(ChannelFull);
        }
        let about = about.to_owned();
        self.under_way.push(Message {
            from,
            to,
            performative,
            about,
            values,
            sent: round,
            due,
            will_be_lost,
        });
        Ok(())
    }

    /// The messages that are under way, in the order in which they were sent.
    pub(super) fn under_way(&self) -> impl Iterator<Item = &Message> {
        self.under_way.iter()
    }

    /// Those of one agent to another, with their places among all.
    pub(super) fn between(
        &self,
        from: usize,
        to: usize,
    ) -> impl Iterator<Item = (usize, &Message)> {
        let all = self.under_way.iter().enumerate();
        all.filter(move |(_, message)| (message.from, message.to) == (from, to))
    }

    /// Takes a message that arrives.
    pub(super) fn take(&mut self, place: usize) -> Message {
        let message = self.under_way.remove(place);
        self.lost.insert((message.from, message.to), 0);
        message
    }

    /// Loses a message.
    pub(super) fn lose(&mut self, place: usize) -> Result<Message, MustArrive> {
        let message = &self.under_way[place];
        let lost = self.lost.entry((message.from, message.to)).or_default();
        if self.channels.losses.is_some_and(|most| *lost >= most) {
            return Err(MustArrive);
        }
        *lost += 1;
        Ok(self.under_way.remove(place))
    }

    /// The place of a message that arrives or is lost at the end of a round, and whether it is lost.
    pub(super) fn due(&self, round: u64) -> Option<(usize, bool)> {
        let place = self.under_way.iter().position(|message| message.due <= round)?;
        Some((place, self.under_way[place].will_be_lost))
    }

    /// Whether a message cannot be under way any longer.
    pub(super) fn is_overdue(&self, round: u64) -> bool {
        let Some(most) = self.channels.delay else { return false };
        self.under_way.iter().any(|message| message.sent + u64::from(most) <= round)
    }
}
