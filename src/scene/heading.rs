//! Titles of scenes.

/// What the comment at the head of a scene says: `// Title: text`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heading {
    /// What stands before a colon, or the name of the file.
    pub title: String,
    /// The first sentence of the text.
    pub about: String,
}

impl Heading {
    /// Reads the comment. `file` is the name of the scene's file without its extension.
    pub fn new(text: &str, file: &str) -> Heading {
        let lines = text.lines().map_while(|line| line.trim_start().strip_prefix("//"));
        let comment = lines.map(str::trim).collect::<Vec<_>>().join(" ").replace('`', "");
        // A colon later on is one of a sentence.
        let named =
            comment.split_once(": ").filter(|(title, _)| !title.contains(['.', ',', ';', '(']) && title.len() <= 60);
        let (title, text) =
            named.map_or((file.replace(['-', '_'], " "), comment.as_str()), |(title, rest)| (title.to_owned(), rest));
        let first = text.split_inclusive(". ").next().unwrap_or_default();
        Heading { title: capital(&title), about: capital(first.trim()) }
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::Heading;

    #[test]
    fn headings() {
        let said = |text: &str| {
            let Heading { title, about } = Heading::new(text, "lit-stone");
            [title, about]
        };
        assert_eq!(said("// A ring: it is `lit`.\n// Twice. More.\n("), ["A ring", "It is lit."]);
        assert_eq!(said("// It is lit, as follows: twice.\n("), ["Lit stone", "It is lit, as follows: twice."]);
        assert_eq!(said("("), ["Lit stone", ""]);
    }
}
