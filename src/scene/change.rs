//! Changes of a scene: a value is put at a path, `draws[0].program.constants[0]=(255, 128, 0, 255)`.
//!
//! A path names fields, indexes of lists and keys of tables. What a word says about a value, as `Combiners` in `Combiners(...)`, needs no step of its own.
//! A change is one of text: the value is written as in a scene file, and is read with the rest of the scene.

use std::str::FromStr;

use ninebit::diagnostic::{Diagnostic, Source};
use ninebit::place::Span;

use super::error::SceneError;
use super::fields as source;
use super::form::{Described, Form, Kind};
use super::notation::{Notation, trim, word};
use super::raw::Raw;
use super::source::renamed;
use super::wording::{closest, describe, shorten};

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

/// The form of a value; `None` if it is not described.
type KnownForm = Option<fn() -> Form>;

/// Finds the place of a change in a text.
fn find(text: &str, form: fn() -> Form, change: &Change) -> Result<Edit, Box<Diagnostic>> {
    let new = &change.text[change.value.clone()];
    let mut notation = Notation::new(text);
    let Ok(whole) = notation.check(0..text.len(), NESTING) else {
        // The reader says what is wrong with the text.
        return Ok(Edit { place: 0..0, text: String::new(), written: true });
    };
    let mut here = Here { value: whole, form: Some(form) };
    for (n, step) in change.steps.iter().enumerate() {
        let at = Walk { notation: &notation, change, number: n };
        match at.step(here, step)? {
            Next::Value(next) => here = next,
            Next::Absent(place, before, after, form) => {
                let value = at.nested(new, form)?;
                return Ok(Edit { place: place..place, text: format!("{before}{value}{after}"), written: false });
            }
            Next::Named(place, before, after, form) => {
                let value = at.nested(new, form)?;
                return Ok(Edit { place, text: format!("{before}{value}{after}"), written: true });
            }
        }
    }
    Ok(Edit { place: notation.range(here.value), text: new.to_owned(), written: true })
}

/// A value on the way.
struct Here<'a> {
    value: &'a str,
    form: KnownForm,
}

/// Where a step leads.
enum Next<'a> {
    /// To a value that is written.
    Value(Here<'a>),
    /// To a field that is not written: where it is to be inserted, the texts around the value, and its form.
    Absent(usize, String, String, KnownForm),
    /// Into a value that is only named: its range, the texts around the value of the field in its place, and that field's form.
    Named(Span, String, String, KnownForm),
}

struct Walk<'a, 'n> {
    notation: &'n Notation<'a>,
    change: &'n Change,
    number: usize,
}

