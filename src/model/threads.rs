//! Work on several threads. Without the feature `threads` everything runs on the caller's thread.

#[cfg(feature = "threads")]
use std::sync::atomic::{AtomicUsize, Ordering};

#[cfg(feature = "threads")]
use crate::faults::{self, Operation};

/// The largest number of threads that a caller may ask for.
pub const MAXIMUM: usize = 1024;

/// Runs `work`, whose parallel iterators use `threads` threads, or the caller's alone if the system refuses them. 0 means one for each core.
#[cfg(feature = "threads")]
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let alone = || rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().ok();
    match pool(threads).or_else(alone) {
        Some(pool) => pool.install(work),
        // The caller's thread is one of another pool, which does it.
        None => work(),
    }
}

/// Starts a pool of threads, where 0 means one for each core; `None` if the system refuses one of them.
#[cfg(feature = "threads")]
fn pool(threads: usize) -> Option<rayon::ThreadPool> {
    let start = |thread: rayon::ThreadBuilder| {
        faults::check(Operation::Start)?;
        std::thread::Builder::new().spawn(|| thread.run()).map(drop)
    };
    rayon::ThreadPoolBuilder::new().num_threads(threads).spawn_handler(start).build().ok()
}

/// Runs `work` on the caller's thread.
#[cfg(not(feature = "threads"))]
pub fn on_threads<T: Send>(_: usize, work: impl FnOnce() -> T + Send) -> T {
    work()
}

/// Returns the number of threads that [`on_threads`] uses.
#[cfg(feature = "threads")]
pub fn count(threads: usize) -> usize {
    on_threads(threads, rayon::current_num_threads)
}

/// The caller's thread, and other threads that help it.
#[derive(Debug)]
pub(crate) struct Team {
    #[cfg(feature = "threads")]
    helpers: Option<rayon::ThreadPool>,
}

impl Team {
    /// Creates a team of `threads` threads, where 0 means one for each core. The team is smaller if the threads are not
    /// available.
    #[cfg(feature = "threads")]
    pub(crate) fn new(threads: usize) -> Team {
        let threads = match threads {
            0 => std::thread::available_parallelism().map_or(1, usize::from),
            threads => threads,
        };
        Team { helpers: (threads > 1).then(|| pool(threads - 1)).flatten() }
    }

    /// Creates a team of the caller's thread alone.
    #[cfg(not(feature = "threads"))]
    pub(crate) fn new(_: usize) -> Team {
        Team {}
    }

    /// Returns the number of threads.
    pub(crate) fn count(&self) -> usize {
        #[cfg(feature = "threads")]
        let helpers = self.helpers.as_ref().map_or(0, rayon::ThreadPool::current_num_threads);
        #[cfg(not(feature = "threads"))]
        let helpers = 0;
        1 + helpers
    }

    /// Runs `work` once for every thread, with the number of the thread: 0 is the caller's. A thread that comes early may
    /// run it for another one, too.
    pub(crate) fn run(&self, work: impl Fn(usize) + Sync) {
        #[cfg(feature = "threads")]
        if let Some(pool) = &self.helpers {
            let left = AtomicUsize::new(pool.current_num_threads());
            return pool.in_place_scope(|scope| {
                for _ in 0..pool.current_num_threads() {
                    scope.spawn(|_| {
                        let _ends = Ends(&left);
                        work(1 + rayon::current_thread_index().unwrap_or(0));
                    });
                }
                work(0);
                // Awake, because the scope would sleep until the others have ended, and waking takes as long as a small picture.
                while left.load(Ordering::Relaxed) > 0 {
                    std::thread::yield_now();
                }
            });
        }
        work(0);
    }
}

/// Counts a helper's end, be it a panic.
#[cfg(feature = "threads")]
struct Ends<'a>(&'a AtomicUsize);

#[cfg(feature = "threads")]
impl Drop for Ends<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

#[cfg(all(test, feature = "threads"))]
mod tests {
    use super::*;

    #[test]
    fn none_is_one_a_core() {
        assert!(count(0) > 0);
        assert_eq!(count(3), 3);
    }

    #[test]
    fn every_thread_works_once() {
        let runs = AtomicUsize::new(0);
        let team = Team::new(3);
        team.run(|thread| {
            assert!(thread < 3);
            runs.fetch_add(1, Ordering::Relaxed);
        });
        assert_eq!((team.count(), runs.into_inner()), (3, 3));
    }

    #[test]
    fn a_panic_of_a_helper_ends_the_work() {
        let team = Team::new(2);
        let work = |thread| assert_eq!(thread, 0, "the helper");
        assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| team.run(work))).is_err());
    }
}
