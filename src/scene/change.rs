//! Changes of a scene: a value is put at a path, `draws[0].program.constants[0]=(255, 128, 0, 255)`.
//!
//! A path names fields, indexes of lists and keys of tables. What a word says about a value, as `Combiners` in `Combiners(...)`, needs no step of its own.
//! A change is one of text: the value is written as in a scene file, and is read with the rest of the scene.

mod walk;

use std::str::FromStr;

use ninebit::diagnostic::{Diagnostic, Source};
use ninebit::place::Span;

use super::error::SceneError;
use super::fields as source;
use super::form::{Form, HasForm, Kind};
use super::notation::{Notation, trim, word};
use super::raw::Raw;
use super::source::renamed;
use super::wording::{closest, describe, shorten};
use walk::find;

/// Code of a change that is not written as `PATH=VALUE`.
const MALFORMED: &str = "NB0113";
/// Code of a path that leads to nothing.
const NOWHERE: &str = "NB0114";

/// Deepest nesting of a value.
const NESTING: usize = 64;

/// A value and the path of its place in a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// The change as it was written, for messages.
    text: String,
    steps: Vec<Step>,
    /// Range of the value in the text.
    value: Span,
}

/// A step of a path, with its range in the text of the change.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Step {
    to: Label,
    place: Span,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Label {
    /// A field, a key of a table, the name of a draw or a target.
    Name(String),
    /// An index in a list, or in values in parentheses.
    Index(usize),
}

impl FromStr for Change {
    type Err = SceneError;

    /// Reads `PATH=VALUE`.
    ///
    /// # Errors
    /// NB0113: it is not written like that.
    fn from_str(text: &str) -> Result<Change, SceneError> {
        change(text).map_err(|finding| refused(text, *finding))
    }
}

impl Change {
    /// Makes the change that puts `value` at `path`.
    ///
    /// # Errors
    /// NB0113: the path or the value is not written as such.
    pub fn new(path: &str, value: &str) -> Result<Change, SceneError> {
        format!("{path}={value}").parse()
    }

    /// Returns the path.
    pub fn path(&self) -> &str {
        let end = self.steps.last().map_or(0, |step| step.place.end);
        &self.text[..end]
    }

    /// Carries out the change in the text of a scene, or in that of its family if the path is only written there.
    ///
    /// # Errors
    /// NB0114: there is no such place.
    pub fn apply(&self, scene: &mut String, family: Option<&mut String>) -> Result<(), SceneError> {
        let place = find(scene, source::Scene::form, self);
        let (text, edit) = match (place, family) {
            (Ok(edit), Some(family)) if !edit.written => match find(family, source::Family::form, self) {
                Ok(shared) if shared.written => (family, shared),
                _ => (scene, edit),
            },
            (Ok(edit), _) => (scene, edit),
            (Err(error), Some(family)) => match find(family, source::Family::form, self) {
                Ok(shared) => (family, shared),
                Err(_) => return Err(refused(&self.text, *error)),
            },
            (Err(error), None) => return Err(refused(&self.text, *error)),
        };
        text.replace_range(edit.place, &edit.text);
        Ok(())
    }
}

/// A replacement of a range of a text.
struct Edit {
    place: Span,
    text: String,
    /// Whether the value was written before.
    written: bool,
}

/// Makes the error about the text of a change.
fn refused(text: &str, finding: Diagnostic) -> SceneError {
    let source = Source { name: "--set".to_owned(), text: text.to_owned() };
    SceneError { diagnostics: vec![finding], suppressed: 0, source }
}

fn malformed(place: Span, message: impl Into<String>, label: &str) -> Box<Diagnostic> {
    let help =
        "write `draws[0].program.constants[0]=(255, 128, 0, 255)`: a path, `=`, and the value as a scene file has it";
    Box::new(Diagnostic::error(MALFORMED, place, message).label(label).help(help))
}