impl<'a> Walk<'a, '_> {
    fn step(&self, here: Here<'a>, step: &Step) -> Result<Next<'a>, Box<Diagnostic>> {
        let Here { value, form } = here;
        let described = form.map(|form| form());
        if Raw::<()>::new(value).is_text() {
            return self.named(value, described, step);
        }
        let (head, rest) = word(value);
        if !head.is_empty() && !rest.is_empty() {
            let (inside, form) = self.variant(head, rest, described);
            if step.to == Label::Name(head.to_owned()) {
                return Ok(Next::Value(Here { value: inside, form }));
            }
            return self.step(Here { value: inside, form }, step);
        }
        let Some(bracket) = self.notation.parts(value) else {
            return Err(self.nowhere(step, format!("{} has no parts", describe(value)), None));
        };
        let names: Vec<&str> = bracket.parts.iter().filter_map(|part| part.name).collect();
        match &step.to {
            Label::Index(index) if names.is_empty() && bracket.open != b'{' => match bracket.parts.get(*index) {
                Some(part) => Ok(Next::Value(Here { value: part.value, form: element(described) })),
                None => {
                    let count = bracket.parts.len();
                    let message = format!("there is no value {index} here; there are {count}, numbered from 0");
                    Err(self.nowhere(step, message, None))
                }
            },
            Label::Index(_) => Err(self.nowhere(step, "this has names in place of numbers", listed(&names, ""))),
            Label::Name(name) if bracket.open == b'[' => {
                let called = |item: &&str| self.called(item).is_some_and(|text| text == *name);
                let items: Vec<&str> = bracket.parts.iter().map(|part| part.value).collect();
                match items.iter().find(|item| called(item)) {
                    Some(item) => Ok(Next::Value(Here { value: item, form: element(described) })),
                    None => {
                        let names: Vec<String> = items.iter().filter_map(|item| self.called(item)).collect();
                        let names: Vec<&str> = names.iter().map(String::as_str).collect();
                        let help = listed(&names, name).unwrap_or_else(|| "write an index, such as `[0]`".to_owned());
                        Err(self.nowhere(
                            step,
                            format!("nothing in this list is called `{}`", shorten(name)),
                            Some(help),
                        ))
                    }
                }
            }
            Label::Name(name) => self.field(value, &bracket.parts, bracket.open, name, described, step),
        }
    }

    /// Returns the value in `Head(value)`, and its form.
    fn variant(&self, head: &str, rest: &'a str, form: Option<Form>) -> (&'a str, KnownForm) {
        let known = match form {
            Some(Form::Variant(variants)) => variants.iter().find(|(name, _)| *name == head).map(|(_, form)| *form),
            _ => None,
        };
        // In `Window([...])` the parentheses hold one value; in `Matrix(...)` they belong to the fields.
        let only = match self.notation.items(rest, b'(').as_deref() {
            Some([only]) if only.starts_with(['[', '{', '(']) || !word(only).1.is_empty() => Some(*only),
            _ => None,
        };
        (only.unwrap_or(rest), known)
    }

    /// Returns the text of the field `name` of a value.
    fn called(&self, item: &'a str) -> Option<String> {
        let fields = self.notation.entries(item, b'(')?;
        let (_, value) = fields.iter().find(|(name, _)| *name == "name")?;
        Some(value.trim_matches('"').to_owned())
    }

    fn field(
        &self,
        value: &'a str,
        parts: &[super::notation::Part<'a>],
        open: u8,
        name: &str,
        form: Option<Form>,
        step: &Step,
    ) -> Result<Next<'a>, Box<Diagnostic>> {
        let table = open == b'{';
        let is =
            |written: &str| if table { written.trim_matches('"') == name } else { renamed(written) == renamed(name) };
        let fields = match form {
            Some(Form::Fields(fields)) => Some(fields()),
            Some(Form::OrName(of, _)) => match of() {
                Form::Fields(fields) => Some(fields()),
                _ => None,
            },
            _ => None,
        };
        let known = fields.as_ref().and_then(|fields| fields.iter().find(|(field, _)| *field == renamed(name)));
        if let Some(part) = parts.iter().find(|part| part.name.is_some_and(is)) {
            let form = if table { element(form) } else { known.map(|(_, form)| *form) };
            return Ok(Next::Value(Here { value: part.value, form }));
        }
        let written: Vec<&str> = parts.iter().filter_map(|part| part.name.map(|name| name.trim_matches('"'))).collect();
        let unnamed = parts.iter().any(|part| part.name.is_none());
        let all: Vec<&str> = fields.iter().flatten().map(|(name, _)| *name).collect();
        if unnamed || fields.is_some() && known.is_none() || fields.is_none() && !table {
            let names = if all.is_empty() { &written } else { &all };
            let message = format!("there is no `{}` here", shorten(name));
            return Err(self.nowhere(step, message, listed(names, name)));
        }
        let start = self.notation.range(value).start + 1;
        let before = if table { format!("\"{name}\": ") } else { format!("{}: ", renamed(name)) };
        let form = if table { element(form) } else { known.map(|(_, form)| *form) };
        Ok(Next::Absent(start, before, if parts.is_empty() { String::new() } else { ", ".to_owned() }, form))
    }

    /// Takes a step into a value that is only named.
    fn named(&self, value: &'a str, form: Option<Form>, step: &Step) -> Result<Next<'a>, Box<Diagnostic>> {
        let Label::Name(name) = &step.to else {
            return Err(self.nowhere(
                step,
                format!("{value} is a name"),
                Some("set the value that it stands for, under `names`".to_owned()),
            ));
        };
        if let Some(Form::OrName(of, Some(own))) = form
            && let Form::Fields(fields) = of()
        {
            let fields = fields();
            if let Some((_, form)) = fields.iter().find(|(field, _)| field == name) {
                let before = if own == name { format!("({own}: ") } else { format!("({own}: {value}, {name}: ") };
                return Ok(Next::Named(self.notation.range(value), before, ")".to_owned(), Some(*form)));
            }
            let names: Vec<&str> = fields.iter().map(|(field, _)| *field).collect();
            return Err(self.nowhere(step, format!("there is no `{}` here", shorten(name)), listed(&names, name)));
        }
        let help = "set the value that it stands for, under `names`".to_owned();
        Err(self.nowhere(step, format!("{} is a name", shorten(value)), Some(help)))
    }

    /// Returns the text of a value that is not written yet, inside the structures and tables that the rest of the path names.
    fn nested(&self, value: &str, mut form: KnownForm) -> Result<String, Box<Diagnostic>> {
        let (mut text, mut ends) = (String::new(), Vec::new());
        for step in &self.change.steps[self.number + 1..] {
            let Label::Name(name) = &step.to else {
                let help = Some("set the whole list".to_owned());
                return Err(self.nowhere(step, "the list is not written in the scene", help));
            };
            let described = match form.map(|form| form()) {
                Some(Form::OrName(of, _)) => Some(of()),
                described => described,
            };
            let (open, end) = match described {
                Some(Form::Table(of)) => {
                    form = Some(of);
                    (format!("{{ \"{name}\": "), " }")
                }
                Some(Form::Fields(fields)) => {
                    let fields = fields();
                    let Some((_, of)) = fields.iter().find(|(field, _)| *field == renamed(name)) else {
                        let names: Vec<&str> = fields.iter().map(|(field, _)| *field).collect();
                        let message = format!("there is no `{}` here", shorten(name));
                        return Err(self.nowhere(step, message, listed(&names, name)));
                    };
                    form = Some(*of);
                    (format!("({}: ", renamed(name)), ")")
                }
                None | Some(Form::Value(Kind::Other)) => {
                    form = None;
                    (format!("({name}: "), ")")
                }
                Some(_) => return Err(self.nowhere(step, "a value of this kind has no fields", None)),
            };
            text += &open;
            ends.push(end);
        }
        text += value;
        text.extend(ends.into_iter().rev());
        Ok(text)
    }

    fn nowhere(&self, step: &Step, message: impl Into<String>, help: Option<String>) -> Box<Diagnostic> {
        let help = help.unwrap_or_else(|| "the fields are in `docs/scene-format.md`".to_owned());
        Box::new(Diagnostic::error(NOWHERE, step.place.clone(), message).label("leads nowhere").help(help))
    }
}

/// Returns the form of the values of a list or table.
fn element(form: Option<Form>) -> KnownForm {
    match form {
        Some(Form::List(of) | Form::Tuple(of) | Form::Table(of)) => Some(of),
        _ => None,
    }
}

/// Returns advice that lists names, with the one that is like `name`; `None` if there is none.
fn listed(names: &[&str], name: &str) -> Option<String> {
    let list = names.iter().take(40).map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match closest(name, names.iter().copied()) {
        Some(meant) => Some(format!("did you mean `{meant}`? All of them: {list}")),
        None => (!names.is_empty()).then(|| format!("there are {list}")),
    }
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
