//! How missions travel: one upload at a time, and downloads.
//!
//! An upload replaces the stored mission as a whole or not at all. Whoever began it is the only one who can go on
//! with it or give it up; the vehicle gives it up when it has asked for an item six times in vain, and refuses it at the first
//! item that cannot be flown: QGroundControl blames the one that was asked for last. Networks lose, double and reorder: what
//! comes twice, late or too early is no error, and the item that is missing is asked for again. Each message is answered with
//! at most one.

use std::time::Duration;

use super::fence::{self, FENCE};
use super::{Item, MAX_ITEMS, Problem, Rules, Translated, result, translate};
use crate::dialect::MavMissionResult;

/// Silence after which an item is asked for again.
const REPEAT_AFTER: Duration = Duration::from_millis(250);
/// An item is asked for so many times again.
const REPEATS: u8 = 5;
/// A repeated last item is acknowledged again for this long.
const REMEMBERED_FOR: Duration = Duration::from_secs(2);
/// Downloads that are protected from a change of the mission.
const DOWNLOADS: usize = 4;
/// `MAV_MISSION_TYPE`.
const MISSION: u8 = 0;
const RALLY: u8 = 2;
const ALL: u8 = 255;

/// Another participant of the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Partner {
    pub(crate) system: u8,
    pub(crate) component: u8,
}

/// A message to the vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Received {
    /// `MISSION_COUNT`: an upload begins.
    Count { count: u16, mission_type: u8 },
    /// `MISSION_ITEM_INT`, or `MISSION_ITEM`.
    Item(Item),
    /// `MISSION_REQUEST_LIST`: a download begins.
    RequestList { mission_type: u8 },
    /// `MISSION_REQUEST_INT` or `MISSION_REQUEST`.
    Request { seq: u16, mission_type: u8 },
    /// `MISSION_ACK`: the end of a download, or of an upload that is given up.
    Ack { result: u8, mission_type: u8 },
    /// `MISSION_CLEAR_ALL`.
    ClearAll { mission_type: u8 },
    /// `MISSION_REQUEST_PARTIAL_LIST` or `MISSION_WRITE_PARTIAL_LIST`.
    PartialList { mission_type: u8 },
}

impl Received {
    /// `MAV_MISSION_TYPE`.
    pub(crate) fn mission_type(&self) -> u8 {
        match *self {
            Self::Count { mission_type, .. }
            | Self::Item(Item { mission_type, .. })
            | Self::RequestList { mission_type }
            | Self::Request { mission_type, .. }
            | Self::Ack { mission_type, .. }
            | Self::ClearAll { mission_type }
            | Self::PartialList { mission_type } => mission_type,
        }
    }
}

/// A message of the vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Message {
    /// `MISSION_COUNT`
    Count { count: u16, mission_type: u8 },
    /// `MISSION_REQUEST_INT`
    Request { seq: u16, mission_type: u8 },
    /// `MISSION_ITEM_INT`
    Item(Item),
    /// `MISSION_ACK`
    Ack { result: MavMissionResult, mission_type: u8 },
}

/// What happened to the stored mission.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Event {
    /// A new mission is stored.
    Accepted,
    /// The mission was removed.
    Cleared,
    /// A new one was refused; the stored one is unchanged.
    Refused(Problem),
    /// Another fence was sent, or its removal asked for: it stays as it was set.
    FenceStays,
    /// The vehicle's own fence was sent.
    FenceSame,
    /// An upload was given up; the stored mission is unchanged.
    Cancelled,
}

/// What is to be done after a message or some time.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Handled {
    /// The message to send to the partner, if there is one.
    pub(crate) message: Option<Message>,
    /// What happened, if it did.
    pub(crate) event: Option<Event>,
}

impl Handled {
    fn send(message: Message) -> Self {
        Self { message: Some(message), event: None }
    }

    fn ack(result: MavMissionResult, mission_type: u8) -> Self {
        Self::send(Message::Ack { result, mission_type })
    }

    fn with(self, event: Event) -> Self {
        Self { event: Some(event), ..self }
    }
}

/// The stored mission, and how it comes and goes. At first there is none.
#[derive(Debug, Default)]
pub(crate) struct Transfer {
    items: Vec<Item>,
    /// Component that sent them.
    sender_component: u8,
    translated: Translated,
    /// Changes with each mission.
    id: u32,
    /// Of the upload that goes on; kept for the next one.
    incoming: Vec<Item>,
    upload: Option<Upload>,
    finished: Option<Finished>,
    fence_upload: Option<FenceUpload>,
    downloads: [Option<Download>; DOWNLOADS],
}

