//! Work with a number of threads.

/// Does work whose parallel iterators use so many threads, 0 being one a core.
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = (threads != 0).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok());
    match pool.flatten() {
        Some(pool) => pool.install(work),
        None => work(),
    }
}
