//! Lays out values of a scene as text: on one line if they fit, otherwise a line for each part.

use crate::data::quote;
use ninebit::state::Named;

/// Longest line that several values share.
const WIDTH: usize = 120;

/// Columns by which the parts of a value stand further to the right.
const INDENT: usize = 4;

/// A value of a scene, before it has lines.
#[derive(Clone, Debug)]
pub(super) enum Node {
    /// A value without parts. It may have lines of its own.
    Plain(String),
    /// Values in brackets.
    Group(Group),
}

/// Values in brackets, behind a word.
#[derive(Clone, Debug)]
pub(super) struct Group {
    head: String,
    brackets: [char; 2],
    items: Vec<Item>,
    layout: Layout,
}

/// A value with what stands in front of it.
#[derive(Clone, Debug)]
struct Item {
    comments: Vec<String>,
    key: String,
    value: Node,
}

/// How a group that does not fit on a line is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    /// A line for each value, which may be divided in turn.
    Free,
    /// The same, even if the group would fit on one line.
    Tall,
    /// A line for each value, however long or short.
    Rows,
    /// As many values in each line as fit.
    Filled,
}

impl Node {
    pub(super) fn word(text: impl Into<String>) -> Node {
        Node::Plain(text.into())
    }

    pub(super) fn whole(value: impl Into<i64>) -> Node {
        Node::Plain(value.into().to_string())
    }

    /// Returns a text in quotes.
    pub(super) fn text(text: &str) -> Node {
        let mut out = String::new();
        quote(text, &mut out);
        Node::Plain(out)
    }

    /// Returns the shortest number that is read as the same float.
    pub(super) fn number(value: f32) -> Node {
        let text = format!("{value:?}");
        Node::Plain(text.strip_suffix(".0").map_or(text.clone(), str::to_owned))
    }

    /// Returns values in parentheses behind a word, which may be empty.
    pub(super) fn call(head: &str, values: impl IntoIterator<Item = Node>) -> Node {
        Node::group(head, ['(', ')'], values, Layout::Free)
    }

    pub(super) fn numbers(values: &[f32]) -> Node {
        Node::call("", values.iter().map(|value| Node::number(*value)))
    }

    pub(super) fn flags(values: &[bool]) -> Node {
        Node::call("", values.iter().map(|value| Node::word(value.to_string())))
    }

    /// Returns a colour of bytes.
    pub(super) fn color(color: [u8; 4]) -> Node {
        let written = if color[3] == 255 { &color[..3] } else { &color };
        Node::call("", written.iter().map(|byte| Node::whole(*byte)))
    }

    pub(super) fn list(values: impl IntoIterator<Item = Node>) -> Node {
        Node::group("", ['[', ']'], values, Layout::Free)
    }

    /// Returns a list with a line for each value.
    pub(super) fn rows(values: impl IntoIterator<Item = Node>) -> Node {
        Node::group("", ['[', ']'], values, Layout::Rows)
    }

    /// Returns a list with as many values in each line as fit.
    pub(super) fn filled(values: impl IntoIterator<Item = Node>) -> Node {
        Node::group("", ['[', ']'], values, Layout::Filled)
    }

    fn group(head: &str, brackets: [char; 2], values: impl IntoIterator<Item = Node>, layout: Layout) -> Node {
        let items = values.into_iter().map(|value| Item { comments: vec![], key: String::new(), value }).collect();
        Node::Group(Group { head: head.to_owned(), brackets, items, layout })
    }

    /// Returns the text on one line.
    pub(super) fn flat(&self) -> String {
        let mut out = String::new();
        self.flatten(&mut out);
        out
    }

    fn flatten(&self, out: &mut String) {
        match self {
            Node::Plain(text) => out.push_str(text),
            Node::Group(group) => group.flatten(out),
        }
    }

    /// Returns what is left of `room` columns behind the text on one line; `None` if it has to be divided.
    fn fits(&self, room: usize) -> Option<usize> {
        match self {
            Node::Plain(text) if text.contains('\n') => None,
            Node::Plain(text) => room.checked_sub(text.len()),
            Node::Group(group) => group.fits(room),
        }
    }

