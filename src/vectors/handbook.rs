//! Grades of rules, read from the handbook.

use crate::Unit;

/// The handbook of rules.
const TEXT: &str = include_str!("../../docs/numerics.md");

/// The grades of rules, from the strongest to the weakest.
pub const GRADES: [&str; 4] = ["SILICON", "DOCUMENT", "INFERRED", "CHOSEN"];

/// Returns the index in [`GRADES`] of the weakest grade of a rule in the handbook; the last one for an unknown rule.
pub fn grade(rule: &str) -> usize {
    let weakest = GRADES.len() - 1;
    let mut entry = TEXT.lines().skip_while(|line| {
        let id = line.strip_prefix("### ").and_then(|heading| heading.split_whitespace().next());
        id != Some(rule)
    });
    entry.next();
    let line = entry.take_while(|line| !line.starts_with('#')).find_map(|line| line.strip_prefix("- Grade: "));
    let Some(line) = line else { return weakest };
    GRADES.iter().rposition(|grade| line.contains(grade)).unwrap_or(weakest)
}

/// Returns the weakest grade of a unit's rules. The readings of an open question are graded as what nothing decides.
pub fn of(unit: &dyn Unit) -> &'static str {
    let weakest = unit.rules().iter().map(|rule| grade(rule)).max().unwrap_or(0);
    GRADES[if unit.readings().is_empty() { weakest } else { GRADES.len() - 1 }]
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
                assert!(TEXT.contains(&format!("### {rule} ")), "{}: {rule}", unit.name());
            }
        }
        assert_eq!((GRADES[grade("CMB-6")], GRADES[grade("unknown")]), ("INFERRED", "CHOSEN"));
    }
}
