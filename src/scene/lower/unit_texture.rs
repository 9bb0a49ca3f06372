//! Checks a texture unit against the texture that it samples.

use super::*;

/// Sets the palette of a unit, and checks the unit against its texture. `fields` is `None` if only the texture's name is written, at
/// `place`.
pub(super) fn check<'a>(
    reader: &mut Reader<'a>,
    fields: Option<&source::UnitState<'a>>,
    unit: &mut TextureUnit,
    place: Span,
) {
    let texture = &reader.textures.list[unit.texture];
    let (kind, format) = (texture.kind, texture.format);
    let raw = fields.and_then(|fields| fields.palette.as_ref());
    if format == TextureFormat::P8 {
        unit.palette = match raw {
            Some(raw) => palette::find(reader, raw),
            None => reader.textures.palette_of[unit.texture],
        };
        if unit.palette.is_none() && raw.is_none() {
            let name = shorten(&reader.textures.list[unit.texture].name);
            let message = format!("the texture `{name}` is of format P8 and has no palette");
            let help = "write `palette: \"...\"` in the texture or in this unit";
            reader.push(finding("NB0234", place.clone(), message, "which colours?", help).rule("TEX-1"));
        }
    } else if let Some(raw) = raw {
        reader.push(palette::not_read(reader.span(raw), format));
    }
    let modes = [unit.address_s, unit.address_t];
    if kind == TextureKind::Rectangle && reader.profile == Profile::Nv10 && modes != [AddressMode::ClampToEdge; 2] {
        let wrong = modes.into_iter().find(|mode| *mode != AddressMode::ClampToEdge).map_or("", Named::name);
        let field = fields.and_then(|f| [&f.address_s, &f.address_t, &f.address].into_iter().flatten().next().copied());
        let place = field.map_or(place, |raw| reader.span(&raw));
        let message = format!("a rectangle texture cannot be addressed with {wrong} on Nv10");
        let help = "write `address: ClampToEdge`, or `profile: Nv2a`";
        reader.push(finding("NB0330", place, message, "not as a rectangle", help).rule("TEX-7"));
    }
}
