//! Settings of the tests in environment variables, which `docs/testing.md` lists.
#![allow(dead_code, unreachable_pub, reason = "each test uses a part")]

use super::repository::at;
use std::path::PathBuf;
use std::str::FromStr;

/// Returns whether a variable is set to something other than the empty string and `0`.
pub fn is_set(name: &str) -> bool {
    std::env::var_os(name).is_some_and(|value| !value.is_empty() && value != "0")
}

/// Returns whether stored expectations are to be rewritten.
pub fn bless() -> bool {
    assert!(!(is_set("BLESS") && is_set("CI")), "nothing is rewritten in continuous integration");
    is_set("BLESS")
}

/// Returns the number in a variable, or `otherwise` if it is not set. Panics if it is no number.
pub fn number<T: FromStr>(name: &str, otherwise: T) -> T {
    let Ok(text) = std::env::var(name) else { return otherwise };
    text.parse().unwrap_or_else(|_| panic!("{name}={text} is no number"))
}

/// Returns the folder of captured frames, which are not part of the repository.
pub fn captures() -> Option<PathBuf> {
    is_set("NINEBIT_CAPTURES").then(|| at(std::env::var_os("NINEBIT_CAPTURES").unwrap_or_default()))
}