fn change(text: &str) -> Result<Change, Box<Diagnostic>> {
    let mut steps = Vec::new();
    let mut at = 0;
    loop {
        let rest = &text[at..];
        let step = match rest.as_bytes().first() {
            Some(b'=') if !steps.is_empty() => break,
            Some(b'[') => bracket(text, at)?,
            Some(b'.') if !steps.is_empty() => field(text, at + 1)?,
            Some(_) if steps.is_empty() => field(text, at)?,
            None if !steps.is_empty() => return Err(malformed(at..at, "the change has no value", "`=` is missing")),
            _ => {
                let next = rest.chars().next().map_or(0, char::len_utf8);
                return Err(malformed(at..at + next, "this is no path of a scene", "not expected here"));
            }
        };
        at = step.place.end;
        steps.push(step);
        at += text[at..].len() - text[at..].trim_start_matches(' ').len();
    }
    let start = at + 1;
    let refused = |problem| malformed(start..text.len(), "this is no value", problem);
    let value = one_value(&text[start..]).map_err(refused)?;
    Ok(Change { text: text.to_owned(), steps, value: start + value.start..start + value.end })
}

/// Returns the range of the only value in a text, without comments around it.
fn one_value(text: &str) -> Result<Span, &'static str> {
    if trim(text).is_empty() {
        return Err("nothing is written here");
    }
    let list = format!("({text}\n)");
    let mut notation = Notation::new(&list);
    let whole = notation.check(0..list.len(), NESTING).map_err(|_| "brackets, commas or quotes do not fit")?;
    match notation.items(whole, b'(').as_deref() {
        Some([value]) => Ok(notation.range(value).start - 1..notation.range(value).end - 1),
        _ => Err("write one value"),
    }
}

fn field(text: &str, start: usize) -> Result<Step, Box<Diagnostic>> {
    let length = text[start..].find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text[start..].len());
    if length == 0 {
        return Err(malformed(start..start, "this is no path of a scene", "the name of a field is missing"));
    }
    let name = &text[start..start + length];
    Ok(Step { to: Label::Name(name.to_owned()), place: start..start + length })
}

