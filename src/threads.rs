//! Work with a number of threads.

/// Does work whose parallel iterators use so many threads, 0 being one a core.
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = (threads != 0).then(|| rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok());
    match pool.flatten() {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// How many threads [`on_threads`] works with.
pub fn count(threads: usize) -> usize {
    on_threads(threads, rayon::current_num_threads)
}

#[cfg(test)]
mod tests {
    #[test]
    fn none_is_one_a_core() {
        assert!(super::count(0) > 0);
        assert_eq!(super::count(3), 3);
    }
}
