//! Real-time scheduling for the tick's thread.
//!
//! None of it is required: on an idle machine ticks are late by a tenth of a millisecond without it. On a
//! busy machine only a real-time priority keeps them that punctual.

use std::fmt;
use std::num::NonZeroU64;

use rustix::mm::{MlockAllFlags, mlockall};
use rustix::process::{Resource, getrlimit};
use rustix::thread::{CapabilitySet, capabilities, set_current_timer_slack};
use thread_priority::{
    RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
    set_thread_priority_and_policy, thread_native_id,
};

/// Above all ordinary threads, below the kernel's interrupt threads (50).
const PRIORITY: u8 = 40;

/// Scheduling properties granted to the tick's thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Realtime {
    /// Real-time priority (`SCHED_FIFO`) over all ordinary threads.
    pub priority: bool,
    /// The process's memory is locked: never paged out.
    pub memory: bool,
    /// Timer slack is off: the system does not delay timers to batch them.
    pub timers: bool,
}

impl Realtime {
    /// Requests all of it for the calling thread.
    pub fn acquire() -> Self {
        let priority = acquire_priority();
        Self {
            priority,
            // With a limit on locked memory, later allocations could fail; the benefit is not worth that.
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
        let choose = |has: bool, yes: &'static str, no: &'static str| if has { yes } else { no };
        f.write_str(choose(self.priority, "real-time priority", "no real-time priority"))?;
        f.write_str(choose(self.memory, ", memory locked", ", memory not locked"))?;
        f.write_str(choose(self.timers, ", exact timers", ", coarse timers"))?;
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
    fn what_is_missing_is_reported_with_its_remedy() {
        let all = Realtime { priority: true, memory: true, timers: true };
        assert_eq!(all.to_string(), "real-time priority, memory locked, exact timers");
        let none = Realtime::default().to_string();
        assert!(none.starts_with("no real-time priority, memory not locked, coarse timers: "));
        assert!(none.contains("setcap"), "{none}");
    }
}
