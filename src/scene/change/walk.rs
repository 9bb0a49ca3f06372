//! Follows the path of a change through a text.

use super::*;

/// The form of a value; `None` if it is not described.
type KnownForm = Option<fn() -> Form>;

/// Finds the place of a change in a text.
pub(super) fn find(text: &str, form: fn() -> Form, change: &Change) -> Result<Edit, Box<Diagnostic>> {
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
        parts: &[crate::notation::Part<'a>],
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
