//! Finds the files of a crate that import one another, by reading their sources.
//!
//! A file imports what `use` names, and what its text reaches by `crate`, by `super`, or through a module that `use` named. A module that
//! calls its own children by name, or re-exports their items, does not count as importing them: dependencies on children are expected, and
//! only the imports of the children show whether there is one in the other direction.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::{BTreeMap, BTreeSet};

/// The path of a module from the root of its crate.
type Module = Vec<String>;

/// The names and imports of a file.
struct Source {
    module: Module,
    /// Names that `use` brings into scope, each with its path.
    imports: BTreeMap<String, Vec<String>>,
    /// The paths that the file imports.
    paths: Vec<Vec<String>>,
    /// The paths of modules that the file imports with `*`.
    globs: Vec<Vec<String>>,
    /// All names in the text.
    names: BTreeSet<String>,
    /// The names of the items that the file defines.
    items: BTreeSet<String>,
}

/// Returns the groups of files that all reach one another by imports, each file with the files of its group that it imports. A name counts
/// for the file that defines its item, even if other modules re-export it. Groups of one file are left out.
///
/// `files` has the path of each file within the crate's folder, and its text.
pub fn circles(files: &[(String, String)]) -> Vec<BTreeMap<&str, Vec<&str>>> {
    let uses = edges(files);
    let reached: Vec<BTreeSet<usize>> = (0..uses.len()).map(|n| reach(&uses, n)).collect();
    let groups: BTreeSet<BTreeSet<usize>> = (0..uses.len())
        .map(|n| reached[n].iter().copied().filter(|other| reached[*other].contains(&n)).collect())
        .collect();
    let name = |n: &usize| files[*n].0.as_str();
    let within = |n: &usize, group: &BTreeSet<usize>| (name(n), uses[*n].intersection(group).map(name).collect());
    groups
        .iter()
        .filter(|group| group.len() > 1)
        .map(|group| group.iter().map(|n| within(n, group)).collect())
        .collect()
}

/// Returns for each file the indices of the files that define the names it imports.
fn edges(files: &[(String, String)]) -> Vec<BTreeSet<usize>> {
    let sources: Vec<Source> = files.iter().map(|(name, text)| source(name, text)).collect();
    let modules: BTreeMap<&[String], usize> =
        sources.iter().enumerate().map(|(n, source)| (source.module.as_slice(), n)).collect();
    (0..sources.len())
        .map(|n| {
            let Source { paths, globs, names, imports, items, .. } = &sources[n];
            let free = || names.iter().filter(|name| !imports.contains_key(*name) && !items.contains(*name));
            let globbed = globs.iter().flat_map(|glob| {
                let held = reached(&sources, &modules, n, glob).filter(|(held, _)| *held != n);
                let held = held.map(|(held, _)| &sources[held]);
                let known = move |name: &&String| {
                    held.is_some_and(|held| held.imports.contains_key(*name) || held.items.contains(*name))
                };
                free().filter(known).map(|name| glob.iter().chain([name]).cloned().collect())
            });
            let all = globbed.chain(paths.iter().cloned());
            all.filter_map(|path| holder(&sources, &modules, n, &path, 0)).collect()
        })
        .collect()
}

/// Returns everything that `from` uses, directly and indirectly.
fn reach(uses: &[BTreeSet<usize>], from: usize) -> BTreeSet<usize> {
    let (mut found, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(next) = open.pop() {
        open.extend(uses[next].iter().filter(|other| found.insert(**other)));
    }
    found
}

/// Returns the file that defines the item to which a path in a file refers. Returns `None` for items of other crates, for modules, and for
/// items of the file itself.
fn holder(
    sources: &[Source],
    modules: &BTreeMap<&[String], usize>,
    file: usize,
    path: &[String],
    depth: usize,
) -> Option<usize> {
    let Some((held, rest)) = reached(sources, modules, file, path) else {
        let import = sources[file].imports.get(&path[0]).filter(|import| import[0] != path[0] && depth < 9)?;
        let whole: Vec<String> = import.iter().chain(&path[1..]).cloned().collect();
        return holder(sources, modules, file, &whole, depth + 1);
    };
    let import = sources[held].imports.get(rest.first()?);
    let handed_on = import.and_then(|import| {
        let whole: Vec<String> = import.iter().chain(&rest[1..]).cloned().collect();
        if depth < 9 { holder(sources, modules, held, &whole, depth + 1) } else { None }
    });
    handed_on.or(Some(held)).filter(|held| *held != file)
}

/// Returns the file of the module to which a path leads, and the rest of the path. Returns `None` if the path does not begin with the name
/// of a module.
fn reached<'p>(
    sources: &[Source],
    modules: &BTreeMap<&[String], usize>,
    file: usize,
    path: &'p [String],
) -> Option<(usize, &'p [String])> {
    let mut module = sources[file].module.clone();
    let mut rest = path;
    while let [first, left @ ..] = rest {
        match first.as_str() {
            "crate" => module.clear(),
            "self" => {}
            "super" => _ = module.pop()?,
            _ => {
                module.push(first.clone());
                if !modules.contains_key(module.as_slice()) {
                    module.pop();
                    break;
                }
            }
        }
        rest = left;
    }
    if rest.len() == path.len() { None } else { Some((*modules.get(module.as_slice())?, rest)) }
}

