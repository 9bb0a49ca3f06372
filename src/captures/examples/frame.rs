//! Draws captured frames of a suite again, and says which equal what the chip showed.
//!
//! `cargo run -p ninebit-captures --example frame`

use ninebit::engine::RenderOptions;
use ninebit::state::Policies;
use ninebit_captures::{frames, sample};

fn report(suite: &str) -> Result<String, String> {
    let mut text = String::new();
    for frame in sample(frames(&[suite]).map_err(|error| error.to_string())?, 3) {
        let drawn = frame.render(&RenderOptions::default(), Policies::DEFAULT);
        let is_exact = drawn.map(|pixels| frame.is(&pixels)).map_err(|errors| errors[0].message.clone())?;
        text += &format!("{}: {}\n", frame.name, if is_exact { "exact" } else { "another picture" });
    }
    Ok(text)
}

fn main() {
    print!("{}", report("Color_key").unwrap_or_else(|error| error));
}

#[cfg(test)]
#[test]
fn runs() {
    assert!(report("Color_key").unwrap().lines().all(|line| line.ends_with(": exact")));
    main();
}
