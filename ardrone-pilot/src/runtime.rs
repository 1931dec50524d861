//! What runs beside the ticks of all vehicles of a program: one tokio runtime, and one set of signals.
//!
//! The signals have a thread of their own: whatever clients do to those of the runtime, Ctrl-C lands.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

use autopilot::outcome::Outcome;
use signal_hook::consts::{
    SIGALRM, SIGHUP, SIGINT, SIGIO, SIGPROF, SIGQUIT, SIGSYS, SIGTERM, SIGUSR1, SIGUSR2, SIGVTALRM,
    SIGXCPU, SIGXFSZ,
};
use signal_hook::iterator::{Handle as SignalsHandle, Signals};
use tokio::runtime::Handle;
use tokio::sync::oneshot;
use tokio::task::JoinHandle;

/// Threads of the runtime: one that waits for the system holds up nobody else.
const WORKERS: usize = 2;
/// All signals that request the exit.
const ENDS: [i32; 12] = [
    SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGALRM, SIGUSR1, SIGUSR2, SIGIO, SIGVTALRM, SIGPROF,
    SIGXCPU, SIGSYS,
];
/// Time for pending output after the flights have ended.
const GRACE: Duration = Duration::from_secs(1);
/// Interval at which the end of the flights is checked; each orders its landing first.
const LOOK: Duration = Duration::from_millis(20);

/// What a second signal does, and any after the flights, besides ordering all drones to land.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SecondSignal {
    /// Nothing: the program ends by itself.
    IsPassedOn,
    /// Exits the process once the flights have ended and pending output has had a second. Nobody may be reading a full
    /// pipe, and writing to it would keep the process alive for ever.
    Exits,
}

/// The threads, and the signals. They end with the last clone of this and the last flight.
#[derive(Debug, Clone)]
pub struct Runtime {
    threads: Arc<Threads>,
    ending: Ending,
}

#[derive(Debug)]
struct Threads {
    /// Taken when this is dropped.
    runtime: Option<tokio::runtime::Runtime>,
    signals: SignalsHandle,
}

impl Runtime {
    /// Starts the threads. From now on signals do not end the process: they end the flights.
    ///
    /// # Errors
    /// The system's error if there can be no threads.
    pub fn start(second: SecondSignal) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(WORKERS)
            .thread_name("services")
            .enable_all()
            .build()?;
        let ending = Ending::default();
        let signals = Signals::new([0_i32; 0])?;
        let missed = ENDS.iter().filter(|signal| signals.add_signal(**signal).is_err()).count();
        if missed > 0 {
            tracing::warn!("not all signals can be caught: Ctrl-C may not land the drone");
        }
        // With SIGXFSZ caught, exceeding the file size limit ends the log, not the process. If it cannot be, it ends both.
        _ = signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
        let threads = Threads { runtime: Some(runtime), signals: signals.handle() };
        let counted = ending.clone();
        std::thread::Builder::new()
            .name("signals".to_owned())
            .spawn(move || count(signals, &counted, second))?;
        Ok(Self { threads: Arc::new(threads), ending })
    }

    /// For a flight: how often the program was told to end.
    pub(crate) fn ending(&self) -> Ending {
        self.ending.clone()
    }

    /// For what uses sockets before it runs.
    pub(crate) fn handle(&self) -> &Handle {
        self.threads.runtime.as_ref().expect("it is taken only when they are dropped").handle()
    }

    /// Runs something until what is returned is dropped, which does not wait.
    pub(crate) fn spawn(&self, task: impl Future<Output = ()> + Send + 'static) -> Background {
        Background { running: self.handle().spawn(task), _runtime: self.clone() }
    }

    /// Runs something until its [`Task`] is ended; it is told so by the receiver.
    pub(crate) fn run<F: Future<Output: Send> + Send + 'static>(
        &self,
        name: &'static str,
        task: impl FnOnce(oneshot::Receiver<()>) -> F,
    ) -> Task<F::Output> {
        let (end, ended) = oneshot::channel();
        let running = self.handle().spawn(task(ended));
        Task { name, runtime: self.clone(), end: Some(end), running: Some(running) }
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        self.signals.close();
        if let Some(runtime) = self.runtime.take() {
            // The end does not wait for a simulation or a report.
            runtime.shutdown_background();
        }
    }
}

/// Something that runs until this is dropped. A busy runtime holds up nobody who drops it.
#[derive(Debug)]
pub(crate) struct Background {
    running: JoinHandle<()>,
    _runtime: Runtime,
}

impl Drop for Background {
    fn drop(&mut self) {
        self.running.abort();
    }
}

/// Something that has to do something at its end.
#[derive(Debug)]
pub(crate) struct Task<T> {
    name: &'static str,
    runtime: Runtime,
    end: Option<oneshot::Sender<()>>,
    running: Option<JoinHandle<T>>,
}

impl<T> Task<T> {
    /// Ends it, and waits for its end; `None` if it has panicked, or was ended before.
    pub(crate) fn end(&mut self) -> Option<T> {
        if let Some(end) = self.end.take() {
            // It may have ended by itself.
            _ = end.send(());
        }
        let result = self.runtime.handle().block_on(self.running.take()?);
        if matches!(&result, Err(error) if error.is_panic()) {
            tracing::error!("internal error: {} panicked", self.name);
        }
        result.ok()
    }
}

/// How often the program was told to end, and the flights that have not ended yet. Any thread may read it without waiting.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ending(Arc<Counts>);

#[derive(Debug, Default)]
struct Counts {
    signals: AtomicU32,
    begun: AtomicU32,
    under_way: AtomicU32,
}

impl Ending {
    /// How often.
    pub(crate) fn signals(&self) -> u32 {
        self.0.signals.load(Ordering::Relaxed)
    }

    /// A flight begins: the process is not ended before it.
    pub(crate) fn begin_flight(&self) -> UnderWay {
        self.0.begun.fetch_add(1, Ordering::Relaxed);
        self.0.under_way.fetch_add(1, Ordering::Relaxed);
        UnderWay(self.clone())
    }
}

/// A flight, until this is dropped.
#[derive(Debug)]
pub(crate) struct UnderWay(Ending);

impl UnderWay {
    /// As [`Ending::signals`].
    pub(crate) fn signals(&self) -> u32 {
        self.0.signals()
    }
}

impl Drop for UnderWay {
    fn drop(&mut self) {
        self.0.0.under_way.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Counts the signals until the end of the runtime.
fn count(mut signals: Signals, ending: &Ending, second: SecondSignal) {
    for _ in signals.forever() {
        let is_first = ending.0.signals.fetch_add(1, Ordering::Relaxed) == 0;
        let is_over = ending.0.under_way.load(Ordering::Relaxed) == 0;
        if second == SecondSignal::Exits && (!is_first || is_over) {
            exit(ending);
        }
    }
}

/// Exits the process after the flights.
#[expect(clippy::exit, reason = "what is blocked cannot be asked to end")]
fn exit(ending: &Ending) {
    while ending.0.under_way.load(Ordering::Relaxed) > 0 {
        std::thread::sleep(LOOK);
    }
    let outcome = if ending.0.begun.load(Ordering::Relaxed) > 0 {
        std::thread::sleep(GRACE);
        Outcome::LeftLanding
    } else {
        Outcome::Interrupted
    };
    std::process::exit(outcome.exit_status().into());
}
