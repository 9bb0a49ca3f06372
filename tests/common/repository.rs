//! Finds files of the repository. Tests of the program's crate run in the folder of the crate.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, reason = "each test uses a part; a test fails by panicking")]

use std::path::{Path, PathBuf};

/// Returns the path of a file or folder of the repository.
pub fn at(path: impl AsRef<Path>) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().join(path)
}

/// Returns the path from the top of the repository, as the documents write it.
pub fn name(path: &Path) -> String {
    path.strip_prefix(at("")).unwrap().to_str().unwrap().replace('\\', "/")
}

/// Returns a message as it reads for a program that runs at the top of the repository.
pub fn seen(message: &str) -> String {
    message.replace(&format!("{}/", at("").to_str().unwrap().trim_end_matches('/')), "")
}

/// Makes the top of the repository the working folder of this process.
pub fn enter() {
    std::env::set_current_dir(at("")).unwrap();
}
