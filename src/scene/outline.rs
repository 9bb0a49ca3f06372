//! Represents a scene's text as a tree of values with their places, so that a program can change one value and leave all other text as it is.
//!
//! What each value may be is taken from the types of a scene, which tell their `Form`. The text is split at its brackets, as the reader
//! does. A value that is written in an unusual way becomes one value without parts.

use super::fields as source;
pub use super::form::Kind;
use super::form::{Entry, Form, HasForm, forms};
use super::notation::Notation;
use super::raw::Raw;
use super::source::renamed;
use ninebit::place::Span;

/// Largest number of values in a tree: nobody wants a form for each vertex of a large mesh.
const MAX_VALUES: usize = 4000;

/// A node of the tree: a value in a scene's text.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The name of the field, the key, or the index in its list.
    pub label: String,
    /// Range of bytes in the text.
    pub span: Span,
    /// What the value is.
    pub content: Content,
}

/// Content of a [`Node`].
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// A value without parts.
    Value(Kind),
    /// A value with parts.
    Group {
        /// The parts in order.
        parts: Vec<Node>,
        /// Names and kinds of the fields that are not written.
        absent: Vec<(&'static str, Kind)>,
        /// The texts before and after `field: value` when one of these fields is added to the group.
        around: [String; 2],
    },
}

/// Makes the tree of a scene's text. Of a text that is not a scene, the tree holds what can be recognised.
pub fn outline(text: &str) -> Node {
    let mut notation = Notation::new(text);
    // A text that is not well formed is one value.
    let scene = notation.check(0..text.len(), usize::MAX).unwrap_or(text);
    Walker { notation, left: MAX_VALUES }.node("scene".to_owned(), scene, source::Scene::form())
}

impl Node {
    /// Returns the part at the end of a path of labels.
    pub fn at(&self, path: &[&str]) -> Option<&Node> {
        let Some((first, rest)) = path.split_first() else { return Some(self) };
        let Content::Group { parts, .. } = &self.content else { return None };
        parts.iter().find(|part| part.label == *first)?.at(rest)
    }
}

struct Walker<'a> {
    notation: Notation<'a>,
    left: usize,
}

impl<'a> Walker<'a> {
    fn node(&mut self, label: String, text: &'a str, form: Form) -> Node {
        self.left = self.left.saturating_sub(1);
        let content = self.content(text, form);
        Node { label, span: self.notation.range(text), content }
    }

    fn content(&mut self, text: &'a str, form: Form) -> Content {
        let other = Content::Value(Kind::Other);
        let numbered = |items: Vec<&'a str>| items.into_iter().enumerate().map(|(n, item)| (n.to_string(), item));
        match form {
            Form::Value(kind) => Content::Value(kind),
            Form::List(of) | Form::Tuple(of) => {
                let open = if matches!(form, Form::List(_)) { b'[' } else { b'(' };
                self.notation.items(text, open).map_or(other, |items| self.group(numbered(items), |_| Some(of)))
            }
            Form::Table(of) => {
                let Some(entries) = self.notation.entries(text, b'{') else { return other };
                let named = entries.into_iter().map(|(key, value)| (key.trim_matches('"').to_owned(), value));
                self.group(named, |_| Some(of))
            }
            Form::Fields(fields) => self.fields(text, &fields()).unwrap_or(other),
            Form::Variant(variants) => {
                let (head, rest) = Raw::<()>::new(text).split();
                let Some((name, of)) = variants.iter().find(|(name, _)| *name == head) else { return other };
                // In `Window([...])` the parentheses hold one value; in `Matrix(...)` they belong to the fields.
                let inside = match of() {
                    Form::Fields(_) => Some(rest),
                    _ => self.notation.items(rest, b'(').and_then(|items| items.first().copied()),
                };
                let Some(inside) = inside else { return other };
                let part = self.node((*name).to_owned(), inside, of());
                Content::Group { parts: vec![part], absent: Vec::new(), around: Default::default() }
            }
            Form::OrName(of, field) => {
                if !Raw::<()>::new(text).is_text() {
                    return self.content(text, of());
                }
                let (Form::Fields(fields), Some(field)) = (of(), field) else { return Content::Value(Kind::Text) };
                let absent = values(fields().into_iter().filter(|(name, _)| *name != field));
                Content::Group { parts: Vec::new(), absent, around: [format!("({field}: {text}, "), ")".to_owned()] }
            }
        }
    }

    fn fields(&mut self, text: &'a str, fields: &[Entry]) -> Option<Content> {
        let written = self.notation.entries(text, b'(')?;
        let missing = fields.iter().filter(|(name, _)| !written.iter().any(|(written, _)| renamed(written) == *name));
        let absent = values(missing.copied());
        let (open, rest) = text.split_at(1);
        let around = [open.to_owned(), if written.is_empty() { rest.to_owned() } else { format!(", {rest}") }];
        let form = |name: &str| fields.iter().find(|(field, _)| *field == renamed(name)).map(|(_, form)| *form);
        let named = written.into_iter().map(|(name, value)| (name.to_owned(), value));
        let Content::Group { parts, .. } = self.group(named, form) else { return None };
        Some(Content::Group { parts, absent, around })
    }