/// An upload that goes on.
#[derive(Debug, Clone, Copy)]
struct Upload {
    from: Partner,
    count: u16,
    asked_at: Duration,
    repeats: u8,
    /// It began like the one that has just ended: perhaps its beginning was doubled on its way.
    again: bool,
}

/// A fence that is being sent.
#[derive(Debug, Clone, Copy)]
struct FenceUpload {
    from: Partner,
    /// The item that it needs next.
    wanted: u16,
    asked_at: Duration,
    repeats: u8,
}

/// An upload that has ended, whose acknowledgement may have been lost.
#[derive(Debug, Clone, Copy)]
struct Finished {
    from: Partner,
    at: Duration,
    /// The item at which it ended; `None` once the mission was removed.
    last: Option<u16>,
    result: MavMissionResult,
}

/// Someone reads this mission.
#[derive(Debug, Clone, Copy)]
struct Download {
    by: Partner,
    id: u32,
}

impl Transfer {
    /// The stored items, as they were sent.
    pub(crate) fn items(&self) -> &[Item] {
        &self.items
    }

    /// What the stored items mean.
    pub(crate) fn translated(&self) -> &Translated {
        &self.translated
    }

    /// A number that changes with each stored mission; 0 before the first.
    pub(crate) fn id(&self) -> u32 {
        self.id
    }

    /// Who uploads a mission now.
    pub(crate) fn uploading(&self) -> Option<Partner> {
        self.upload.map(|upload| upload.from)
    }

    /// Who sends a fence now.
    pub(crate) fn sending_fence(&self) -> Option<Partner> {
        self.fence_upload.map(|upload| upload.from)
    }

    /// Translates the stored items by other rules, as after a change of the origin.
    ///
    /// # Errors
    /// [`Problem`] if an item cannot be flown by them; nothing has changed then.
    pub(crate) fn translate_again(&mut self, rules: &Rules) -> Result<(), Problem> {
        self.translated = translate(&self.items, self.sender_component, rules)?;
        Ok(())
    }

    /// Handles a message. `now` never goes back.
    pub(crate) fn handle(
        &mut self,
        now: Duration,
        from: Partner,
        received: &Received,
        rules: &Rules,
    ) -> Handled {
        let is_partner = self.upload.is_none_or(|upload| upload.from == from);
        let mission_type = received.mission_type();
        match *received {
            Received::Count { .. }
            | Received::ClearAll { .. }
            | Received::PartialList { .. }
            | Received::Item(_)
                if !is_partner =>
            {
                Handled::ack(result::DENIED, mission_type)
            }
            Received::ClearAll { mission_type: MISSION | ALL } => {
                self.clear();
                Handled::ack(result::ACCEPTED, mission_type).with(Event::Cleared)
            }
            Received::RequestList { mission_type: FENCE } => {
                Handled::send(Message::Count { count: fence::count(rules), mission_type })
            }
            Received::RequestList { mission_type: RALLY } => {
                Handled::send(Message::Count { count: 0, mission_type })
            }
            Received::Request { seq, mission_type: FENCE } => match fence::item(seq, rules) {
                Some(item) => Handled::send(Message::Item(item)),
                None => Handled::ack(result::INVALID_SEQUENCE, FENCE),
            },
            Received::Count { count, mission_type: FENCE } => {
                self.fence_count(now, from, count, rules)
            }
            Received::Item(item) if mission_type == FENCE => {
                self.fence_item(now, from, &item, rules)
            }
            Received::ClearAll { mission_type: FENCE } => {
                Handled::ack(result::DENIED, FENCE).with(Event::FenceStays)
            }
            Received::Ack { mission_type: FENCE, .. } => {
                self.fence_upload = self.fence_upload.filter(|upload| upload.from != from);
                Handled::default()
            }
            Received::Ack { result, mission_type: MISSION | ALL } => {
                self.acknowledged(from, result)
            }
            Received::Ack { .. } => Handled::default(),
            _ if mission_type != MISSION => Handled::ack(result::UNSUPPORTED, mission_type),
            Received::Count { count, .. } => self.count(now, from, count),
            Received::Item(item) => self.item(now, from, &item, rules),
            Received::RequestList { .. } => self.list(from),
            Received::Request { seq, .. } => self.request(from, seq),
            Received::ClearAll { .. } | Received::PartialList { .. } => {
                Handled::ack(result::UNSUPPORTED, mission_type)
            }
        }
    }