fn source(name: &str, text: &str) -> Source {
    let mut module: Module = name.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if matches!(module.last().map(String::as_str), Some("lib" | "main" | "mod")) {
        module.pop();
    }
    let words = words(text);
    let define = |pair: &&[String]| {
        matches!(pair[0].as_str(), "fn" | "struct" | "enum" | "trait" | "type" | "const" | "static" | "macro_rules")
    };
    let items = words.windows(2).filter(define).map(|pair| pair[1].clone()).collect();
    let names = words.iter().filter(|word| is_name(word)).cloned().collect();
    let (imports, paths, globs) = (BTreeMap::new(), Vec::new(), Vec::new());
    let mut found = Source { module, imports, paths, globs, names, items };
    let mut at = 0;
    while at < words.len() {
        if words[at] == "use" {
            let kept = found.paths.len();
            tree(&words, &mut (at + 1), &[], &mut found);
            if at > 0 && matches!(words[at - 1].as_str(), "pub" | ")") {
                found.paths.truncate(kept);
            }
            while words[at] != ";" {
                at += 1;
            }
        } else if is_name(&words[at]) && (at == 0 || words[at - 1] != "::") {
            let mut path = vec![words[at].clone()];
            while words.get(at + 1).is_some_and(|word| word == "::")
                && words.get(at + 2).is_some_and(|word| is_name(word))
            {
                path.push(words[at + 2].clone());
                at += 2;
            }
            if path.len() > 1 {
                found.paths.push(path);
            }
        }
        at += 1;
    }
    let Source { imports, paths, .. } = &mut found;
    paths.retain(|path| matches!(path[0].as_str(), "crate" | "super" | "self") || imports.contains_key(&path[0]));
    found
}

/// Reads one tree of a `use` statement, beginning at word `at`.
fn tree(words: &[String], at: &mut usize, before: &[String], found: &mut Source) {
    let mut path = before.to_vec();
    loop {
        let word = words[*at].clone();
        *at += 1;
        match word.as_str() {
            "{" => {
                while words[*at] != "}" {
                    tree(words, at, &path, found);
                    if words[*at] == "," {
                        *at += 1;
                    }
                }
                *at += 1;
                return;
            }
            "::" => continue,
            "*" => return found.globs.push(path),
            "self" if !path.is_empty() => break,
            _ => path.push(word),
        }
        if words[*at] != "::" {
            break;
        }
    }
    let mut name = path.last().unwrap().clone();
    if words[*at] == "as" {
        name.clone_from(&words[*at + 1]);
        *at += 2;
    }
    if !matches!(path[0].as_str(), "crate" | "super" | "self") {
        // The path begins with a child module or with another crate.
        path.insert(0, "self".to_owned());
    }
    found.paths.push(path.clone());
    found.imports.insert(name, path);
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Returns the names and punctuation of a text without comments, literals and unit tests.
fn words(text: &str) -> Vec<String> {
    let text = text.split("\nmod tests {").next().unwrap();
    let mut words = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(raw) = rest.strip_prefix("r#\"") {
            raw.find("\"#").unwrap() + 5
        } else if first == '"' {
            let mut before = ' ';
            let closes = |c| {
                let escaped = before == '\\';
                before = if escaped { ' ' } else { c };
                !escaped && c == '"'
            };
            1 + rest[1..].find(closes).unwrap() + 1
        } else if first == '\'' && rest.as_bytes().get(1) == Some(&b'\\') {
            3 + rest[3..].find('\'').unwrap()
        } else if first == '\'' && rest.chars().nth(2) == Some('\'') {
            rest.char_indices().nth(3).unwrap().0
        } else if first.is_alphanumeric() || first == '_' {
            let length = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            words.push(rest[..length].to_owned());
            length
        } else {
            let length = if rest.starts_with("::") { 2 } else { first.len_utf8() };
            if !first.is_whitespace() {
                words.push(rest[..length].to_owned());
            }
            length
        };
        rest = &rest[length..];
    }
    words
}

#[test]
fn circles_are_found_through_modules_that_hand_items_on() {
    let file = |name: &str, text: &str| (name.to_owned(), text.to_owned());
    let files = [
        file("lib.rs", "mod a;\nmod b;\nmod c;\npub use b::{Lower, Upper as Other};\nfn run() { c::run(); }"),
        file("a.rs", "use crate::Other; // crate::c::Third\nfn a() -> &'static str { \"super::c::Third\" }"),
        file("b/mod.rs", "mod inner;\npub use inner::Upper;\nstruct Lower;"),
        file("b/inner.rs", "struct Upper(super::super::c::Third);"),
        file("c.rs", "use crate::a;\nstruct Third(a::First);\n#[cfg(test)]\nmod tests { use super::super::b::Lower; }"),
    ];
    let circle = [("a.rs", vec!["b/inner.rs"]), ("b/inner.rs", vec!["c.rs"]), ("c.rs", vec!["a.rs"])];
    assert_eq!(circles(&files), [BTreeMap::from(circle)]);
    let straight =
        [file("lib.rs", "mod a;\nmod b;"), file("a.rs", "use super::b::B;"), file("b.rs", "struct B('\\'');")];
    assert!(circles(&straight).is_empty());
}
