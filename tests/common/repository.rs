//! Where the files of the repository are: tests of the program's crate run in its own folder.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, reason = "each test uses a part; a test fails by panicking")]

use std::path::{Path, PathBuf};

/// A file or folder of the repository.
pub fn at(path: impl AsRef<Path>) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().join(path)
}

/// The path from the top of the repository, as documents have it.
pub fn name(path: &Path) -> String {
    path.strip_prefix(at("")).unwrap().to_str().unwrap().replace('\\', "/")
}

/// A message as somebody at the top of the repository sees it.
pub fn seen(message: &str) -> String {
    message.replace(&format!("{}/", at("").to_str().unwrap().trim_end_matches('/')), "")
}

/// Makes the top of the repository the folder of a process of tests.
pub fn enter() {
    std::env::set_current_dir(at("")).unwrap();
}
