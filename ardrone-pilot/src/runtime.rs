//! What runs beside the ticks of all vehicles of a program: one tokio runtime, and one set of signals.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::task::{Context, Poll};
use std::time::Duration;

use autopilot::outcome::Outcome;
use rustix::process::Signal as Os;
use tokio::runtime::Handle;
use tokio::signal::unix::{Signal, SignalKind, signal};
use tokio::sync::oneshot;
use tokio::task::JoinHandle;

/// One that waits for the system must not hold up the signals.
const WORKERS: usize = 2;
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

/// Taken when this is dropped.
#[derive(Debug)]
struct Threads(Option<tokio::runtime::Runtime>);

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
        let signals = {
            let _inside = runtime.enter();
            EndSignals::new()
        };
        drop(runtime.spawn(count_signals(signals, ending.clone(), second)));
        Ok(Self { threads: Arc::new(Threads(Some(runtime))), ending })
    }

    /// For a flight: how often the program was told to end.
    pub(crate) fn ending(&self) -> Ending {
        self.ending.clone()
    }

    /// For what uses sockets before it runs.
    pub(crate) fn handle(&self) -> &Handle {
        self.threads.0.as_ref().expect("it is taken only when they are dropped").handle()
    }

    /// Runs something until its [`Task`] is dropped; it is told so by the receiver.
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
        if let Some(runtime) = self.0.take() {
            // The end does not wait for a simulation or a report.
            runtime.shutdown_background();
        }
    }
}

/// Something that runs until this is dropped, which waits for its end.
#[derive(Debug)]
pub(crate) struct Task<T> {
    name: &'static str,
    runtime: Runtime,
    end: Option<oneshot::Sender<()>>,
    running: Option<JoinHandle<T>>,
}

impl<T> Task<T> {
    /// Ends it; `None` if it has panicked, or was ended before.
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

impl<T> Drop for Task<T> {
    fn drop(&mut self) {
        self.end();
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

/// Never returns.
async fn count_signals(mut signals: EndSignals, ending: Ending, second: SecondSignal) {
    // With SIGXFSZ caught, exceeding the file size limit ends the log, not the process.
    let _too_large = signal(SignalKind::from_raw(Os::XFSZ.as_raw()));
    loop {
        signals.next().await;
        let is_first = ending.0.signals.fetch_add(1, Ordering::Relaxed) == 0;
        let is_over = ending.0.under_way.load(Ordering::Relaxed) == 0;
        if second == SecondSignal::Exits && (!is_first || is_over) {
            drop(tokio::spawn(exit(ending.clone())));
        }
    }
}

/// Exits the process after the flights.
#[expect(clippy::exit, reason = "what is blocked cannot be asked to end")]
async fn exit(ending: Ending) {
    while ending.0.under_way.load(Ordering::Relaxed) > 0 {
        tokio::time::sleep(LOOK).await;
    }
    let outcome = if ending.0.begun.load(Ordering::Relaxed) > 0 {
        tokio::time::sleep(GRACE).await;
        Outcome::LeftLanding
    } else {
        Outcome::Interrupted
    };
    std::process::exit(outcome.exit_status().into());
}

/// All signals that request the exit.
#[derive(Debug)]
struct EndSignals(Vec<Signal>);

impl EndSignals {
    /// Starts listening. Must be called within a tokio runtime.
    fn new() -> Self {
        let ends = [
            SignalKind::interrupt(),
            SignalKind::terminate(),
            SignalKind::hangup(),
            SignalKind::quit(),
            SignalKind::alarm(),
            SignalKind::user_defined1(),
            SignalKind::user_defined2(),
            SignalKind::io(),
        ];
        let others = [Os::VTALARM, Os::PROF, Os::XCPU, Os::SYS];
        let others = others.map(|other| SignalKind::from_raw(other.as_raw()));
        let ends = [&ends[..], &others[..]].concat();
        let signals: Vec<Signal> = ends.iter().filter_map(|kind| signal(*kind).ok()).collect();
        if signals.len() < ends.len() {
            tracing::warn!("not all signals can be caught: Ctrl-C may not land the drone");
        }
        Self(signals)
    }

    /// Waits for the next one.
    async fn next(&mut self) {
        std::future::poll_fn(|context| self.poll(context)).await;
    }

    /// Polls all of them, so that each wakes the task.
    fn poll(&mut self, context: &mut Context<'_>) -> Poll<()> {
        let mut came = Poll::Pending;
        for signal in &mut self.0 {
            if let Poll::Ready(Some(())) = signal.poll_recv(context) {
                came = Poll::Ready(());
            }
        }
        came
    }
}