    /// Writes the value, which begins in a column. Its further lines stand `indent` columns to the right.
    pub(super) fn write(&self, out: &mut String, indent: usize, column: usize) {
        match self {
            Node::Plain(text) => out.push_str(&text.replace('\n', &line(indent))),
            Node::Group(group) => group.write(out, indent, column),
        }
    }
}

impl Group {
    fn flatten(&self, out: &mut String) {
        out.push_str(&self.head);
        out.push(self.brackets[0]);
        for (n, item) in self.items.iter().enumerate() {
            out.push_str(if n > 0 { ", " } else { "" });
            out.push_str(&item.key);
            item.value.flatten(out);
        }
        out.push(self.brackets[1]);
    }

    fn fits(&self, room: usize) -> Option<usize> {
        let divided = self.layout == Layout::Tall || self.layout == Layout::Rows && self.items.len() > 1;
        let around = room.checked_sub(self.head.len() + 2).filter(|_| !divided)?;
        self.items.iter().enumerate().try_fold(around, |room, (n, item)| {
            let before = item.key.len() + if n > 0 { 2 } else { 0 };
            item.value.fits(room.checked_sub(before)?).filter(|_| item.comments.is_empty())
        })
    }

    fn write(&self, out: &mut String, indent: usize, column: usize) {
        // A comma and a bracket may follow.
        if self.fits(WIDTH.saturating_sub(column + 2)).is_some() {
            return self.flatten(out);
        }
        out.push_str(&self.head);
        out.push(self.brackets[0]);
        match &self.items[..] {
            // The brackets of a single value share its lines.
            [Item { comments, key, value: Node::Group(inside) }]
                if comments.is_empty() && key.is_empty() && self.layout != Layout::Rows =>
            {
                inside.write(out, indent, column + self.head.len() + 1);
            }
            _ => {
                self.write_items(out, indent + INDENT);
                out.push_str(&line(indent));
            }
        }
        out.push(self.brackets[1]);
    }

    fn write_items(&self, out: &mut String, indent: usize) {
        let mut column = usize::MAX;
        for item in &self.items {
            for comment in &item.comments {
                out.push_str(&line(indent));
                out.push_str(&commented(comment));
            }
            let before = indent + item.key.len();
            match self.layout {
                Layout::Filled => {
                    let text = item.value.flat();
                    if column.saturating_add(text.len() + 2) > WIDTH {
                        out.push_str(&line(indent));
                        column = indent;
                    } else {
                        out.push(' ');
                        column += 1;
                    }
                    out.push_str(&text);
                    column += text.len() + 1;
                }
                _ => {
                    out.push_str(&line(indent));
                    out.push_str(&item.key);
                    if self.layout == Layout::Rows {
                        item.value.flatten(out);
                    } else {
                        item.value.write(out, indent, before);
                    }
                }
            }
            out.push(',');
        }
    }
}

/// Returns the end of a line and the beginning of the next.
fn line(indent: usize) -> String {
    format!("\n{}", " ".repeat(indent))
}

/// Returns a line of a comment. Line ends in it, which would end the comment, are spaces.
pub(super) fn commented(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("// {text}").trim_end().to_owned()
}

/// Fields in parentheses, or entries of a table.
#[derive(Clone, Debug)]
pub(super) struct Fields(Group);

impl Fields {
    /// Begins fields behind a word, which may be empty.
    pub(super) fn new(head: &str) -> Fields {
        Fields(Group { head: head.to_owned(), brackets: ['(', ')'], items: vec![], layout: Layout::Free })
    }

    /// Begins the entries of a table.
    pub(super) fn table() -> Fields {
        Fields(Group { brackets: ['{', '}'], ..Fields::new("").0 })
    }

    /// Gives each field a line of its own.
    pub(super) fn tall(mut self) -> Fields {
        self.0.layout = Layout::Tall;
        self
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.items.is_empty()
    }

    pub(super) fn put(&mut self, name: &str, value: impl Into<Node>) {
        let (key, value) = (format!("{name}: "), value.into());
        self.0.items.push(Item { comments: vec![], key, value });
    }

    /// Adds a field whose value has fields or entries, unless it has none.
    pub(super) fn put_some(&mut self, name: &str, value: Fields) {
        if !value.is_empty() {
            self.put(name, value);
        }
    }

