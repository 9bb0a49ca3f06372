//! Measures the accuracy of a technique: a scene's picture against the ground truth that it names.
//!
//! `cargo run -p ninebit-lab --example accuracy vectors/scenes/techniques/normalisation/smooth-combiners.ron`

use std::path::{Path, PathBuf};

use ninebit::limits::Limits;
use ninebit_lab::accuracy::{accuracy_text, measure};
use ninebit_scene::load;

fn report(path: &Path) -> Result<String, String> {
    let loaded = load(path, &Limits::default()).map_err(|error| error.to_string())?;
    let truth = loaded.truth.ok_or("the scene names no `truth`")?;
    let accuracy = measure(&loaded.scene, &loaded.plan, &truth).ok_or("no pixel that is drawn has a truth")?;
    Ok(accuracy_text(&accuracy))
}

fn main() {
    let Some(path) = std::env::args_os().nth(1).map(PathBuf::from) else {
        return eprintln!(
            "name a scene with a truth, for example vectors/scenes/techniques/normalisation/smooth-combiners.ron"
        );
    };
    println!("{}", report(&path).unwrap_or_else(|error| error));
}

#[cfg(test)]
#[test]
fn runs() {
    let scene =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../vectors/scenes/techniques/normalisation/smooth-combiners.ron");
    assert!(report(Path::new(scene)).unwrap_or_else(|error| error).contains("psnr"));
}
