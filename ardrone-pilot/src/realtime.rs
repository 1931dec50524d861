//! What the system gives the flight's thread so that its ticks come in time.
//!
//! All of it is asked for and none of it is needed: on an idle machine a tick is late by a tenth of a
//! millisecond without it. On a busy one only a real-time priority keeps it so.

use std::fmt;
use std::num::NonZeroU64;

use rustix::mm::{MlockAllFlags, mlockall};
use rustix::process::{Resource, getrlimit};
use rustix::thread::{CapabilitySet, capabilities, set_current_timer_slack};
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// Above everything ordinary, below the kernel's own interrupt threads (50).
const PRIORITY: u8 = 40;

/// What the flight's thread was given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Realtime {
    /// It comes before all ordinary threads (`SCHED_FIFO`).
    pub priority: bool,
    /// Its memory is never paged out.
    pub memory: bool,
    /// The system does not put its timers together with others.
    pub timers: bool,
}

impl Realtime {
    /// Asks for everything, for the thread that calls.
    pub fn acquire() -> Self {
        let priority = acquire_priority();
        Self {
            priority,
            // Where locked memory is limited, a process may fail to get any more: not worth it.
            memory: priority
                && may_lock_all()
                && mlockall(MlockAllFlags::CURRENT | MlockAllFlags::FUTURE).is_ok(),
            timers: set_current_timer_slack(NonZeroU64::new(1)).is_ok(),
        }
    }
}

fn may_lock_all() -> bool {
    getrlimit(Resource::Memlock).current.is_none()
        || capabilities(None).is_ok_and(|sets| sets.effective.contains(CapabilitySet::IPC_LOCK))
}

fn acquire_priority() -> bool {
    let Ok(priority) = ThreadPriorityValue::try_from(PRIORITY) else { return false };
    set_thread_priority_and_policy(
        thread_native_id(),
        ThreadPriority::Crossplatform(priority),
        ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo),
    )
    .is_ok()
}

impl fmt::Display for Realtime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let said = |has: bool, yes: &'static str, no: &'static str| if has { yes } else { no };
        f.write_str(said(self.priority, "real-time priority", "no real-time priority"))?;
        f.write_str(said(self.memory, ", memory locked", ", memory not locked"))?;
        f.write_str(said(self.timers, ", exact timers", ", coarse timers"))?;
        if !self.priority {
            f.write_str(
                ": on a busy machine ticks will be late (allow it with \
                 `setcap cap_sys_nice=ep ardrone-pilot` or `ulimit -r 40`)",
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_said_with_its_remedy() {
        let all = Realtime { priority: true, memory: true, timers: true };
        assert_eq!(all.to_string(), "real-time priority, memory locked, exact timers");
        let none = Realtime::default().to_string();
        assert!(none.starts_with("no real-time priority, memory not locked, coarse timers: "));
        assert!(none.contains("setcap"), "{none}");
    }
}
