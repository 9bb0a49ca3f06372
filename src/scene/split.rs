//! Takes brackets apart without reading what is in them.
//!
//! The whole text has gone through the parser once, so what stands between brackets is known to be well formed. Taking it apart
//! again at every level is cheap here and dear there. Anything unusual gives `None`, and the parser does it after all.

use super::raw::trim;

/// The parts, at the commas, of a text in brackets.
pub(super) fn items(text: &str, open: u8, close: u8) -> Option<Vec<&str>> {
    let bytes = text.as_bytes();
    if bytes.first() != Some(&open) {
        return None;
    }
    let (mut items, mut depth, mut at) = (Vec::new(), 0usize, 0);
    // Of the current part: where it starts, and where the last of it that is neither white space nor comment ends.
    let (mut start, mut end) = (1, 1);
    loop {
        match *bytes.get(at)? {
            b'"' => {
                at = string_end(bytes, at)?;
                end = at;
                continue;
            }
            b'/' => {
                let rest = trim(&text[at..]);
                let after = text.len() - rest.len();
                if after == at {
                    return None;
                }
                at = after;
                continue;
            }
            // Characters: left to the parser.
            b'\'' => return None,
            b'r' if matches!(bytes.get(at + 1), Some(b'"' | b'#')) => {
                at = raw_end(text, at)?;
                end = at;
                continue;
            }
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    break;
                }
            }
            b',' if depth == 1 => {
                items.push(part(text, start, end)?);
                (start, end) = (at + 1, at + 1);
                at += 1;
                continue;
            }
            b' ' | b'\t' | b'\r' | b'\n' => {
                at += 1;
                continue;
            }
            _ => {}
        }
        at += 1;
        if depth > 1 || at > 1 {
            end = at;
        }
    }
    if bytes[at] != close || !trim(&text[at + 1..]).is_empty() {
        return None;
    }
    if let Some(last) = part(text, start, end) {
        items.push(last);
    }
    Some(items)
}

/// A part without white space and comments around it; `None` if there is nothing else.
fn part(text: &str, start: usize, end: usize) -> Option<&str> {
    let part = trim(text.get(start..end.max(start))?);
    (!part.is_empty()).then_some(part)
}

/// The place behind the text in quotes that starts at `at`.
fn string_end(bytes: &[u8], mut at: usize) -> Option<usize> {
    at += 1;
    loop {
        match bytes.get(at)? {
            b'"' => return Some(at + 1),
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
}

/// The place behind the raw text, `r#"..."#` with any number of signs, whose `r` is at `at`.
fn raw_end(text: &str, at: usize) -> Option<usize> {
    let before = at.checked_sub(1).and_then(|before| text.as_bytes().get(before));
    if before.is_some_and(|byte| byte.is_ascii_alphanumeric() || *byte == b'_') {
        return None;
    }
    let signs = text[at + 1..].bytes().take_while(|byte| *byte == b'#').count();
    let inside = at + 1 + signs + 1;
    if text.as_bytes().get(inside - 1) != Some(&b'"') {
        return None;
    }
    let close = format!("\"{}", "#".repeat(signs));
    Some(inside + text.get(inside..)?.find(&close)? + close.len())
}

/// Names and values of fields in parentheses.
pub(super) fn fields(text: &str) -> Option<Vec<(&str, &str)>> {
    items(text, b'(', b')')?
        .into_iter()
        .map(|item| {
            let (name, value) = item.split_once(':')?;
            let name = name.trim_end();
            let value = trim(value);
            let word = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
            // Options are the parser's matter.
            (word && !value.is_empty() && !value.starts_with("Some") && !value.starts_with("None"))
                .then_some((name, value))
        })
        .collect()
}

/// Keys in quotes and values of a table in braces.
pub(super) fn entries(text: &str) -> Option<Vec<(&str, &str)>> {
    items(text, b'{', b'}')?
        .into_iter()
        .map(|item| {
            let end = item.starts_with('"').then(|| string_end(item.as_bytes(), 0))??;
            let value = trim(trim(&item[end..]).strip_prefix(':')?);
            (!value.is_empty()).then_some((&item[..end], value))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_what_stands_between_commas() {
        let list = |text| items(text, b'[', b']');
        assert_eq!(list("[]"), Some(vec![]));
        assert_eq!(list("[ a , (b, c), \"d,]\\\"\" , ]"), Some(vec!["a", "(b, c)", "\"d,]\\\"\""]));
        assert_eq!(list("[/* x, */ a /* y] */, // z,\n b // w\n]"), Some(vec!["a", "b"]));
        assert_eq!(list("[a] // end"), Some(vec!["a"]));
        assert_eq!(list("[,]"), None);
        assert_eq!(list("[a] b"), None);
        assert_eq!(list("[a)"), None);
        assert_eq!(list("[a"), None);
        assert_eq!(list("['a']"), None);
        assert_eq!(list("[r\"a\\\", b, r#\"c], \"#, for]"), Some(vec!["r\"a\\\"", "b", "r#\"c], \"#", "for"]));
        assert_eq!(list("[r##\"a\"#, b]\"##]"), Some(vec!["r##\"a\"#, b]\"##"]));
        for broken in ["[r\"a]", "[r#\"a\"]", "[r#a]", "[xr\"a\"]", "[r#"] {
            assert_eq!(list(broken), None, "{broken}");
        }
    }

    #[test]
    fn fields_and_entries() {
        assert_eq!(fields("(a: 1, b : (c: 2),)"), Some(vec![("a", "1"), ("b", "(c: 2)")]));
        assert_eq!(fields("(a: None)"), None);
        assert_eq!(fields("(1, 2)"), None);
        assert_eq!(entries("{ \"a:\": 1, \"b\" : {} }"), Some(vec![("\"a:\"", "1"), ("\"b\"", "{}")]));
        assert_eq!(entries("{ a: 1 }"), None);
    }
}
