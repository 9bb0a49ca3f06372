//! Compares the scenes of a folder with their expectations, as a program's own tests may do.
//!
//! `cargo run -p ninebit --example replay`

use ninebit::replay::{Options, find, replay, report};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../vectors/scenes/fog");
    let replayed = replay(&find(&[folder.into()])?, &Options::default(), &|_| {});
    println!("{}", report::text(&replayed));
    if replayed.iter().any(|scene| scene.exit_code() != 0) { Err("not as expected".into()) } else { Ok(()) }
}
