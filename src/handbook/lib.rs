//! The handbook of rules, the folder `docs/rules`, as data.
//!
//! [`RULES`] has every entry; [`find`] returns one by its id. [`parse`] reads a page, so that what the program prints and what tests check
//! against the sources is one reading of one text.

use std::collections::HashMap;
use std::sync::LazyLock;

macro_rules! pages {
    ($($name:literal),+ $(,)?) => { [$(($name, include_str!(concat!(env!("HANDBOOK"), "/", $name)))),+] };
}

/// The pages of rules in their order: name of the file and text. Their index, `README.md`, is for readers of the folder only.
pub const PAGES: [(&str, &str); 9] = pages![
    "arithmetic.md",
    "raster.md",
    "fog.md",
    "depth-and-stencil.md",
    "texture.md",
    "texture-shader.md",
    "combiner.md",
    "blend-and-store.md",
    "vertex.md",
];

/// The grades of rules, from the strongest to the weakest, each with its meaning.
const MEANINGS: [(&str, &str); 4] = [
    ("SILICON", "read off captures of a real NV2A and confirmed on them pixel by pixel"),
    ("DOCUMENT", "stated by a vendor text, or by a register model that was compared with real hardware"),
    ("INFERRED", "follows from rules of the grades SILICON and DOCUMENT; no measurement isolates it"),
    ("CHOSEN", "nothing decides it; one answer was picked"),
];

/// The grades of rules, from the strongest to the weakest.
pub const GRADES: [&str; 4] = [MEANINGS[0].0, MEANINGS[1].0, MEANINGS[2].0, MEANINGS[3].0];

/// Every rule of the handbook, in its order.
pub static RULES: LazyLock<Vec<Rule<'static>>> =
    LazyLock::new(|| PAGES.iter().flat_map(|(name, text)| parse(name, text)).collect());

/// The entry of a rule: a heading `### ID title`, a block with the formula, and a list of fields, one a line: `- Grade: ...`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rule<'t> {
    /// Its id, such as `CMB-3`.
    pub id: &'t str,
    /// Its title.
    pub title: &'t str,
    /// Name of its page.
    pub page: &'t str,
    /// The heading above it.
    pub section: &'t str,
    /// Whether it is built, that is, does not stand under "Known, not built yet".
    pub built: bool,
    /// Label and text of each field in order, the formula among them. A label can come more than once.
    pub fields: Vec<(&'t str, &'t str)>,
}

impl<'t> Rule<'t> {
    /// Returns the first field with a label; an empty text if there is none.
    pub fn field(&self, label: &str) -> &'t str {
        self.fields(label).next().unwrap_or_default()
    }

    /// Returns all fields with a label.
    pub fn fields(&self, label: &str) -> impl Iterator<Item = &'t str> {
        self.fields.iter().filter(move |field| field.0 == label).map(|field| field.1)
    }

    /// Returns its grades: that of the rule, then those that hold for a part of it.
    pub fn grades(&self) -> Vec<&'t str> {
        let text = self.field("Grade");
        let mut grades = Vec::new();
        let (mut depth, mut start) = (0, 0);
        for (at, c) in text.char_indices().chain([(text.len(), ',')]) {
            match c {
                '(' => depth += 1,
                ')' => depth -= 1,
                ',' if depth == 0 => {
                    let grade = text.get(start..at).unwrap_or_default();
                    grades.push(grade.split('(').next().unwrap_or_default().trim());
                    start = at + 1;
                }
                _ => {}
            }
        }
        grades
    }

    /// Returns the first letter of each of its grades, such as `SI`.
    pub fn mark(&self) -> String {
        self.grades().iter().filter_map(|grade| grade.chars().next()).collect()
    }

    /// Returns the index in [`GRADES`] of its weakest grade.
    pub fn weakest(&self) -> usize {
        let grades = self.grades();
        GRADES.iter().rposition(|grade| grades.contains(grade)).unwrap_or(GRADES.len() - 1)
    }

    /// Returns where the handbook has it, as a link from its index: the page and the anchor of its heading.
    pub fn link(&self) -> String {
        let heading = format!("{}-{}", self.id, self.title).to_lowercase().replace(' ', "-");
        let anchor: String = heading.chars().filter(|c| c.is_alphanumeric() || *c == '-').collect();
        format!("{}#{anchor}", self.page)
    }

    /// Returns the files that a field names, each with the name in code that follows it.
    pub fn references(&self, label: &str) -> Vec<(&'t str, Option<&'t str>)> {
        let parts = self.field(label).split(", ").filter_map(|part| {
            let mut quoted = part.split('`').skip(1).step_by(2);
            Some((quoted.next()?, quoted.next()))
        });
        parts.collect()
    }
}

