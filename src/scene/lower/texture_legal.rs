//! What the chips take: formats, sides, levels and border texels by kind of texture.

use super::*;
use ninebit::state::{LARGEST_VOLUME, Named, TextureFormat, TextureKind};

/// The largest side of a texture of any kind.
pub(super) fn largest_side(reader: &Reader<'_>) -> u32 {
    let chip = if reader.profile == Profile::Nv10 { 2048 } else { 4096 };
    reader.limits.texture_side.min(chip)
}

/// The format exists on the chip.
pub(super) fn format(reader: &mut Reader<'_>, format: TextureFormat, place: Span) -> Option<()> {
    if format.is_nv2a_only() && reader.profile == Profile::Nv10 {
        let what = format!("texture format {}", format.name());
        return reader.refuse(target::only_nv2a("NB0320", place, &what, "TEX-1"));
    }
    Some(())
}

/// Sides that the chip and the limits allow: powers of two, or any of a rectangle; of a cube map square.
pub(super) fn sides(
    reader: &mut Reader<'_>,
    kind: TextureKind,
    format: TextureFormat,
    width: u32,
    height: u32,
    place: Span,
) -> Option<()> {
    let (most, what) = largest(reader, kind, format);
    if width.max(height) > most {
        return reader.refuse(too_large(reader, what, [width, height], most, place));
    }
    if kind == TextureKind::Rectangle {
        return rectangle(reader, format, width, height, place);
    }
    if !(width.is_power_of_two() && height.is_power_of_two()) {
        let next = |side: u32| side.max(1).checked_next_power_of_two().unwrap_or(most).min(most);
        let message = format!("{what} cannot be {width} x {height}");
        let help = format!("make it {} x {}, for example, or write `kind: Rectangle`", next(width), next(height));
        return reader.refuse(finding("NB0219", place, message, "sides must be powers of two", help).rule("TEX-7"));
    }
    if kind == TextureKind::Cube && width != height {
        let message = format!("faces of a cube map cannot be {width} x {height}");
        reader.push(finding("NB0231", place, message, "not square", "make every face as wide as high").rule("TEX-12"));
        return None;
    }
    Some(())
}

/// The largest side of a kind of texture, and what messages call it.
fn largest(reader: &Reader<'_>, kind: TextureKind, format: TextureFormat) -> (u32, &'static str) {
    let what = match kind {
        TextureKind::TwoDimensional => "a texture",
        TextureKind::Rectangle => "a rectangle texture",
        TextureKind::Cube => "a face of a cube map",
        TextureKind::ThreeDimensional => "a layer of a volume",
    };
    (reader.limits.texture_side.min(kind.largest_side(format, reader.profile)), what)
}

/// The finding that a side is too long.
pub(super) fn too_large(
    reader: &Reader<'_>,
    what: &str,
    [width, height]: [u32; 2],
    most: u32,
    place: Span,
) -> Diagnostic {
    let on = if reader.profile == Profile::Nv10 { "; profile Nv2a allows 4096" } else { "" };
    Diagnostic::error("NB0321", place, format!("{what} of {width} x {height} is too large"))
        .label(format!("a side has at most {most} texels on {:?}", reader.profile))
        .help(format!("scale it down{on}"))
}

/// Linear layouts have neither blocks nor indices; nv10 has four of them, of even width.
fn rectangle(reader: &mut Reader<'_>, format: TextureFormat, width: u32, height: u32, place: Span) -> Option<()> {
    let nv10 = reader.profile == Profile::Nv10;
    let refuse = |message: String, help: &str| {
        Diagnostic::error("NB0330", place.clone(), message)
            .label("not as a rectangle")
            .rule("TEX-7")
            .help(help.to_owned())
    };
    let finding = if !format.is_linear(Profile::Nv2a) {
        refuse(format!("a rectangle texture cannot be {}", format.name()), "use another format, or another kind")
    } else if !format.is_linear(reader.profile) {
        let message = format!("a rectangle texture cannot be {} on Nv10", format.name());
        refuse(message, "use A8R8G8B8, R5G6B5, A1R5G5B5 or I8, or write `profile: Nv2a`")
    } else if nv10 && width % 2 == 1 {
        let message = format!("a rectangle texture cannot be {width} x {height} on Nv10: its width is odd");
        refuse(message, "make the width even, or write `profile: Nv2a`")
    } else {
        return Some(());
    };
    reader.refuse(finding)
}

/// Layers of a volume, which nv2a has.
pub(super) fn layers(reader: &mut Reader<'_>, kind: TextureKind, layers: u32, place: Span) -> Option<()> {
    if kind != TextureKind::ThreeDimensional {
        return Some(());
    }
    if reader.profile == Profile::Nv10 {
        return reader.refuse(target::only_nv2a("NB0334", place, "a texture of three dimensions", "VOL-1"));
    }
    if !layers.is_power_of_two() || layers > LARGEST_VOLUME {
        let message = format!("a volume cannot have {layers} layers");
        let help = format!("give it 1, 2, 4 and so on, at most {LARGEST_VOLUME}");
        return reader.refuse(finding("NB0334", place, message, "a power of two of them", help).rule("VOL-1"));
    }
    Some(())
}

/// A rectangle has one level, and a volume.
pub(super) fn levels(reader: &mut Reader<'_>, kind: TextureKind, levels: u32, place: Span) -> Option<()> {
    let (what, rule, help) = match kind {
        TextureKind::ThreeDimensional => {
            ("volume", "VOL-1", "write `levels: 1`: which of them a volume reads is not known")
        }
        TextureKind::Rectangle => {
            ("rectangle texture", "TEX-9", "write `levels: 1`, or scale it to powers of two and leave `kind` out")
        }
        _ => return Some(()),
    };
    if levels <= 1 {
        return Some(());
    }
    let message = format!("a {what} cannot have {levels} levels");
    reader.refuse(Diagnostic::error("NB0230", place, message).label("one at most").rule(rule).help(help))
}

/// Border texels: of nv2a, two dimensions, no blocks.
pub(super) fn border(reader: &mut Reader<'_>, kind: TextureKind, format: TextureFormat, place: Span) -> Option<()> {
    if reader.profile == Profile::Nv10 {
        return reader.refuse(target::only_nv2a("NB0331", place, "a texture with border texels", "TEX-7"));
    }
    if kind != TextureKind::TwoDimensional || format.is_compressed() {
        let what = if format.is_compressed() { format.name() } else { kind.name() };
        let message = format!("a texture with border texels cannot be {what}");
        let help = "border texels are modelled for uncompressed textures of two dimensions: write `border: false`";
        return reader.refuse(finding("NB0331", place, message, "does not go with it", help).rule("TEX-7"));
    }
    Some(())
}