    /// Asks again for an item that did not come, or gives up. To be called at least every 100 ms.
    pub(crate) fn tick(&mut self, now: Duration) -> Handled {
        let seq = self.wanted();
        let Some(upload) = &mut self.upload else { return Handled::default() };
        if now.saturating_sub(upload.asked_at) < REPEAT_AFTER {
            return Handled::default();
        }
        if upload.repeats >= REPEATS {
            let (from, again) = (upload.from, upload.again);
            if again && seq == 0 {
                // Nobody meant it.
                self.upload = None;
                return Handled::default();
            }
            self.end_upload(now, from, seq, result::OPERATION_CANCELLED);
            return Handled::ack(result::OPERATION_CANCELLED, MISSION).with(Event::Cancelled);
        }
        upload.repeats += 1;
        upload.asked_at = now;
        Handled::send(Message::Request { seq, mission_type: MISSION })
    }

    /// As [`Self::tick`], for a fence that is being sent.
    pub(crate) fn tick_fence(&mut self, now: Duration) -> Handled {
        let Some(upload) = &mut self.fence_upload else { return Handled::default() };
        if now.saturating_sub(upload.asked_at) < REPEAT_AFTER {
            return Handled::default();
        }
        if upload.repeats >= REPEATS {
            self.fence_upload = None;
            return Handled::ack(result::OPERATION_CANCELLED, FENCE);
        }
        upload.repeats += 1;
        upload.asked_at = now;
        Handled::send(Message::Request { seq: upload.wanted, mission_type: FENCE })
    }

    /// A fence is sent. It is taken if it is the vehicle's own, which a plan has that was read here; one without any items is
    /// that of a plan without a fence, which `QGroundControl` sends with every plan, and changes nothing either.
    fn fence_count(&mut self, now: Duration, from: Partner, count: u16, rules: &Rules) -> Handled {
        self.fence_upload = None;
        if count == 0 {
            return Handled::ack(result::ACCEPTED, FENCE);
        }
        if count != fence::count(rules) {
            return Handled::ack(result::DENIED, FENCE).with(Event::FenceStays);
        }
        self.fence_upload = Some(FenceUpload { from, wanted: 0, asked_at: now, repeats: 0 });
        Handled::send(Message::Request { seq: 0, mission_type: FENCE })
    }

    fn fence_item(&mut self, now: Duration, from: Partner, item: &Item, rules: &Rules) -> Handled {
        let is_same = fence::is_same(item, rules);
        let is_last = item.seq.saturating_add(1) >= fence::count(rules);
        let Some(upload) = self.fence_upload.as_mut().filter(|upload| upload.from == from) else {
            // The last one again, because the acknowledgement was lost; or one that was doubled or delayed.
            let again = is_last && is_same;
            return if again { Handled::ack(result::ACCEPTED, FENCE) } else { Handled::default() };
        };
        if item.seq != upload.wanted {
            return Handled::default();
        }
        if !is_same {
            self.fence_upload = None;
            return Handled::ack(result::DENIED, FENCE).with(Event::FenceStays);
        }
        if is_last {
            self.fence_upload = None;
            return Handled::ack(result::ACCEPTED, FENCE).with(Event::FenceSame);
        }
        *upload = FenceUpload { wanted: item.seq + 1, asked_at: now, repeats: 0, ..*upload };
        Handled::send(Message::Request { seq: item.seq + 1, mission_type: FENCE })
    }

    /// Removes the mission, and gives up an upload.
    pub(crate) fn clear(&mut self) {
        self.upload = None;
        if let Some(finished) = &mut self.finished {
            finished.last = None;
        }
        self.store(Vec::new(), 0, Translated::default());
    }

    fn store(&mut self, items: Vec<Item>, sender_component: u8, translated: Translated) {
        self.items = items;
        self.sender_component = sender_component;
        self.translated = translated;
        self.id = self.id.wrapping_add(1).max(1);
    }

    /// The item that an upload needs next.
    fn wanted(&self) -> u16 {
        // At most `MAX_ITEMS`.
        u16::try_from(self.incoming.len()).unwrap_or(u16::MAX)
    }

