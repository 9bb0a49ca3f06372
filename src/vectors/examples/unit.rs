//! Evaluates a unit of the conformance vectors on one row, as a test bench does.
//!
//! `cargo run -p ninebit-vectors --example unit`

use ninebit::state::{Policies, Profile};
use ninebit_vectors::unit::Conditions;
use ninebit_vectors::units::by_name;

fn main() {
    let Some(unit) = by_name("final-combiner") else { return };
    let conditions = Conditions { profile: Profile::Nv2a, policies: Policies::DEFAULT };
    let (inputs, results) = (unit.inputs(), unit.results());
    // The first value of each column.
    let row: Vec<i64> = inputs.iter().map(|column| column.nth(0)).collect();
    let mut yields = vec![0; results.len()];
    unit.evaluate(&row, &conditions, &mut yields);
    println!("{}: {}", unit.name(), unit.about());
    for (column, value) in inputs.iter().zip(&row).chain(results.iter().zip(&yields)) {
        println!("{:>24} {value}", column.name);
    }
}

#[cfg(test)]
#[test]
fn runs() {
    assert!(by_name("final-combiner").is_some());
    main();
}
