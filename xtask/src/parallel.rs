//! Parallel execution.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Runs all jobs on as many threads as there are cores; results are in the order of the jobs.
///
/// # Errors
/// One of the errors, if there are any.
pub(crate) fn map<J: Copy + Sync, R: Send, E: Send>(
    jobs: &[J],
    work: impl Fn(J) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::with_capacity(jobs.len()));
    let failed = Mutex::new(None);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = jobs.get(index) else { break };
                    match work(*job) {
                        Ok(result) => lock(&done).push((index, result)),
                        Err(error) => *lock(&failed) = Some(error),
                    }
                }
            });
        }
    });
    if let Some(error) = lock(&failed).take() {
        return Err(error);
    }
    let mut done = std::mem::take(&mut *lock(&done));
    done.sort_by_key(|(index, _)| *index);
    Ok(done.into_iter().map(|(_, result)| result).collect())
}

/// Runs two functions in parallel.
///
/// # Errors
/// One of the errors, if there are any.
pub(crate) fn both<A, B: Send, E: Send>(
    one: impl FnOnce() -> Result<A, E>,
    other: impl FnOnce() -> Result<B, E> + Send,
) -> Result<(A, B), E> {
    std::thread::scope(|scope| {
        let other = scope.spawn(other);
        let one = one();
        let other = other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        Ok((one?, other?))
    })
}

/// Ignores poisoning: values are pushed whole, so the data are consistent after a panic.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
