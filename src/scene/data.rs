//! Writes the text of a scene, or of a value of it, from plain data of another language.

use super::fields as source;
use super::form::{Entry, Form, HasForm, Kind};
use super::notation::word;

/// A value as dynamic languages have them.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// True or false.
    Bool(bool),
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// A word or a text: which of the two depends on the place.
    Text(String),
    /// A value as a scene file has it.
    Code(String),
    /// Values in order.
    List(Vec<Data>),
    /// Values in order that are not to be changed: where a scene has either, it becomes values in parentheses.
    Tuple(Vec<Data>),
    /// Values by name.
    Map(Vec<(String, Data)>),
}

/// Returns the text of a scene.
///
/// Maps are structures, tables or, with one entry, a word with its value: `{"Window": [...]}`. A map of lists stands for a list of structures:
/// `{"position": [...], "diffuse": [...]}`. Texts are words where the format has words. The text is not checked: reading it does that.
pub fn scene_text(data: &Data) -> String {
    let mut out = String::new();
    write(data, Some(source::Scene::form()), &mut out);
    out
}

/// Returns the text of a value of a place that is not known.
pub fn value_text(data: &Data) -> String {
    let mut out = String::new();
    write(data, None, &mut out);
    out
}

fn write(data: &Data, form: Option<Form>, out: &mut String) {
    // A name may stand for any value; what is no text is the value itself.
    let form = match form {
        Some(Form::OrName(of, _)) if !matches!(data, Data::Text(_)) => Some(of()),
        form => form,
    };
    match data {
        Data::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
        Data::Whole(value) => out.push_str(&value.to_string()),
        Data::Number(value) => out.push_str(&format!("{value:?}")),
        Data::Code(text) => out.push_str(text),
        Data::Text(text) => match form {
            Some(Form::Value(Kind::Choice(_))) => out.push_str(text),
            Some(Form::Variant(variants)) if is_variant(variants, text) => out.push_str(text),
            None | Some(Form::Value(Kind::Other)) if is_word(text) => out.push_str(text),
            _ => quote(text, out),
        },
        Data::List(items) | Data::Tuple(items) => {
            let list = match form {
                Some(Form::List(_)) => true,
                Some(Form::Tuple(_) | Form::Value(Kind::Color | Kind::Numbers)) => false,
                _ => matches!(data, Data::List(_)),
            };
            let of = match form {
                Some(Form::List(of) | Form::Tuple(of)) => Some(of),
                _ => None,
            };
            separated(out, if list { "[]" } else { "()" }, items, |item, out| write(item, of.map(|of| of()), out));
        }
        Data::Map(entries) => map(entries, form, out),
    }
}

fn map(entries: &[(String, Data)], form: Option<Form>, out: &mut String) {
    match form {
        Some(Form::Table(of)) => separated(out, "{}", entries, |(key, value), out| {
            quote(key, out);
            out.push_str(": ");
            write(value, Some(of()), out);
        }),
        Some(Form::List(of)) => separated(out, "[]", &rows(entries), |row, out| write(row, Some(of()), out)),
        Some(Form::Fields(fields)) => named(entries, &fields(), out),
        Some(Form::Variant(variants)) => match entries {
            [(name, value)] => {
                call(name, value, variants.iter().find(|(known, _)| known == name).map(|(_, of)| of()), out)
            }
            _ => named(entries, &[], out),
        },
        _ => match entries {
            [(name, value)] if name.starts_with(char::is_uppercase) => call(name, value, None, out),
            _ => named(entries, &[], out),
        },
    }
}

/// Writes fields in parentheses.
fn named(entries: &[(String, Data)], fields: &[Entry], out: &mut String) {
    separated(out, "()", entries, |(name, value), out| {
        out.push_str(name);
        out.push_str(": ");
        let form = fields.iter().find(|(field, _)| field == name).map(|(_, of)| of());
        write(value, form, out);
    });
}

/// Writes a word with its value: in `Matrix(...)` the parentheses belong to the fields, in `Window([...])` they hold the value.
fn call(name: &str, value: &Data, form: Option<Form>, out: &mut String) {
    out.push_str(name);
    let inside = match (value, form) {
        (Data::Map(_), Some(Form::List(_) | Form::Table(_))) => false,
        (Data::Map(_) | Data::Tuple(_), _) => true,
        _ => false,
    };
    if inside {
        write(value, form, out);
    } else {
        separated(out, "()", std::slice::from_ref(value), |value, out| write(value, form, out));
    }
}

fn separated<T>(out: &mut String, brackets: &str, items: &[T], mut write: impl FnMut(&T, &mut String)) {
    out.push_str(&brackets[..1]);
    for (n, item) in items.iter().enumerate() {
        if n > 0 {
            out.push_str(", ");
        }
        write(item, out);
    }
    out.push_str(&brackets[1..]);
}

