//! Checks that any bytes, read as the manifest of a pack, as the leaf of a sweep and as a tree, yield a value or an error, never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit_vectors::{pack, tree};
use std::path::PathBuf;
use std::sync::LazyLock;

/// A folder for this process, in memory if the system has `/dev/shm`.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let base = if std::path::Path::new("/dev/shm").is_dir() { PathBuf::from("/dev/shm") } else { std::env::temp_dir() };
    let folder = base.join(format!("ninebit-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("units")).expect("a folder");
    folder
});

fuzz_target!(|bytes: &[u8]| {
    let place = |name: &str| FOLDER.join(name);
    for name in ["MANIFEST.json", "leaf-0000.json", "tree.json"] {
        std::fs::write(place(name), bytes).expect("a file");
    }
    let _ = pack::open(&FOLDER);
    let _ = tree::merge(std::slice::from_ref(&*FOLDER));
    let _ = tree::Tree::read(&place("tree.json"));
});
