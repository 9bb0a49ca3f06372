//! Checks `docs/evidence/answers.md`: grades are those of the handbook, and vectors exist.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::bench::Bench;
use crate::repository::at;
use crate::settings::bless;
use ninebit_handbook::find as rule;

fn read(path: &str) -> String {
    std::fs::read_to_string(at(path)).unwrap()
}

/// Returns the grade of a rule in the handbook.
fn grade(id: &str) -> &'static str {
    rule(id).unwrap_or_else(|| panic!("there is no rule {id}")).field("Grade")
}

#[test]
fn grades_are_those_of_the_handbook() {
    let page = read("docs/evidence/answers.md");
    let mut held = 0;
    let graded: Vec<String> = page
        .lines()
        .map(|line| {
            let Some(rules) = line.strip_prefix("- Rules: ") else { return line.to_owned() };
            let rules = rules.trim_end_matches('.').split("; ").map(|part| {
                held += 1;
                let id = part.split(' ').next().unwrap();
                format!("{id} {}", grade(id))
            });
            format!("- Rules: {}.", rules.collect::<Vec<_>>().join("; "))
        })
        .collect();
    assert!(held > 15, "{held} rules");
    if bless() {
        return std::fs::write(at("docs/evidence/answers.md"), graded.join("\n") + "\n").unwrap();
    }
    for (line, graded) in page.lines().zip(&graded) {
        assert_eq!(line, graded, "BLESS=1 writes the grades");
    }
}

#[test]
fn vectors_exist() {
    let (page, known) = (read("docs/evidence/answers.md"), Bench::new().run("vectors list").text());
    for line in page.lines().filter_map(|line| line.strip_prefix("- Vectors: ")) {
        for name in line.split('`').skip(1).step_by(2) {
            let is_unit = known.lines().any(|line| line.split_whitespace().next() == Some(name));
            let is_file = at("vectors").join(name).exists();
            assert!(is_unit || is_file, "{name}");
        }
    }
}
