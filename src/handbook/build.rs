//! Finds the handbook: in the repository it is a folder of documents, in a package a folder beside this file.

fn main() {
    let documents = "../../docs/rules";
    let folder = if std::path::Path::new(documents).exists() { documents } else { "rules" };
    // The compiler notes the pages that it includes; the index beside them is none.
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-env=HANDBOOK={folder}");
}
