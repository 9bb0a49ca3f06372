//! Checks a texture unit against the texture that it samples.

use super::*;
use ninebit::legality;

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
            reader.push(legality::texture::missing_palette(&name, Some(place.clone())));
        }
    } else if let Some(raw) = raw {
        reader.push(legality::texture::unread_palette(format, Some(reader.span(raw))));
    }
    let field = fields.and_then(|f| [&f.address_s, &f.address_t, &f.address].into_iter().flatten().next().copied());
    let place = field.map_or(place, |raw| reader.span(&raw));
    let modes = [unit.address_s, unit.address_t];
    reader.accept(reader.texture_checks().rectangle_modes(kind, modes, Some(place)));
}