/// Returns the structures whose fields are the entries of lists; the shortest list says how many.
fn rows(entries: &[(String, Data)]) -> Vec<Data> {
    let lists: Vec<(&String, &Vec<Data>)> = entries
        .iter()
        .filter_map(|(name, value)| match value {
            Data::List(items) | Data::Tuple(items) => Some((name, items)),
            _ => None,
        })
        .collect();
    let count = lists.iter().map(|(_, items)| items.len()).min().unwrap_or(0);
    (0..count)
        .map(|n| Data::Map(lists.iter().map(|(name, items)| ((*name).clone(), items[n].clone())).collect()))
        .collect()
}

fn is_variant(variants: &[Entry], text: &str) -> bool {
    variants.iter().any(|(name, _)| *name == word(text).0)
}

/// Returns whether a text looks like a word of the format, `Texture0` or `ExpandNormal(Texture0)`, and not like a name that the scene gives.
fn is_word(text: &str) -> bool {
    let (head, rest) = word(text);
    head.starts_with(|c: char| c.is_ascii_uppercase())
        && (rest.is_empty() || rest.starts_with('(') && rest.ends_with(')'))
}

pub(crate) fn quote(text: &str, out: &mut String) {
    out.push('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => out.extend(['\\', character]),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            '\0' => out.push_str("\\0"),
            control if control.is_control() => out.extend(control.escape_unicode()),
            _ => out.push(character),
        }
    }
    out.push('"');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse;
    use ninebit::limits::Limits;
    use std::path::Path;

    fn text(value: &str) -> Data {
        Data::Text(value.to_owned())
    }

    fn map(entries: &[(&str, Data)]) -> Data {
        Data::Map(entries.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect())
    }

    fn numbers(values: &[i64]) -> Data {
        Data::List(values.iter().map(|value| Data::Whole(*value)).collect())
    }

    #[test]
    fn a_scene_is_written_from_data() {
        let positions = Data::List([[0, 0], [8, 0], [0, 8]].iter().map(|at| numbers(at)).collect());
        let stage = map(&[("rgb", map(&[("a", text("ExpandNormal(Texture0)")), ("ab", text("Spare0"))]))]);
        let scene = map(&[
            ("version", Data::Whole(1)),
            ("profile", text("Nv2a")),
            (
                "targets",
                Data::List(vec![map(&[
                    ("name", text("Frame")),
                    ("width", Data::Whole(8)),
                    ("height", Data::Whole(8)),
                ])]),
            ),
            (
                "textures",
                map(&[(
                    "a \"b\"",
                    map(&[(
                        "source",
                        map(&[(
                            "Solid",
                            map(&[
                                ("width", Data::Whole(1)),
                                ("height", Data::Whole(1)),
                                ("color", Data::Tuple(vec![Data::Whole(1), Data::Whole(2), Data::Whole(3)])),
                            ]),
                        )]),
                    )]),
                )]),
            ),
            (
                "draws",
                Data::List(vec![map(&[
                    ("name", text("one")),
                    ("vertices", map(&[("Window", map(&[("position", positions)]))])),
                    ("textures", Data::List(vec![text("a \"b\"")])),
                    ("dither", Data::Bool(false)),
                    (
                        "program",
                        map(&[(
                            "Combiners",
                            map(&[
                                ("constants", Data::List(vec![numbers(&[1, 2, 3, 4]); 2])),
                                ("stages", Data::List(vec![stage])),
                            ]),
                        )]),
                    ),
                ])]),
            ),
        ]);
        let written = scene_text(&scene);
        assert!(
            written.contains("vertices: Window([(position: (0, 0)), (position: (8, 0)), (position: (0, 8))])"),
            "{written}"
        );
        assert!(written.contains("program: Combiners(constants: ((1, 2, 3, 4), (1, 2, 3, 4)), stages: [(rgb: (a: ExpandNormal(Texture0), ab: Spare0))])"), "{written}");
        parse(&written, Path::new(""), &Limits::default()).unwrap_or_else(|error| panic!("{written}\n{error}"));
    }

    #[test]
    fn values_are_written_for_a_place_that_is_not_known() {
        for (data, expected) in [
            (Data::Tuple(vec![Data::Whole(1), Data::Number(0.5)]), "(1, 0.5)"),
            (numbers(&[1, 2]), "[1, 2]"),
            (text("Less"), "Less"),
            (text("stone"), "\"stone\""),
            (map(&[("Solid", map(&[("width", Data::Whole(1))]))]), "Solid(width: 1)"),
            (map(&[("file", text("a.png"))]), "(file: \"a.png\")"),
            (map(&[("Product", Data::List(vec![text("eye")]))]), "Product([\"eye\"])"),
            (Data::Code("Float(1, 0)".to_owned()), "Float(1, 0)"),
        ] {
            assert_eq!(value_text(&data), expected);
        }
    }
}
