//! The command `ninebit rule`: prints rules of the handbook.

use super::*;
use std::fmt::Write;

use ninebit::state::{POLICIES, Policy};
use ninebit_handbook::{GRADES, RULES, Rule, find, meaning};
use ninebit_program::spelling::closest;
use ninebit_vectors::{Unit, units};
use serde_json::Value;

/// Columns of a line of text.
const WIDTH: usize = 100;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Ids of rules, such as CMB-8, or how they begin, such as CMB; without any, all rules are listed
    #[arg(value_name = "ID")]
    ids: Vec<String>,
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Prints rules, or lists all of them.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let rules: Vec<&Rule<'_>> = match arguments.ids.as_slice() {
        [] => RULES.iter().collect(),
        ids => ids.iter().map(|id| named(id)).collect::<Result<Vec<_>, _>>()?.concat(),
    };
    let text = || match arguments.ids.len() == rules.len() {
        false => list(&rules),
        true => rules.iter().map(|rule| entry(rule)).collect::<Vec<_>>().join("\n"),
    };
    let json = || {
        let rules: Vec<Value> = rules.iter().map(|rule| value(rule)).collect();
        format!("{:#}\n", json!({ "format": "ninebit-rules-1", "rules": rules }))
    };
    arguments.format.print(text, json)
}

/// Returns the rule of an id, or those whose ids begin with it.
fn named(id: &str) -> Result<Vec<&'static Rule<'static>>, Failure> {
    if let Some(rule) = find(id) {
        return Ok(vec![rule]);
    }
    let family = format!("{}-", id.trim_end_matches('-').to_uppercase());
    let rules: Vec<&Rule<'_>> = RULES.iter().filter(|rule| rule.id.starts_with(&family)).collect();
    if rules.is_empty() { Err(unknown(id)) } else { Ok(rules) }
}

fn unknown(id: &str) -> Failure {
    let short: String = id.chars().take(40).collect();
    let word = short.to_lowercase();
    let titled: Vec<&str> =
        RULES.iter().filter(|rule| rule.title.to_lowercase().contains(&word)).map(|rule| rule.id).collect();
    let plain = |text: &str| text.replace(['-', ' ', '_'], "").to_uppercase();
    let dashed = RULES.iter().map(|rule| rule.id).find(|known| plain(known) == plain(&short));
    let help = match dashed.or_else(|| closest(id, RULES.iter().map(|rule| rule.id))) {
        Some(known) => format!("did you mean {known}? `ninebit rule` lists all rules"),
        None if word.len() > 2 && !titled.is_empty() => {
            format!("`{}` is in the title of {}", shown::name(&short), titled.join(", "))
        }
        None => "`ninebit rule` lists all rules".to_owned(),
    };
    let report = Report::message(Some("NB1301"), &format!("there is no rule `{}`", shown::name(&short)), &help);
    Failure { exit: Exit::Usage, report }
}

/// Returns one line for each rule, under the headings of the handbook.
fn list(rules: &[&Rule<'_>]) -> String {
    let mut text = String::new();
    let mut section = "";
    for rule in rules {
        if rule.section != section {
            section = rule.section;
            let _ = writeln!(text, "{}{section}", if text.is_empty() { "" } else { "\n" });
        }
        let _ = writeln!(text, "  {:<8}{:<28}{}", rule.id, rule.grades().join(", "), rule.title);
    }
    text.push('\n');
    for grade in GRADES {
        let _ = writeln!(text, "{grade:<10}{}", meaning(grade));
    }
    text + "A further grade holds for a part of a rule. `ninebit rule ID` prints a rule.\n"
}

/// Returns the units of the vectors that follow a rule.
fn followers(id: &str) -> Vec<&'static str> {
    units::all().into_iter().filter(|unit| unit.rules().contains(&id)).map(Unit::name).collect()
}

fn policy(id: &str) -> Option<&'static Policy> {
    POLICIES.iter().find(|policy| policy.rule == id)
}

/// Returns an entry for people.
fn entry(rule: &Rule<'_>) -> String {
    let built = if rule.built { "" } else { " (not built)" };
    let mut text = format!("{} {}{built}\n", rule.id, rule.title);
    for line in rule.field("Formula").lines() {
        let _ = writeln!(text, "    {line}");
    }
    let mut said = "Formula";
    for (label, field) in rule.fields.iter().filter(|(label, _)| *label != "Formula") {
        // Of several fields of one name the first has it.
        let name = if *label == said { String::new() } else { label.to_lowercase() };
        said = label;
        match (*label, rule.grades().as_slice()) {
            ("Grade", [grade]) => paragraph(&mut text, &name, &format!("{grade}: {}", meaning(grade))),
            ("Grade", grades) => {
                paragraph(&mut text, &name, field);
                grades.iter().for_each(|grade| paragraph(&mut text, "", &format!("{grade}: {}", meaning(grade))));
            }
            // To be copied in one piece.
            ("Command", _) => {
                let _ = writeln!(text, "  {name:<12}{}", field.trim_matches('`'));
            }
            _ => paragraph(&mut text, &name, field),
        }
    }
    let units = followers(rule.id);
    if !units.is_empty() {
        paragraph(&mut text, "units", &format!("{} (`ninebit op unit NAME`)", units.join(", ")));
    }
    text
}

/// Appends a named text, wrapped.
fn paragraph(out: &mut String, name: &str, text: &str) {
    let mut line = format!("  {name:<12}");
    let margin = line.len();
    let mut empty = true;
    for word in text.split(' ') {
        if !empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(out, "{line}");
            (line, empty) = (" ".repeat(margin), true);
        }
        line.push_str(if empty { "" } else { " " });
        line.push_str(word);
        empty = false;
    }
    let _ = writeln!(out, "{line}");
}

/// Returns an entry for programs.
fn value(rule: &Rule<'_>) -> Value {
    let optional = |label: &str| Some(rule.field(label)).filter(|text| !text.is_empty());
    let places = |label: &str| -> Vec<Value> {
        rule.references(label).into_iter().map(|(file, name)| json!({ "file": file, "name": name })).collect()
    };
    let policy = policy(rule.id).map(|policy| {
        let values: Vec<Value> =
            policy.values.iter().map(|(value, meaning)| json!({ "value": value, "meaning": meaning })).collect();
        json!({ "question": policy.question, "values": values })
    });
    json!({
        "id": rule.id,
        "title": rule.title,
        "section": rule.section,
        "built": rule.built,
        "grades": rule.grades(),
        "grade": rule.field("Grade"),
        "formula": rule.field("Formula"),
        "range": optional("Range"),
        "source": optional("Source"),
        "reading": rule.fields("Reading").collect::<Vec<_>>(),
        "example": optional("Example"),
        "commands": rule.fields("Command").map(|text| text.trim_matches('`')).collect::<Vec<_>>(),
        "error": optional("Error"),
        "policy": policy,
        "decided_by": rule.references("Decided by").into_iter().map(|(file, _)| file).collect::<Vec<_>>(),
        "units": followers(rule.id),
        "code": places("Code"),
        "pinned_by": places("Pinned by"),
    })
}
