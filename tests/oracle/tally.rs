//! What has occurred while scenes were rendered, so that a test can say that everything did.

use ninebit::state::Named;
use std::cell::RefCell;
use std::collections::BTreeMap;

thread_local! {
    static TALLY: RefCell<BTreeMap<(&'static str, &'static str), u64>> = const { RefCell::new(BTreeMap::new()) };
}

/// Counts one occurrence.
pub fn count(group: &'static str, what: &'static str) {
    TALLY.with_borrow_mut(|tally| *tally.entry((group, what)).or_default() += 1);
}

/// Counts one occurrence of a variant.
pub fn count_named<T: Named>(variant: T) {
    count(T::TYPE, variant.name());
}

/// Everything counted on this thread since the last call.
pub fn take() -> BTreeMap<(&'static str, &'static str), u64> {
    TALLY.take()
}
