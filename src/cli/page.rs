//! The page of `ninebit inspect`: markup, style, scripts, the model as a WebAssembly module, and a scene, in one file that loads nothing else.
//!
//! Its scripts are modules in `src/cli/page`. A page that is opened from a file cannot import modules, so they are joined into one inline script. The
//! page's content security policy allows that script and that style by their hashes, WebAssembly, and nothing else.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::GzEncoder;
use maud::{Markup, PreEscaped, html};
use ninebit_handbook::{RULES, Rule};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::io::Read;

/// The markup, with placeholders for the other parts.
const MARKUP: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/style.css");
/// The scripts, each after those that it imports.
const MODULES: [&str; 11] = [
    include_str!("page/elements.js"),
    include_str!("page/model.js"),
    include_str!("page/view.js"),
    include_str!("page/strip.js"),
    include_str!("page/listing.js"),
    include_str!("page/program.js"),
    include_str!("page/readings.js"),
    include_str!("page/address.js"),
    include_str!("page/chain.js"),
    include_str!("page/change.js"),
    include_str!("page/main.js"),
];
/// The WebAssembly module that `src/web/build` makes from `src/web`.
const MODULE: &[u8] = include_bytes!("page/module.wasm.gz");

/// Returns the page with the given title, a scene's data and what all pages hold. It needs no other file.
pub(crate) fn page(title: &str, data: &Value, common: &Value) -> String {
    let script = joined();
    let policy = policy(&source_hash(&script));
    let parts = [
        format!("<style>{STYLE}</style>"),
        json_of(data),
        compressed(common),
        dense(MODULE),
        format!("<script>{script}</script>"),
    ];
    filled(&policy, title, parts)
}

/// Returns the page of a scene beside others: script, module and what all pages hold are in the file `shared`, which [`shared`] returns.
pub(crate) fn page_beside(title: &str, data: &Value, shared: &str) -> String {
    // A page that was opened from a file is of no origin that `'self'` could name.
    let policy = policy(&format!("'self' file: {}", source_hash(&joined())));
    let parts = [
        format!("<style>{STYLE}</style>"),
        json_of(data),
        String::new(),
        String::new(),
        format!("<script src=\"{shared}\"></script>"),
    ];
    filled(&policy, title, parts)
}

/// Returns the file that pages share. It puts their script into them, so that a second thread can be given its text.
pub(crate) fn shared(common: &Value) -> String {
    let text = |text: &str| json_of(&Value::from(text));
    format!(
        "\"use strict\";\ndocument.getElementById(\"common\").textContent = {};\ndocument.getElementById(\"module\").textContent = {};\ndocument.body.append(Object.assign(document.createElement(\"script\"), {{ textContent: {} }}));\n",
        text(&compressed(common)),
        text(&dense(MODULE)),
        text(&joined())
    )
}

fn policy(scripts: &str) -> String {
    format!(
        "default-src 'none'; script-src {scripts} 'wasm-unsafe-eval'; style-src {}; img-src blob: data:; worker-src blob:; base-uri 'none'; form-action 'none'",
        source_hash(STYLE)
    )
}

/// Returns JSON compressed and as a text, as the module is.
fn compressed(value: &Value) -> String {
    let text = value.to_string();
    let mut bytes = Vec::new();
    // Reading a text from memory into memory cannot fail.
    let _ = GzEncoder::new(text.as_bytes(), Compression::best()).read_to_end(&mut bytes);
    dense(&bytes)
}

/// Returns bytes as a text that ends no element and needs no escape in JSON: five characters for four bytes, where base64 takes five and a third.
/// The digits of base 85 are `(` to `|`, with `!` for `<`, `#` for `\` and `$` for `{`; of k bytes at the end stand k + 1 digits. `denseBytes` of the page reads it.
fn dense(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len() / 4 * 5 + 5);
    for part in bytes.chunks(4) {
        let mut word = [0; 4];
        word[..part.len()].copy_from_slice(part);
        let word = u32::from_be_bytes(word);
        for place in [52_200_625, 614_125, 7_225, 85, 1].into_iter().take(part.len() + 1) {
            text.push(match 40 + (word / place % 85) as u8 {
                b'<' => '!',
                b'\\' => '#',
                b'{' => '$',
                digit => char::from(digit),
            });
        }
    }
    text
}

/// Returns JSON that cannot end its element.
fn json_of(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c")
}

