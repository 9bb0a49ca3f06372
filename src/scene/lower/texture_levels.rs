//! Lowers the levels of a texture: those of its file, listed ones, or those made from level 0.

use super::texture_source::{Request, SourceTexels, Variant};
use super::*;
use ninebit_files::texels;

/// The number of levels that a texture asks for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum LevelCount {
    /// `levels` is not written: as many as the source has.
    Own,
    /// The number that is written.
    Number(u32),
    /// All levels down to 1 x 1.
    All,
}

/// Returns the number of texels by which the sides of sources exceed those of the texture.
pub(super) fn beyond(border: bool) -> u32 {
    if border { 2 * BORDER_TEXELS } else { 0 }
}

/// Reads `levels: 4` or `levels: All`.
pub(super) fn requested<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Word>) -> Option<LevelCount> {
    if raw.split() == ("All", "") {
        return Some(LevelCount::All);
    }
    let number: Raw<'a, u32> = raw.as_other();
    if number.split().0.is_empty() {
        return reader.within(&number, "the number of levels", 1..=13, |finding| finding).map(LevelCount::Number);
    }
    let message = "expected a number of levels, or `All`";
    let help = "write `levels: All` for levels down to 1 x 1";
    reader.refuse(finding("NB0205", reader.span(raw), message, "wrong kind of value", help))
}

/// Returns how many levels to take from a source that does not determine their number.
pub(super) fn number(
    reader: &mut Reader<'_>,
    requested: LevelCount,
    [width, height]: [u32; 2],
    place: Span,
) -> Option<u32> {
    let most = Level::most(width, height);
    match requested {
        LevelCount::Own => Some(1),
        LevelCount::All => Some(most),
        LevelCount::Number(number) if number <= most => Some(number),
        LevelCount::Number(number) => reader.refuse(too_many(number, width, height, place)),
    }
}

fn too_many(number: u32, width: u32, height: u32, place: Span) -> Diagnostic {
    let most = Level::most(width, height);
    let has = if most == 1 { "1 level".to_owned() } else { format!("{most} levels") };
    let message = format!("a texture of {width} x {height} cannot have {number} levels");
    let help = "sides halve from level to level until both are 1; `levels: All` means all of them";
    finding("NB0230", place, message, format!("{has} at most"), help).rule("TEX-9")
}

/// Brings the levels of a source to the number asked for, by dropping some or making smaller ones from level 0.
pub(super) fn resize_chain<'a>(
    reader: &mut Reader<'a>,
    given: &mut SourceTexels,
    requested: LevelCount,
    request: &Request,
) -> Option<()> {
    let own = given.levels();
    let beyond = beyond(request.border);
    let inside = [given.width - beyond, given.height - beyond];
    if requested == LevelCount::Own {
        return Some(());
    }
    let number = number(reader, requested, inside, given.place.clone())?;
    if number <= own {
        for levels in &mut given.faces {
            levels.truncate(number as usize);
        }
        return Some(());
    }
    if own > 1 || !texels::can_pack(given.format) || request.border {
        let reason = if own > 1 {
            format!("the source has {own} levels")
        } else if !texels::can_pack(given.format) {
            format!("the format is {}", given.format.name())
        } else {
            "a border has no texels to make the next one from".to_owned()
        };
        let message = format!("{number} levels cannot be made here: {reason}");
        let help = "leave `levels` out, or give every level a source in `mips`, or use a file that has them";
        return reader.refuse(finding("NB0230", given.place.clone(), message, "of this source", help));
    }
    let (mut width, mut height) = (given.width, given.height);
    for _ in 1..number {
        let next = [(width / 2).max(1), (height / 2).max(1)];
        let words = given.faces.len() as u64 * u64::from(next[0]) * u64::from(next[1]);
        texture_source::afford(reader, given.place.clone(), words)?;
        for levels in &mut given.faces {
            let smaller = levels.last().map(|words| texels::halve(words, width, height, given.format));
            levels.extend(smaller);
        }
        [width, height] = next;
    }
    Some(())
}

/// Adds the levels that `mips` lists.
pub(super) fn listed<'a>(
    reader: &mut Reader<'a>,
    given: &mut SourceTexels,
    raw: &Raw<'a, source::List<'a, source::ImageSource>>,
    kind: TextureKind,
    request: &Request,
) -> Option<()> {
    let list = reader.read(raw)?;
    let beyond = beyond(request.border);
    let inside = [given.width - beyond, given.height - beyond];
    if given.faces.iter().any(|levels| levels.len() > 1) {
        let place = reader.span(raw);
        let message = "levels are listed, and the source of level 0 has several as well";
        return reader.refuse(finding("NB0230", place, message, "listed here", "leave `mips` out"));
    }
    let number = list.len() as u32 + 1;
    if number > Level::most(inside[0], inside[1]) {
        return reader.refuse(too_many(number, inside[0], inside[1], reader.span(raw)));
    }
    // Listed sources have the format of level 0, however that was determined.
    let request = Request { format: Some(given.format), levels: LevelCount::Own, ..*request };
    let mut complete = true;
    for (n, raw) in (1..).zip(&list) {
        let Some(level) = texture_source::nested(reader, raw, "source of a level", &Variant::OF_LEVEL, &request) else {
            complete = false;
            continue;
        };
        let sides = inside.map(|side| (side >> n).max(1) + beyond);
        let (faces, most) = (level.faces.len(), level.faces.iter().map(Vec::len).max().unwrap_or(0));
        let found = if most > 1 {
            format!("{most} levels")
        } else if faces != given.faces.len() {
            (if faces == 1 { "one picture" } else { "six faces" }).to_owned()
        } else if [level.width, level.height] != sides {
            format!("{} x {}", level.width, level.height)
        } else {
            for (levels, face) in given.faces.iter_mut().zip(level.faces) {
                levels.extend(face);
            }
            continue;
        };
        let of = if kind == TextureKind::Cube { "six faces of " } else { "" };
        let message = format!("level {n} is {of}{} x {}, not {found}", sides[0], sides[1]);
        let help = "sides halve from level to level, rounded down, and are at least 1";
        reader.push(finding("NB0231", level.place, message, "does not fit", help).rule("TEX-9"));
        complete = false;
    }
    complete.then_some(())
}

/// Drops the levels before `first_level`, which has to be a level that exists. Returns its number.
pub(super) fn first<'a>(reader: &mut Reader<'a>, given: &mut SourceTexels, raw: &Raw<'a, u32>) -> Option<u32> {
    let number = reader.read(raw)?;
    let levels = given.levels();
    if number >= levels {
        let place = reader.span(raw);
        let message = format!("there is no level {number} to begin with");
        let label = if levels == 1 { "one level".to_owned() } else { format!("levels 0 to {}", levels - 1) };
        reader.push(finding("NB0230", place, message, label, "`levels: All` makes levels down to 1 x 1").rule("TEX-9"));
        return None;
    }
    for levels in &mut given.faces {
        levels.drain(..number as usize);
    }
    Some(number)
}
