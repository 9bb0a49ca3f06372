//! The tree of values in a scene's text, for forms.

use ninebit_scene::outline::{Content, Kind, Node, outline};
use serde_json::{Value, json};

/// Returns the tree of a text. Spans are in UTF-16 units, as scripts count.
pub(crate) fn value(text: &str) -> Value {
    node(&outline(text), text, &Places::new(text))
}

fn node(each: &Node, text: &str, places: &Places) -> Value {
    let span = [each.span.start, each.span.end].map(|at| places.unit(at));
    let mut value = json!({ "label": each.label, "span": span });
    match &each.content {
        Content::Value(of) => {
            value["kind"] = kind(of);
            value["text"] = json!(text[each.span.clone()]);
        }
        Content::Group { parts, absent, around } => {
            value["parts"] = parts.iter().map(|part| node(part, text, places)).collect();
            let absent: Vec<Value> =
                absent.iter().map(|(field, of)| json!({ "field": field, "kind": kind(of) })).collect();
            if !absent.is_empty() {
                value["absent"] = json!(absent);
                value["around"] = json!(around);
            }
        }
    }
    value
}

fn kind(kind: &Kind) -> Value {
    match kind {
        Kind::Color => json!({ "is": "color" }),
        Kind::Whole { most } => json!({ "is": "whole", "most": most }),
        Kind::Number => json!({ "is": "number" }),
        Kind::Numbers => json!({ "is": "numbers" }),
        Kind::Choice(words) => json!({ "is": "choice", "words": words }),
        Kind::Text => json!({ "is": "text" }),
        Kind::Other => json!({ "is": "other" }),
    }
}

/// Conversion from byte offsets to UTF-16 units. Most texts have one byte per unit.
struct Places {
    /// For each character of several bytes: its end, and by how many bytes the text up to there is longer than its UTF-16 units.
    wide: Vec<(usize, usize)>,
}

impl Places {
    fn new(text: &str) -> Places {
        let mut longer = 0;
        let wide = text.char_indices().filter(|(_, c)| !c.is_ascii()).map(|(at, c)| {
            longer += c.len_utf8() - c.len_utf16();
            (at + c.len_utf8(), longer)
        });
        Places { wide: wide.collect() }
    }

    fn unit(&self, at: usize) -> usize {
        let before = self.wide.partition_point(|(end, _)| *end <= at);
        at - before.checked_sub(1).map_or(0, |last| self.wide[last].1)
    }
}
