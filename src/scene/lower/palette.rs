//! Lowers palettes: the colours that texels of P8 stand for.

use super::*;
use crate::names::{Index, Palettes};

impl Palettes {
    /// Adds a palette that cannot be found by name. Returns its index.
    pub(super) fn add(&mut self, name: &str, words: Vec<u32>) -> usize {
        self.list.push(Palette { name: name.to_owned(), entries: words.into() });
        self.list.len() - 1
    }
}

/// Finds the palette of a name. Returns `None` after recording what is wrong.
pub(super) fn find<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<usize> {
    Index::find(reader, |reader| &mut reader.textures.palettes.index, raw)
}

/// Reads every palette.
pub(super) fn palettes<'a>(reader: &mut Reader<'a>, raw: &Option<Raw<'a, Entries<'a, source::List<'a, String>>>>) {
    reader.textures.palettes.index = Index::new("palette", "define it in `palettes: { \"...\": [\"ff000000 ...\"] }`");
    for entry in reader.table("palette", raw) {
        let words = words(reader, &entry.value);
        let palettes = &mut reader.textures.palettes;
        let index = words.map(|words| palettes.add(&entry.name, words));
        palettes.index.add(entry.name, entry.place, index);
    }
}

/// Reads words A8R8G8B8 in hexadecimal, any number in each text.
fn words<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::List<'a, String>>) -> Option<Vec<u32>> {
    const HELP: &str = "write 32, 64, 128 or 256 words A8R8G8B8 of 8 hexadecimal digits";
    let list = reader.read(raw)?;
    let mut words = Vec::new();
    for text in &list {
        let row = reader.read(text)?;
        for word in row.split_ascii_whitespace() {
            let Some(value) = texture_source::hexadecimal(word, 8) else {
                let place = reader.span(text);
                let message = format!("`{}` is not an entry of a palette", shorten(word));
                return reader.refuse(finding("NB0233", place, message, "in this text", HELP));
            };
            words.push(value);
        }
    }
    let place = reader.span(raw);
    if !Palette::LENGTHS.contains(&words.len()) {
        let message = format!("a palette cannot have {} entries", words.len());
        return reader.refuse(finding("NB0233", place, message, "another number", HELP).rule("TEX-1"));
    }
    let what = format!("a palette of {} entries", words.len());
    reader.accept(target::needs_nv2a(reader.profile, words.len() < 256, "NB0332", place, &what, "TEX-1"))?;
    Some(words)
}