/// Fills the markup: style, data, common data, module, script.
fn filled(policy: &str, title: &str, [style, data, common, module, script]: [String; 5]) -> String {
    let parts = [
        ("policy", policy.to_owned()),
        ("title", format!("{} - Ninebit", escaped(title))),
        ("style", style),
        ("data", data),
        ("common", common),
        ("module", module),
        ("script", script),
    ];
    let mut page = String::with_capacity(3 << 20);
    let mut rest = MARKUP;
    for (name, text) in &parts {
        let (before, after) = rest.split_once(&format!("{{{{{name}}}}}")).unwrap_or((rest, ""));
        page.push_str(before);
        page.push_str(text);
        rest = after;
    }
    page + rest
}

/// Returns the head of a page with its policy, its title and its inline style.
pub(crate) fn head(policy: &str, title: &str, style: &str) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta http-equiv="Content-Security-Policy" content=(policy);
            meta name="viewport" content="width=device-width, initial-scale=1";
            meta name="color-scheme" content="light dark";
            title { (title) }
            style { (PreEscaped(style)) }
        }
    }
}

/// Returns the hash of an inline script or style as a content security policy names it.
pub(crate) fn source_hash(text: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text.as_bytes())))
}

/// Joins the modules to one script, without what is for readers of the source alone: comments and indents. No text in them spans lines.
fn joined() -> String {
    let mut script = String::from("\"use strict\";\n");
    for module in MODULES {
        let lines = module.lines().filter(|line| !line.starts_with("import ")).map(str::trim_start);
        for line in lines.filter(|line| !line.is_empty() && !line.starts_with("//")) {
            script.push_str(line.strip_prefix("export ").unwrap_or(line));
            script.push('\n');
        }
    }
    script
}

/// Escapes a text as content of an element.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Returns the rules of the handbook by their ids: title, grade, and text.
pub(crate) fn rules() -> Value {
    let rule = |rule: &Rule<'_>| {
        // Files and tests of the repository say nothing to the reader of a page.
        let lines: Vec<_> = rule.fields.iter().filter(|(label, _)| !["Code", "Pinned by"].contains(label)).collect();
        json!({ "title": rule.title, "grade": rule.grades().first(), "lines": lines })
    };
    Value::Object(RULES.iter().map(|each| (each.id.to_owned(), rule(each))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Map;

    #[test]
    fn every_rule_of_the_handbook_has_its_text() {
        let rules = rules();
        assert_eq!(rules.as_object().map(Map::len), Some(RULES.len()));
        assert_eq!(rules["NUM-2"]["grade"], json!("SILICON"), "the first of its grades");
        assert!(rules["CMB-3"]["lines"].as_array().is_some_and(|lines| lines.len() > 2));
        assert_eq!(
            rules["FIN-4"]["lines"][0],
            json!(["Formula", "E*F = rnd255(E F) in R, G and B\nalpha = G, identity or invert"])
        );
    }

    #[test]
    fn bytes_are_digits_of_base_85() {
        for (bytes, text) in [(&[][..], ""), (&[0], "(("), (&[9, 8, 7], "*tei"), (&[255; 4], "z?^4(")] {
            assert_eq!(dense(bytes), text);
        }
        for byte in 0..=255 {
            assert!(!dense(&[byte; 4]).contains(['<', '&', '"', '\\', '{']), "{byte}");
        }
    }

    #[test]
    fn no_text_of_a_script_spans_lines() {
        for line in MODULES.iter().flat_map(|module| module.lines()) {
            assert_eq!(line.matches('`').count() % 2, 0, "{line}");
        }
    }

    #[test]
    fn what_a_scene_says_ends_no_element() {
        let data = json!({ "text": "</script><script>alert(1)</script><!--" });
        let page = page("<b>&", &data, &json!({}));
        assert_eq!(page.matches("</script>").count(), 4);
        assert!(!page.contains("alert(1)</") && page.contains("<title>&lt;b&gt;&amp; - Ninebit</title>"));
        assert_eq!(page.matches("{{").count(), 0, "a place was not filled");
    }

    #[test]
    fn nothing_is_loaded_from_elsewhere() {
        // Digits may look like anything.
        let page = page("scene", &json!({}), &json!({})).replace(&dense(MODULE), "");
        for form in ["src=", "http://", "https://", "@import", "url(", " style=", "onclick=", "\nimport "] {
            let found = page.find(form);
            assert_eq!(found, None, "{form}: {:?}", found.map(|at| &page[at.saturating_sub(60)..at + 60]));
        }
    }
}
