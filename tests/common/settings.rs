//! What the environment asks of the tests; `docs/testing.md` lists the variables.
#![allow(dead_code, unreachable_pub, reason = "each test uses a part")]

use super::repository::at;
use std::path::PathBuf;
use std::str::FromStr;

/// Whether a variable is set to anything but nothing and `0`.
pub fn is_set(name: &str) -> bool {
    std::env::var_os(name).is_some_and(|value| !value.is_empty() && value != "0")
}

/// Whether pinned files are to be written anew.
pub fn bless() -> bool {
    assert!(!(is_set("BLESS") && is_set("CI")), "nothing is rewritten in continuous integration");
    is_set("BLESS")
}

/// A number; what is no number ends the test.
pub fn number<T: FromStr>(name: &str, otherwise: T) -> T {
    let Ok(text) = std::env::var(name) else { return otherwise };
    text.parse().unwrap_or_else(|_| panic!("{name}={text} is no number"))
}

/// The folder of captured frames, which are no part of the repository.
pub fn captures() -> Option<PathBuf> {
    is_set("NINEBIT_CAPTURES").then(|| at(std::env::var_os("NINEBIT_CAPTURES").unwrap_or_default()))
}
