//! Translates the text that C and GLSL share into WGSL. The text keeps to what this reads: one statement, or the head of a block, a line; bodies of
//! cases end in `break` or `return`; arrays are passed as a whole; parameters are not assigned, but for arrays.

use super::translation::{pieces_of, top_level};

/// The kinds of values, as the text and WGSL write them.
const KINDS: [(&str, &str); 6] = [
    ("@uint", "u32"),
    ("@int", "i32"),
    ("int", "i32"),
    ("@long", "vec2<u32>"),
    ("@binary", "vec2<i32>"),
    ("@given", "NinebitInputs"),
];

/// Parameters that stand for others.
const PARAMETERS: [(&str, &str); 4] = [
    ("@registers", "r: ptr<function, array<vec4<i32>, 16>>"),
    ("@changed", "r: ptr<function, array<vec4<i32>, 16>>"),
    ("@inputs", "inputs: ptr<function, NinebitInputs>"),
    ("@surface", "word: ptr<function, u32>, depth: ptr<function, u32>"),
];

/// What is known at a line.
#[derive(Default)]
struct Translation {
    /// Arrays that the function declares: it passes them by pointer.
    arrays: Vec<String>,
    /// Labels that wait for their statements.
    labels: Vec<String>,
    /// Open switches: the depth of their braces, and whether they have a default.
    switches: Vec<(i32, bool)>,
    depth: i32,
    is_struct: bool,
    is_comment: bool,
}

/// Translates a text.
pub(super) fn translated(text: &str) -> String {
    let mut translation = Translation::default();
    text.lines().map(|line| translation.line(line)).collect()
}

/// Splits `TYPE rest` into the type in WGSL and the rest.
fn kind(text: &str) -> Option<(&'static str, &str)> {
    KINDS.iter().find_map(|(name, kind)| Some((*kind, text.strip_prefix(name)?.strip_prefix(' ')?)))
}

/// Returns name and type of `name` or `name[2][3]`.
fn typed(kind: &str, declared: &str) -> (String, String) {
    let mut parts = declared.trim().split('[');
    let name = parts.next().unwrap_or_default().to_string();
    let sizes: Vec<&str> = parts.map(|size| size.trim_end_matches(']')).collect();
    (name, sizes.iter().rev().fold(kind.to_string(), |of, size| format!("array<{of}, {size}>")))
}

/// Splits `(inside) rest`.
fn parenthesised(text: &str) -> (&str, &str) {
    let inside = text.strip_prefix('(').unwrap_or(text);
    let end = top_level(inside, ')').next().unwrap_or(inside.len());
    (&inside[..end], inside.get(end + 1..).unwrap_or_default().trim())
}

fn parameter(text: &str) -> String {
    let text = text.trim();
    if let Some((_, other)) = PARAMETERS.iter().find(|(name, _)| *name == text) {
        return other.to_string();
    }
    let plain = ["@in ", "@out ", "@both "].iter().fold(text, |text, way| text.strip_prefix(way).unwrap_or(text));
    let Some((kind, declared)) = kind(plain) else { return String::new() };
    let (name, of) = typed(kind, declared);
    if declared.contains('[') { format!("{name}: ptr<function, {of}>") } else { format!("{name}: {of}") }
}

impl Translation {
    fn line(&mut self, line: &str) -> String {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        if self.is_comment || code.starts_with("/*") {
            self.is_comment = !code.contains("*/");
            return format!("{line}\n");
        }
        // Rules may stand before `break`, names of cases behind it.
        let from = code.rfind("break;").unwrap_or(0);
        let at = ["/*", "// "].iter().find_map(|start| code[from..].find(start)).map_or(code.len(), |at| from + at);
        let (code, comment) = code.split_at(at);
        let translated = self.statement(code.trim_end());
        let space = if comment.is_empty() || translated.is_empty() { "" } else { " " };
        let line = format!("{indent}{translated}{space}{comment}");
        if code.is_empty() || line != indent { line + "\n" } else { String::new() }
    }

