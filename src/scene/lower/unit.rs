//! Lowers the texture units of a draw.

use super::*;
use ninebit::legality;

/// The texture units of a draw, with the stages of its texture shader.
pub(super) struct Units {
    pub(super) bound: [Option<TextureUnit>; TEXTURE_UNITS],
    pub(super) shader: [ShaderStage; TEXTURE_UNITS],
    /// Places of the names of their textures; empty for units that are not bound.
    pub(super) places: [Span; TEXTURE_UNITS],
}

/// Reads the units of a draw, with the places of their textures' names.
pub(super) fn units<'a>(reader: &mut Reader<'a>, raw: &Option<Raw<'a, source::List<'a, source::Unit>>>) -> Units {
    let mut units = Units {
        bound: [None; TEXTURE_UNITS],
        shader: [0, 1, 2, 3].map(|index| ShaderStage::conventional(index, false)),
        places: [0..0, 0..0, 0..0, 0..0],
    };
    let list = raw.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
    let available = reader.profile.texture_units();
    for (index, raw) in list.iter().enumerate() {
        if matches!(raw.split(), ("Unbound", "")) {
            continue;
        }
        let place = reader.span(raw);
        if index >= TEXTURE_UNITS {
            let message = format!("there is no texture unit {index}");
            let help = "units 0 to 3 are the entries of this list";
            reader.push(finding("NB0319", place, message, "one too many", help).rule("CMB-12"));
            break;
        }
        let what = format!("texture unit {index}");
        reader.accept(target::needs_nv2a(reader.profile, index >= available, "NB0319", place.clone(), &what, "CMB-12"));
        units.places[index] = place;
        if let Some((unit, coordinate_set, place)) = unit(reader, raw, index) {
            units.bound[index] = Some(unit);
            units.shader[index] = ShaderStage { coordinate_set, ..ShaderStage::conventional(index, true) };
            units.places[index] = place;
        }
    }
    units
}

fn unit<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Unit>, index: usize) -> Option<(TextureUnit, usize, Span)> {
    let mut unit = TextureUnit::new(0);
    if raw.is_text() {
        unit.texture = texture::find(reader, &raw.as_other())?;
        unit_texture::check(reader, None, &mut unit, reader.span(raw));
        return Some((unit, index, reader.span(raw)));
    }
    let fields = reader.read(&raw.as_other::<source::UnitState<'a>>())?;
    let texture = fields.texture(reader);
    let found = texture.as_ref().and_then(|raw| texture::find(reader, raw));
    let coordinate_set = fields.coordinates(reader).map_or(index, |set| set as usize);
    let both = fields.address(reader);
    let mut along = |field: &Option<_>| field.and_then(|raw| reader.name(&raw)).unwrap_or(both);
    let [s, t, r] = [&fields.address_s, &fields.address_t, &fields.address_r].map(&mut along);
    (unit.address_s, unit.address_t, unit.address_r) = (s, t, r);
    let modes = [(&fields.address, both), (&fields.address_s, s), (&fields.address_t, t), (&fields.address_r, r)];
    for (field, mode) in modes {
        let place = reader.place(field);
        reader.accept(place.and_then(|place| reader.texture_checks().address_mode(mode, Some(place))));
    }
    unit.border_color = color::bytes(fields.border_color(reader));
    reader.needs_nv2a(&fields.border_color, true, "NB0317", ("a border colour", "TEX-7"));
    filters(reader, &fields, &mut unit);
    unit.signed = fields.signed(reader);
    let signed = unit.signed != [false; 4];
    reader.needs_nv2a(&fields.signed, signed, "NB0318", ("a signed texture channel", "TEX-18"));
    lod(reader, &fields, &mut unit);
    sampling(reader, &fields, &mut unit);
    unit.color_key = fields.color_key.as_ref().and_then(|raw| color_key(reader, raw, &unit));
    unit.texture = found?;
    let place = texture.map_or(0..0, |raw| reader.span(&raw));
    unit_texture::check(reader, Some(&fields), &mut unit, place.clone());
    Some((unit, coordinate_set, place))
}

/// Reads the filters for minification, magnification and between levels.
fn filters<'a>(reader: &mut Reader<'a>, fields: &source::UnitState<'a>, unit: &mut TextureUnit) {
    let min = fields.min_filter.as_ref().and_then(|raw| reader.name(raw));
    let mag = fields.mag_filter.as_ref().and_then(|raw| reader.name(raw));
    unit.mag_filter = mag.or(min).unwrap_or(Filter::Linear);
    unit.min_filter = min.or(mag).unwrap_or(Filter::Linear);
    unit.mip_filter = fields.mip_filter(reader);
}

/// Converts bias and limits of the lod into the chip's fields by NUM-0 and TEX-9: signed 5.8 and unsigned 4.8, truncated towards zero.
fn lod<'a>(reader: &mut Reader<'a>, fields: &source::UnitState<'a>, unit: &mut TextureUnit) {
    let lods = [fields.lod_bias(reader), fields.min_lod(reader), fields.max_lod(reader)];
    #[allow(clippy::float_arithmetic, reason = "floats of the scene become the registers' integers")]
    let registers = lods.map(|lod| (256.0 * lod) as i32);
    [unit.lod_bias, unit.min_lod, unit.max_lod] = registers;
    if let Some(raw) = fields.max_lod.as_ref().or(fields.min_lod.as_ref())
        && unit.min_lod > unit.max_lod
    {
        let message = "the least lod is greater than the greatest";
        let help = "give a `min_lod` that is at most `max_lod`";
        reader.push(finding("NB0206", reader.span(raw), message, "nothing lies between them", help).rule("TEX-9"));
    }
}

/// Reads the colour key of a unit whose filters have been read (KEY-1).
fn color_key<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::ColorKey<'a>>, unit: &TextureUnit) -> Option<ColorKey> {
    let fields = reader.read(raw)?;
    let color = fields.color(reader);
    let mode = fields.mode(reader);
    reader.accept(legality::texture::filtered_key(unit, Some(reader.span(raw))));
    let color = color.and_then(|raw| color::constant(reader, &raw));
    Some(ColorKey { mode: reader.name(&mode?)?, color: color? })
}

/// Reads the state of TEX-17, CYL-1, SHD-1 and VOL-1; the plan checks where it is allowed.
fn sampling<'a>(reader: &mut Reader<'a>, fields: &source::UnitState<'a>, unit: &mut TextureUnit) {
    unit.anisotropy = fields.anisotropy(reader);
    unit.cylindrical_wrap = fields.cylindrical_wrap(reader);
    if let Some(raw) = &fields.shadow
        && let Some(shadow) = reader.read(raw)
    {
        let function = shadow.function(reader);
        let reference = shadow.reference(reader);
        unit.shadow = function.map(|function| ShadowComparison { function, reference });
    }
}