fn bracket(text: &str, start: usize) -> Result<Step, Box<Diagnostic>> {
    let quote = text[start + 1..].starts_with('"');
    let close = if quote { "\"]" } else { "]" };
    let inside = start + 1 + usize::from(quote);
    let Some(length) = text[inside..].find(close) else {
        return Err(malformed(start..start + 1, "a bracket of the path is not closed", "opened here"));
    };
    let said = &text[inside..inside + length];
    let to = match said.trim().parse() {
        Ok(index) if !quote => Label::Index(index),
        _ if said.is_empty() => {
            return Err(malformed(start..inside + 1, "a bracket of the path is empty", "write an index or a name"));
        }
        _ => Label::Name(said.to_owned()),
    };
    Ok(Step { to, place: start..inside + length + close.len() })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"(version: 1, profile: Nv2a,
    textures: { "stone": (source: Solid(width: 8, height: 8, color: (1, 2, 3))) },
    names: (vectors: { "sun": (0, 0, 1) }),
    draws: [(
        name: "wall", textures: ["stone"],
        vertices: Window([(position: (0, 0), diffuse: (255, 0, 0)), (position: (8, 0)), (position: (0, 8))]),
        program: Combiners(constants: ((1, 2, 3, 4), (5, 6, 7, 8)), stages: [(rgb: (a: Texture0, ab: Spare0))]),
    )],
)"#;

    fn changed(change: &str) -> Result<String, String> {
        let change: Change = change.parse().map_err(|error: SceneError| error.to_string())?;
        let mut text = SCENE.to_owned();
        change.apply(&mut text, None).map_err(|error| error.to_string())?;
        Ok(text)
    }

    #[test]
    fn a_value_is_put_at_its_place() {
        for (change, old, new) in [
            ("draws[0].program.constants[1]=(9, 9, 9, 9)", "(5, 6, 7, 8)", "(9, 9, 9, 9)"),
            ("draws[0].program.Combiners.constants[1][2] = 0", "(5, 6, 7, 8)", "(5, 6, 0, 8)"),
            ("draws[\"wall\"].vertices[0].diffuse=(1, 1, 1)", "(255, 0, 0)", "(1, 1, 1)"),
            ("draws[wall].vertices[2].position=(0, 9)", "(0, 8)", "(0, 9)"),
            ("names.vectors.sun=(1, 0, 0)", "(0, 0, 1)", "(1, 0, 0)"),
            ("textures[\"stone\"].source.width=4", "width: 8", "width: 4"),
            ("profile=Nv10", "Nv2a", "Nv10"),
            ("draws[0].program.stages[0].rgb.a=ExpandNormal(Texture0)", "a: Texture0", "a: ExpandNormal(Texture0)"),
        ] {
            assert_eq!(changed(change), Ok(SCENE.replacen(old, new, 1)), "{change}");
        }
    }

    #[test]
    fn a_field_that_is_not_written_is_added() {
        for (change, old, new) in [
            ("draws[0].depth_test.function=Less", "(\n        name:", "(depth_test: (function: Less), \n        name:"),
            ("draws[0].vertices[1].diffuse=(1, 2, 3)", "(position: (8, 0))", "(diffuse: (1, 2, 3), position: (8, 0))"),
            ("draws[0].textures[0].mag_filter=Linear", "[\"stone\"]", "[(texture: \"stone\", mag_filter: Linear)]"),
            ("names.vectors.moon=(1, 0, 0)", "{ \"sun\"", "{\"moon\": (1, 0, 0),  \"sun\""),
            ("names.colors.red=(255, 0, 0)", "(vectors:", "(colors: { \"red\": (255, 0, 0) }, vectors:"),
        ] {
            assert_eq!(changed(change), Ok(SCENE.replacen(old, new, 1)), "{change}");
        }
    }

    #[test]
    fn what_leads_nowhere_is_refused_with_advice() {
        for (change, code, advice) in [
            ("draws[1].name=\"a\"", "NB0114", "there are 1, numbered from 0"),
            ("draws[0].progam.constants[0]=1", "NB0114", "did you mean `program`?"),
            ("names.vectors.sun.x=1", "NB0114", ""),
            ("names.colors.red.x=1", "NB0114", "no fields"),
            ("draws[0].depth_test.func=Less", "NB0114", "did you mean `function`?"),
            ("draws[\"wal\"].name=\"a\"", "NB0114", "did you mean `wall`?"),
            ("draws[0].name.x=1", "NB0114", "is a name"),
            ("draws[0].indexes[3]=1", "NB0114", ""),
            ("version", "NB0113", "`=` is missing"),
            ("version=", "NB0113", "nothing is written"),
            ("version=1, profile: Nv10", "NB0113", "do not fit"),
            ("version=1, 2", "NB0113", "write one value"),
            ("version=(1", "NB0113", "do not fit"),
            ("=1", "NB0113", "name of a field is missing"),
            ("draws[=1", "NB0113", "not closed"),
            ("draws[]=1", "NB0113", "write an index or a name"),
            ("version=1 // nothing", "", ""),
        ] {
            match changed(change) {
                Ok(_) => assert_eq!(code, "", "{change}"),
                Err(error) => {
                    assert!(!code.is_empty() && error.contains(code) && error.contains(advice), "{change}\n{error}")
                }
            }
        }
    }

    #[test]
    fn a_family_is_changed_where_only_it_has_the_value() {
        let (mut scene, mut family) =
            ("(version: 1)".to_owned(), "(names: (vectors: { \"sun\": (0, 0, 1) }))".to_owned());
        let apply = |change: &str, scene: &mut String, family: &mut String| {
            change
                .parse::<Change>()
                .and_then(|change| change.apply(scene, Some(family)))
                .map_err(|error| error.to_string())
        };
        assert_eq!(apply("names.vectors.sun=(1, 0, 0)", &mut scene, &mut family), Ok(()));
        assert_eq!((scene.as_str(), family.as_str()), ("(version: 1)", "(names: (vectors: { \"sun\": (1, 0, 0) }))"));
        assert_eq!(apply("profile=Nv10", &mut scene, &mut family), Ok(()));
        assert_eq!(scene, "(profile: Nv10, version: 1)");
    }
}
