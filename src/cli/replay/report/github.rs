//! Report for GitHub Actions: annotations on files, and a step summary.

use crate::replay::{Outcome, SceneReplay, Summary};
use ninebit::shown;

/// Number of annotations of one kind that GitHub keeps for a step.
const MAX_ANNOTATIONS: usize = 10;

/// Returns lines that GitHub Actions turns into annotations: an error for each scene that is not as expected, ten at most, because GitHub drops more.
pub(crate) fn annotations(all: &[SceneReplay]) -> String {
    let wrong: Vec<&SceneReplay> = all.iter().filter(|one| one.exit_code() != 0).collect();
    let shown = if wrong.len() > MAX_ANNOTATIONS { MAX_ANNOTATIONS - 1 } else { wrong.len() };
    let mut out: String = wrong.iter().take(shown).map(|one| annotation(one)).collect();
    if wrong.len() > shown {
        let message = format!("{} more scenes are not as expected; the log names them all", wrong.len() - shown);
        out += &format!("::error title=ninebit replay::{}\n", data(&message));
    }
    out
}

fn annotation(one: &SceneReplay) -> String {
    let place = match &one.outcome {
        Outcome::Failed(problem) => {
            problem.place.map_or(String::new(), |(line, column)| format!(",line={line},col={column}"))
        }
        _ => String::new(),
    };
    let (file, title) =
        (property(&shown::path(&one.path)), property(&format!("{} {}", shown::name(&one.name), one.status())));
    let messages: Vec<String> = std::iter::once(one.message())
        .chain(one.unwritten.iter().map(|problem| format!("{} {}", problem.code, shown::name(&problem.message))))
        .collect();
    let message = messages.into_iter().filter(|message| !message.is_empty()).collect::<Vec<_>>().join("\n");
    format!("::error file={file}{place},title={title}::{}\n", data(&message))
}

/// Escapes the message of a workflow command.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// Escapes a property of a workflow command.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

/// Returns the step summary as Markdown: the counts, and a table of the scenes that are not as expected.
pub(crate) fn step_summary(all: &[SceneReplay]) -> String {
    let mut out = format!("### ninebit replay\n\n{}\n", Summary::from_replays(all));
    let mut rows = all.iter().filter(|one| one.exit_code() != 0).peekable();
    if rows.peek().is_some() {
        out += "\n| scene | | what |\n|---|---|---|\n";
    }
    for one in rows {
        out += &format!("| {} | {} | {} |\n", cell(&one.name), one.status(), cell(&one.message()));
    }
    out
}

/// Escapes a name or message for a Markdown table: Markdown's special characters, and those from which GitHub makes links and mentions.
fn cell(text: &str) -> String {
    let mut out = String::new();
    for c in shown::name(text).chars() {
        match c {
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '&' => out += "&amp;",
            '\\' | '`' | '*' | '_' | '[' | ']' | '(' | ')' | '#' | '!' | '|' | '~' | ':' | '@' | '^' | '$' | '.' => {
                out.extend(['\\', c]);
            }
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_has_no_links_mentions_or_markup() {
        assert_eq!(cell("vectors/lit-stone"), "vectors/lit-stone");
        assert_eq!(cell("[a](http://b.c)"), r"\[a\]\(http\://b\.c\)");
        assert_eq!(cell("www.b.c @someone <b>|`"), r"www\.b\.c \@someone &lt;b&gt;\|\`");
        assert_eq!(cell("a\nb"), r"a\\nb");
    }
}
