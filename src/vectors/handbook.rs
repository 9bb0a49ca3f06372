//! Grades of units, from the handbook of rules.

use crate::Unit;
use ninebit_handbook::{GRADES, Rule, find};

/// Returns the weakest grade of a unit's rules. The readings of an open question are graded as what nothing decides.
pub fn grade(unit: &dyn Unit) -> &'static str {
    let last = GRADES.len() - 1;
    let weakest = unit.rules().iter().map(|rule| find(rule).map_or(last, Rule::weakest)).max().unwrap_or(0);
    GRADES[if unit.readings().is_empty() { weakest } else { last }]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units;

    #[test]
    fn every_rule_of_a_unit_has_an_entry() {
        for unit in units::all() {
            assert!(!unit.rules().is_empty(), "{}", unit.name());
            for rule in unit.rules() {
                assert!(find(rule).is_some(), "{}: {rule}", unit.name());
            }
        }
        let product = units::by_name("product").expect("a unit of this name");
        assert_eq!((find("CMB-6").map(Rule::weakest), grade(product)), (Some(2), "CHOSEN"));
    }
}
