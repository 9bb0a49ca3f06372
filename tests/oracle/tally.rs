//! Counts what occurs while scenes are rendered, so that a test can check that everything has occurred.

use ninebit::state::Named;
use std::cell::RefCell;
use std::collections::BTreeMap;

type Tally = BTreeMap<(&'static str, &'static str), u64>;

thread_local! {
    /// The counts, or `None` if nothing is counted, because counting takes longer than rendering.
    static TALLY: RefCell<Option<Tally>> = const { RefCell::new(None) };
}

/// Counts one occurrence.
pub fn count(group: &'static str, what: &'static str) {
    TALLY.with_borrow_mut(|tally| {
        if let Some(tally) = tally {
            *tally.entry((group, what)).or_default() += 1;
        }
    });
}

/// Counts one occurrence of a variant.
pub fn count_named<T: Named>(variant: T) {
    count(T::TYPE, variant.name());
}

/// Runs `work` and counts what occurs on this thread.
pub fn during<T>(work: impl FnOnce() -> T) -> (T, Tally) {
    TALLY.replace(Some(Tally::new()));
    let done = work();
    (done, TALLY.take().unwrap_or_default())
}