    /// Adds the fields of another value behind these.
    pub(super) fn append(&mut self, other: Fields) {
        self.0.items.extend(other.0.items);
    }

    /// Adds an entry of a table.
    pub(super) fn entry(&mut self, name: &str, value: impl Into<Node>) {
        self.put(&Node::text(name).flat(), value);
    }

    /// Adds a field unless it has its default.
    pub(super) fn word<T: Named>(&mut self, name: &str, value: T, default: T) {
        if value != default {
            self.put(name, Node::word(value.name()));
        }
    }

    /// Adds a flag unless it has its default.
    pub(super) fn flag(&mut self, name: &str, value: bool, default: bool) {
        if value != default {
            self.put(name, Node::word(value.to_string()));
        }
    }

    /// Adds a whole number unless it has its default.
    pub(super) fn whole(&mut self, name: &str, value: impl Into<i64>, default: i64) {
        let value = value.into();
        if value != default {
            self.put(name, Node::whole(value));
        }
    }

    /// Adds a number unless it has the bits of its default.
    pub(super) fn number(&mut self, name: &str, value: f32, default: f32) {
        if value.to_bits() != default.to_bits() {
            self.put(name, Node::number(value));
        }
    }

    /// Adds a colour unless it has its default.
    pub(super) fn color(&mut self, name: &str, value: [u8; 4], default: [u8; 4]) {
        if value != default {
            self.put(name, Node::color(value));
        }
    }
}

impl From<Fields> for Node {
    fn from(fields: Fields) -> Node {
        Node::Group(fields.0)
    }
}

/// Makes a list of values, each with the lines of a comment above it.
pub(super) fn commented_list(values: impl IntoIterator<Item = (Vec<String>, Node)>) -> Node {
    let items = values.into_iter().map(|(comments, value)| Item { comments, key: String::new(), value }).collect();
    Node::Group(Group { head: String::new(), brackets: ['[', ']'], items, layout: Layout::Free })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laid_out(node: &Node) -> String {
        let mut out = String::new();
        node.write(&mut out, 0, 0);
        out
    }

    #[test]
    fn values_that_fit_share_a_line() {
        let mut fields = Fields::new("Solid");
        fields.whole("width", 4, 1);
        fields.whole("height", 1, 1);
        fields.color("color", [1, 2, 3, 255], [0; 4]);
        assert_eq!(laid_out(&fields.into()), "Solid(width: 4, color: (1, 2, 3))");
    }

    #[test]
    fn others_are_divided() {
        let long = |n: usize| Node::text(&"x".repeat(n));
        let list = laid_out(&Node::call("Window", [Node::list([long(70), long(70)])]));
        assert_eq!(list, format!("Window([\n    \"{0}\",\n    \"{0}\",\n])", "x".repeat(70)));
        let filled = laid_out(&Node::filled((0..60).map(|n: i32| Node::whole(n))));
        assert!(filled.lines().count() == 4 && filled.lines().all(|line| line.len() <= WIDTH), "{filled}");
        let rows = laid_out(&Node::rows([Node::list([long(70), long(70)])]));
        assert_eq!(rows.lines().count(), 3, "{rows}");
    }

    #[test]
    fn numbers_are_read_as_the_same_float() {
        let texts = [0.0, -0.0, 1.0, 0.1, 1e30, f32::MIN_POSITIVE, f32::INFINITY].map(|n| Node::number(n).flat());
        assert_eq!(texts, ["0", "-0", "1", "0.1", "1e30", "1.1754944e-38", "inf"]);
        for n in 0..100_000_u32 {
            let value = f32::from_bits(n.wrapping_mul(0x9e37_79b1));
            if !value.is_nan() {
                assert_eq!(Node::number(value).flat().parse::<f32>().unwrap().to_bits(), value.to_bits());
            }
        }
    }

    #[test]
    fn a_comment_stays_one() {
        assert_eq!(commented("a\nb "), "// a b");
        let list = commented_list([(vec!["first".to_owned()], Node::whole(1)), (vec![], Node::whole(2))]);
        assert_eq!(laid_out(&list), "[\n    // first\n    1,\n    2,\n]");
    }
}
