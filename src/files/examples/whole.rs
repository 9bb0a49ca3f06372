//! Writes a file as a whole or not at all, and reads it within a limit.
//!
//! `cargo run -p ninebit-files --example whole`

use ninebit::limits::{EXPECTATION, FileLimit};
use ninebit_files::output::write_file;
use ninebit_files::read::{Kind, bytes};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::temp_dir().join(format!("ninebit-whole-{}.txt", std::process::id()));
    write_file(&path, b"nine bits, signed")?;
    println!("{} bytes", bytes(&path, Kind::Regular, EXPECTATION)?.len());
    let refused = bytes(&path, Kind::Regular, FileLimit { bytes: 4, ..EXPECTATION });
    println!("{}", refused.err().ok_or("more than the limit was read")?);
    Ok(std::fs::remove_file(&path)?)
}