/// Returns the rules of a page in order.
pub fn parse<'t>(page: &'t str, text: &'t str) -> Vec<Rule<'t>> {
    let mut rules: Vec<Rule<'_>> = Vec::new();
    let (mut section, mut built, mut open) = ("", true, false);
    let (mut at, mut formula) = (0, None);
    for line in text.split_inclusive('\n') {
        let start = at;
        at += line.len();
        let line = line.trim_end_matches(['\n', '\r']);
        let entry = if open { rules.last_mut() } else { None };
        if let Some(from) = formula {
            if line == "```" {
                let block = text.get(from..start).unwrap_or_default();
                entry.into_iter().for_each(|rule| rule.fields.push(("Formula", block.trim_end())));
                formula = None;
            }
        } else if let Some(title) = line.strip_prefix("## ") {
            (section, open) = (title, false);
            built &= title != "Known, not built yet";
        } else if let Some((id, title)) = line.strip_prefix("### ").and_then(|heading| heading.split_once(' ')) {
            open = true;
            rules.push(Rule { id, title, page, section, built, fields: Vec::new() });
        } else if line == "```text" && open {
            formula = Some(at);
        } else if let (Some(rule), Some(field)) = (entry, line.strip_prefix("- ").and_then(|l| l.split_once(": "))) {
            rule.fields.push(field);
        }
    }
    rules
}

/// Returns the rule with an id, in whichever case.
pub fn find(id: &str) -> Option<&'static Rule<'static>> {
    RULES.iter().find(|rule| rule.id.eq_ignore_ascii_case(id))
}

/// Returns the first letters of a rule's grades; an empty text for what is no rule.
pub fn mark(id: &str) -> &'static str {
    static MARKS: LazyLock<HashMap<&str, String>> =
        LazyLock::new(|| RULES.iter().map(|rule| (rule.id, rule.mark())).collect());
    MARKS.get(id).map_or("", String::as_str)
}

/// Returns what a grade means; an empty text for what is none.
pub fn meaning(grade: &str) -> &'static str {
    MEANINGS.iter().find(|(name, _)| *name == grade).map_or("", |(_, meaning)| meaning)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_is_read() {
        let text = "## Numbers\n\n### NUM-6 A number\n\n```text\na = b\n- c: d\n```\n\n- Grade: SILICON (a, b), CHOSEN (c)\n- Code: `x.rs` `y`, `z.rs`\n- Command: `1`\n- Command: `2`\n\n## Known, not built yet\n\n- No: field\n\n### ROP-7 Another\n\n- Grade: INFERRED\n";
        let rules = parse("page.md", text);
        let [first, second] = &rules[..] else { panic!("{rules:?}") };
        assert_eq!((first.id, first.title, first.section, first.built), ("NUM-6", "A number", "Numbers", true));
        assert_eq!(first.link(), "page.md#num-6-a-number");
        assert_eq!(first.field("Formula"), "a = b\n- c: d");
        assert_eq!((first.grades(), first.mark(), first.weakest()), (vec!["SILICON", "CHOSEN"], "SC".to_owned(), 3));
        assert_eq!(first.references("Code"), [("x.rs", Some("y")), ("z.rs", None)]);
        assert_eq!(first.fields("Command").collect::<Vec<_>>(), ["`1`", "`2`"]);
        assert_eq!((second.built, second.weakest(), second.fields.len()), (false, 2, 1));
    }

    #[test]
    fn every_heading_of_the_handbook_is_a_rule_with_a_grade() {
        let lines = PAGES.iter().flat_map(|(_, text)| text.lines());
        let headings = lines.filter(|line| line.starts_with("### ")).count();
        assert!(headings > 90 && RULES.len() == headings, "{headings} headings, {} rules", RULES.len());
        for rule in RULES.iter() {
            assert!(!rule.grades().is_empty(), "{}", rule.id);
            assert!(rule.grades().iter().all(|grade| GRADES.contains(grade)), "{}: {:?}", rule.id, rule.grades());
            for label in ["Code", "Pinned by"] {
                let named = rule.field(label).split(", ").filter(|part| !part.is_empty()).count();
                assert_eq!(rule.references(label).len(), named, "{}: {label}", rule.id);
            }
        }
        assert_eq!(find("cmb-3").map(|rule| rule.id), Some("CMB-3"));
        assert_eq!((mark("NUM-1"), mark("NUM-2"), mark("")), ("D", "SI", ""));
        assert!(GRADES.iter().all(|grade| !meaning(grade).is_empty()) && meaning("NONE").is_empty());
    }
}