    /// Translates one statement, or the head of a block.
    fn statement(&mut self, code: &str) -> String {
        if code.starts_with("case ") || code.starts_with("default:") {
            return self.labelled(code);
        }
        if !self.labels.is_empty() && !code.is_empty() {
            return self.case(code);
        }
        if let Some(rest) = code.strip_prefix("struct ") {
            self.is_struct = true;
            return format!("struct {rest}");
        }
        if self.is_struct {
            let Some((kind, declared)) = kind(code) else {
                self.is_struct = code != "};";
                return code.replace("};", "}");
            };
            let members = pieces_of(declared.trim_end_matches(';'), ',').map(|member| typed(kind, member));
            return members.map(|(name, of)| format!("{name}: {of},")).collect::<Vec<_>>().join(" ");
        }
        if let Some(header) = ["@flatten@public ", "@public ", "@fn "].iter().find_map(|way| code.strip_prefix(way)) {
            return self.header(header);
        }
        for head in ["if ", "while ", "} else if "] {
            if let Some(rest) = code.strip_prefix(head) {
                let (condition, body) = parenthesised(rest);
                return format!("{head}{} {}", self.addressed(condition), self.block(body, head.starts_with('}')));
            }
        }
        if let Some(rest) = code.strip_prefix("for ") {
            let (head, body) = parenthesised(rest);
            let parts: Vec<String> = head.split(';').map(|part| self.statement(part.trim())).collect();
            return format!("for ({}) {}", parts.join("; "), self.block(body, false));
        }
        if let Some(rest) = code.strip_prefix("switch ") {
            self.depth += 1;
            self.switches.push((self.depth, false));
            return format!("switch {} {{", parenthesised(rest).0);
        }
        if let Some(rest) = code.strip_suffix("break;") {
            self.depth -= 1;
            return (self.statement(rest.trim_end()) + " }").trim_start().to_string();
        }
        if let Some(declarations) = self.declarations(code) {
            return declarations;
        }
        if code == "}" && self.switches.last().is_some_and(|(depth, _)| *depth == self.depth) {
            let default = self.switches.pop().is_some_and(|(_, has_default)| has_default);
            self.depth -= 1;
            return if default { "}" } else { "default: {} }" }.to_string();
        }
        self.depth += code.matches('{').count() as i32 - code.matches('}').count() as i32;
        self.addressed(code)
    }

    fn header(&mut self, text: &str) -> String {
        self.arrays.clear();
        let (kind, text) = kind(text).map_or(("", text), |(kind, rest)| (kind, rest));
        let (name, rest) = text.trim_start_matches("void ").split_once('(').unwrap_or((text, ""));
        let (parameters, body) = parenthesised(rest);
        let parameters: Vec<String> = pieces_of(parameters, ',').map(parameter).filter(|one| !one.is_empty()).collect();
        let yields = if kind.is_empty() { String::new() } else { format!(" -> {kind}") };
        let body = body.strip_prefix("{ ").map_or(String::new(), |body| format!(" {{ {}", self.addressed(body)));
        format!("fn {name}({}){yields}{body}", parameters.join(", "))
    }

    /// Translates what follows a head: a brace, or one statement.
    fn block(&mut self, body: &str, closes: bool) -> String {
        if body != "{" {
            return format!("{{ {} }}", self.statement(body));
        }
        self.depth += i32::from(!closes);
        body.to_string()
    }

    /// Translates labels, and what follows them in their line.
    fn labelled(&mut self, code: &str) -> String {
        let Some((label, rest)) = code.split_once(':') else { return String::new() };
        self.labels.push(label.trim_start_matches("case ").to_string());
        self.statement(rest.trim_start())
    }

    /// Opens a case by its first statement, which also closes it if it returns.
    fn case(&mut self, code: &str) -> String {
        let labels = std::mem::take(&mut self.labels);
        if let Some((_, has_default)) = self.switches.last_mut() {
            *has_default |= labels.iter().any(|label| label == "default");
        }
        self.depth += 1;
        let end = if code.starts_with("return ") { " break;" } else { "" };
        format!("case {}: {{ {}", labels.join(", "), self.statement(&format!("{code}{end}")))
    }

    /// Translates declarations.
    fn declarations(&mut self, code: &str) -> Option<String> {
        if code == "@registers;" {
            self.arrays.push("r".to_string());
            return Some("var r: array<vec4<i32>, 16>;".to_string());
        }
        let (word, rest) = code.strip_prefix("@in ").map_or(("var", code), |rest| ("let", rest));
        let (kind, declared) = kind(rest)?;
        let end = if declared.ends_with(';') { ";" } else { "" };
        let one = |text: &str| {
            let (declared, value) = text.split_once(" = ").map_or((text, None), |(name, value)| (name, Some(value)));
            let (name, of) = typed(kind, declared);
            if declared.contains('[') || kind == "NinebitInputs" {
                self.arrays.push(name.clone());
            }
            let value = value.map(|value| format!(" = {}", self.addressed(value))).unwrap_or_default();
            format!("{word} {name}: {of}{value}{end}")
        };
        Some(pieces_of(declared.trim_end_matches(';'), ',').map(one).collect::<Vec<_>>().join(" "))
    }

    /// Passes the function's arrays by pointer.
    fn addressed(&self, code: &str) -> String {
        self.arrays.iter().fold(code.to_string(), |mut code, name| {
            for (before, after) in [("(", ","), ("(", ")"), (", ", ","), (", ", ")")] {
                code = code.replace(&format!("{before}{name}{after}"), &format!("{before}&{name}{after}"));
            }
            code
        })
    }
}