    fn count(&mut self, now: Duration, from: Partner, count: u16) -> Handled {
        let again = self.finished.is_some_and(|finished| {
            finished.from == from
                && finished.last.is_some_and(|last| last.checked_add(1) == Some(count))
                && now.saturating_sub(finished.at) <= REMEMBERED_FOR
        });
        self.upload = None;
        self.finished = None;
        if count == 0 {
            self.clear();
            return Handled::ack(result::ACCEPTED, MISSION).with(Event::Cleared);
        }
        if usize::from(count) > MAX_ITEMS {
            let reason = format!("{count} items: at most {MAX_ITEMS} are taken");
            // The first that is too much.
            let item = u16::try_from(MAX_ITEMS).unwrap_or(u16::MAX);
            let problem = Problem { item, result: result::NO_SPACE, reason };
            return Handled::ack(result::NO_SPACE, MISSION).with(Event::Refused(problem));
        }
        self.incoming.clear();
        self.incoming.reserve_exact(usize::from(count));
        self.upload = Some(Upload { from, count, asked_at: now, repeats: 0, again });
        Handled::send(Message::Request { seq: 0, mission_type: MISSION })
    }

    fn item(&mut self, now: Duration, from: Partner, item: &Item, rules: &Rules) -> Handled {
        let wanted = self.wanted();
        let Some(upload) = &mut self.upload else { return self.late_item(now, from, item) };
        let known = self.incoming.get(usize::from(item.seq));
        if known == Some(item) {
            return Handled::default();
        }
        if known.is_some() {
            // One of the two is from before the partner began anew.
            upload.asked_at = now;
            self.incoming.clear();
            return Handled::send(Message::Request { seq: 0, mission_type: MISSION });
        }
        if item.seq != wanted {
            // The one that is missing is asked for again in time. At once would never end with a partner that counts otherwise.
            return Handled::default();
        }
        upload.asked_at = now;
        upload.repeats = 0;
        self.incoming.push(*item);
        let next = wanted + 1;
        let is_last = next >= upload.count;
        let (result, event) = match translate(&self.incoming, from.component, rules) {
            Ok(_) if !is_last => {
                return Handled::send(Message::Request { seq: next, mission_type: MISSION });
            }
            Ok(translated) => {
                let items = std::mem::take(&mut self.incoming);
                self.store(items, from.component, translated);
                (result::ACCEPTED, Event::Accepted)
            }
            Err(problem) => (problem.result, Event::Refused(problem)),
        };
        self.end_upload(now, from, item.seq, result);
        Handled::ack(result, MISSION).with(event)
    }

    /// The upload has ended with the item `last`, or with waiting for it.
    fn end_upload(&mut self, now: Duration, from: Partner, last: u16, result: MavMissionResult) {
        self.upload = None;
        self.finished = Some(Finished { from, at: now, last: Some(last), result });
    }

    /// An item while no upload goes on: the last one again, because the acknowledgement was lost, or one that was doubled or
    /// delayed on its way, or one that nobody has asked for.
    fn late_item(&self, now: Duration, from: Partner, item: &Item) -> Handled {
        if let Some(finished) = self.finished.filter(|finished| finished.from == from) {
            let recent = now.saturating_sub(finished.at) <= REMEMBERED_FOR;
            if finished.last == Some(item.seq) && recent {
                return Handled::ack(finished.result, MISSION);
            }
            let stored = self.items.get(usize::from(item.seq)) == Some(item);
            if recent || stored {
                return Handled::default();
            }
        }
        Handled::ack(result::INVALID_SEQUENCE, MISSION)
    }

    fn list(&mut self, by: Partner) -> Handled {
        self.end_download(by);
        // The oldest makes room.
        self.downloads.rotate_right(1);
        let [newest, ..] = &mut self.downloads;
        *newest = Some(Download { by, id: self.id });
        // At most `MAX_ITEMS`.
        let count = u16::try_from(self.items.len()).unwrap_or(u16::MAX);
        Handled::send(Message::Count { count, mission_type: MISSION })
    }

    fn request(&self, by: Partner, seq: u16) -> Handled {
        let mut downloads = self.downloads.iter().flatten();
        if downloads.any(|download| download.by == by && download.id != self.id) {
            // The rest of another mission would make a mixture.
            return Handled::ack(result::OPERATION_CANCELLED, MISSION);
        }
        match self.items.get(usize::from(seq)) {
            Some(item) => Handled::send(Message::Item(*item)),
            None => Handled::ack(result::INVALID_SEQUENCE, MISSION),
        }
    }

    fn end_download(&mut self, by: Partner) {
        for slot in &mut self.downloads {
            *slot = slot.filter(|download| download.by != by);
        }
    }

    fn acknowledged(&mut self, from: Partner, result: u8) -> Handled {
        self.end_download(from);
        // The acknowledgement of a download that was doubled on its way gives nothing up.
        if result == result::ACCEPTED as u8 || self.uploading() != Some(from) {
            return Handled::default();
        }
        self.upload = None;
        Handled::default().with(Event::Cancelled)
    }
}

#[cfg(test)]
mod tests;
