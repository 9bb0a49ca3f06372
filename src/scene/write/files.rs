//! Names of what is written, and files beside the text.

use std::collections::{BTreeMap, HashMap};

/// Names that are taken, and the number of the last one that was made of each.
#[derive(Default)]
pub(super) struct UniqueNames(HashMap<String, u64>);

impl UniqueNames {
    /// Returns a name that is not taken yet: the wanted one, or one with a number behind it.
    pub(super) fn unique(&mut self, wanted: &str) -> String {
        let mut name = wanted.to_owned();
        while self.0.contains_key(&name) {
            let last = self.0.entry(wanted.to_owned()).or_insert(1);
            *last += 1;
            name = format!("{wanted} {last}");
        }
        self.0.insert(name.clone(), 1);
        name
    }
}

/// The files beside a scene.
pub(super) struct Files {
    /// The folder around theirs; empty if they stand beside the text.
    around: String,
    contents: BTreeMap<String, Vec<u8>>,
}

impl Files {
    pub(super) fn new(around: &str) -> Files {
        let around = if around.is_empty() { String::new() } else { format!("{around}/") };
        Files { around, contents: BTreeMap::new() }
    }

    /// Adds a file of a folder, called like what it is of. Returns the name of an equal one, if there is one.
    pub(super) fn add(&mut self, folder: &str, of: &str, bytes: Vec<u8>) -> String {
        let plain =
            |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c.to_ascii_lowercase() } else { '-' };
        let stem: String = of.chars().take(60).map(plain).collect();
        let around = &self.around;
        let names = std::iter::once(format!("{around}{folder}/{stem}.bin"));
        let mut names = names.chain((2..).map(|n: u64| format!("{around}{folder}/{stem}-{n}.bin")));
        let name = names.find(|name| self.contents.get(name).is_none_or(|known| *known == bytes)).unwrap_or_default();
        self.contents.insert(name.clone(), bytes);
        name
    }

    pub(super) fn into_list(self) -> Vec<(String, Vec<u8>)> {
        self.contents.into_iter().collect()
    }
}