    fn group(
        &mut self,
        items: impl Iterator<Item = (String, &'a str)>,
        form: impl Fn(&str) -> Option<fn() -> Form>,
    ) -> Content {
        let mut parts = Vec::new();
        for (label, item) in items {
            if self.left == 0 {
                break;
            }
            let form = form(&label).map_or(Form::Value(Kind::Other), |form| form());
            parts.push(self.node(label, item, form));
        }
        Content::Group { parts, absent: Vec::new(), around: Default::default() }
    }
}

/// Returns those of the fields whose values have no parts and may be offered to be added.
fn values(fields: impl Iterator<Item = Entry>) -> Vec<(&'static str, Kind)> {
    let value = |(name, form): Entry| match form() {
        Form::Value(kind @ (Kind::Color | Kind::Whole { .. } | Kind::Number | Kind::Choice(_))) => Some((name, kind)),
        _ => None,
    };
    fields.filter_map(value).collect()
}

forms! {
    source::Color => Form::Value(Kind::Color);
    source::VertexSource => Form::Variant(&[
        ("Window", source::VertexList::form),
        ("Matrix", source::MatrixVertices::form),
        ("Program", source::ProgramVertices::form),
    ]);
    source::VertexList => Form::List(source::Vertex::form);
    source::Program => Form::Variant(&[("Combiners", source::Combiners::form)]);
    source::BlendSource => Form::OrName(source::Blend::form, None);
    source::Unit => Form::OrName(source::UnitState::form, Some("texture"));
    source::Matrix, source::MeshSource, source::ImageSource, source::ShaderStage, source::ShaderOperation,
    source::Attribute, source::ShaderConstant, source::CoordinateSource, source::Generator, source::Input, source::FinalInput,
    source::Output, source::NormalSource, source::StageArgument, source::TransformFlags, source::Word, source::ViewerWord, source::AlphaReference => Form::Value(Kind::Other);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse;
    use ninebit::limits::Limits;
    use std::path::Path;

    const SCENE: &str = r#"// A comment.
(version: 1, profile: Nv10,
    targets: [(name: "frame", width: 8, height: 8, format: R5G6B5)],
    textures: { "t": (source: Solid(width: 8, height: 8, color: (1, 2, 3))) },
    names: (blends: { "over": (source: SourceAlpha, destination: OneMinusSourceAlpha) }),
    draws: [(
        name: "one", /* here */ textures: ["t"], blend: "over",
        vertices: Window([(position: (0, 0), diffuse: (255, 0, 0)), (position: (8, 0)), (position: (0, 8))]),
        program: Combiners(constants: ((1, 2, 3, 4),), stages: [(rgb: (a: Texture0, ab: Spare0))], final_combiner: (a: Spare0)),
    )],
)"#;

    #[test]
    fn values_know_their_places_and_forms() {
        let tree = outline(SCENE);
        let read = |path: &[&str]| {
            let node = tree.at(path).unwrap_or_else(|| panic!("no {path:?}"));
            (&SCENE[node.span.clone()], node.content.clone())
        };
        assert_eq!(read(&["draws", "0", "vertices", "Window", "0", "diffuse"]).0, "(255, 0, 0)");
        assert_eq!(read(&["draws", "0", "program", "Combiners", "constants", "0"]).1, Content::Value(Kind::Color));
        let (format, Content::Value(Kind::Choice(words))) = read(&["targets", "0", "format"]) else {
            panic!("a choice")
        };
        assert_eq!((format, words.contains(&"X8R8G8B8O")), ("R5G6B5", true));
        // Fields cannot be added to the name of a blend.
        assert_eq!(read(&["draws", "0", "blend"]), ("\"over\"", Content::Value(Kind::Text)));
        assert_eq!(read(&["textures", "t", "source"]).0, "Solid(width: 8, height: 8, color: (1, 2, 3))");
    }

    /// Every field that is offered can be added, both to a group and to a unit that is only a name.
    #[test]
    fn fields_are_added_where_they_are_not_written() {
        let tree = outline(SCENE);
        for (path, field) in [
            (&["draws", "0", "textures", "0"][..], "mag_filter: Linear"),
            (&["draws", "0", "vertices", "Window", "1"], "diffuse: (0, 0, 9)"),
            (&["draws", "0"], "dither: false"),
            (&["targets", "0"], "depth: Z16"),
        ] {
            let node = tree.at(path).unwrap_or_else(|| panic!("no {path:?}"));
            let Content::Group { absent, around: [before, behind], .. } = &node.content else { panic!("a group") };
            assert!(absent.iter().any(|(name, _)| field.starts_with(&format!("{name}:"))), "{path:?}: {absent:?}");
            let mut text = SCENE.to_owned();
            text.replace_range(node.span.clone(), &format!("{before}{field}{behind}"));
            parse(&text, Path::new(""), &Limits::default()).unwrap_or_else(|error| panic!("{text}\n{error}"));
        }
    }

    #[test]
    fn what_is_no_scene_is_one_value() {
        for text in ["", "(", "nothing", "(version: 'a')", "(a: (b: ]"] {
            assert!(outline(text).span.end <= text.len());
        }
    }
}
