//! Lowers the scene's `truth`: the light, eye, material and surface of what the picture ought to show.
#![allow(clippy::float_arithmetic, reason = "describes a float64 reference; nothing of this is stored")]

use super::attribute::Light as Place;
use super::draw::LoweredDraw;
use super::texture_source::only;
use super::*;
use crate::generate::normal_map::{self, HeightChannel};
use crate::generate::{hemisphere, occlusion};
use crate::image::{self, ImageLimits, Rgba};
use crate::reader::Name;
use crate::truth::{
    Equation, Eye, Field, HemisphereLight, Light, Material, NormalHolder, NormalSource, ShadingNormal, VectorAttribute,
    real_color,
};
use crate::vector::wide;

/// Reads the truth of a scene. Returns `None` if it has none, or after recording what is wrong.
pub(super) fn truth<'a>(
    reader: &mut Reader<'a>,
    own: &Option<Raw<'a, source::Truth<'a>>>,
    shared: &Option<Raw<'a, source::Truth<'a>>>,
    draws: &[LoweredDraw],
) -> Option<Truth> {
    let Some(raw) = own.as_ref().or(shared.as_ref()) else {
        without_truth(reader, draws);
        return None;
    };
    let opening = reader.opening(raw.text);
    let mut fields = reader.read(raw)?;
    if let (Some(_), Some(shared)) = (own, shared) {
        fields = fields.or(reader.read(shared)?);
    }
    let equation = fields.equation.as_ref().map_or(Some(Equation::Lighting), |raw| equation(reader, raw));
    if let (Some(equation), Some(raw)) = (equation, &fields.equation) {
        only_lighting(reader, equation, &fields, reader.span(raw));
    }
    let normal = fields.normal.as_ref().map_or(Some(NormalSource::Mesh), |raw| normal(reader, raw));
    let eye = reader.perhaps(&fields.eye, eye);
    let material = material(reader, &fields.material);
    let lights = fields.lights.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
    let lights: Vec<Light> = lights.iter().filter_map(|raw| light(reader, raw)).collect();
    let hemisphere = fields.hemisphere.as_ref().map(|raw| hemisphere_light(reader, raw));
    let (hemisphere, occlusion) = hemisphere.unwrap_or_default();
    let color_map = fields.color_map.as_ref().and_then(|raw| {
        let image = picture(reader, raw)?;
        Some(Arc::new(field(&image, |[r, g, b, _]| [r, g, b].map(|byte| f64::from(byte) / 255.0))))
    });
    let shading_normal = fields.shading_normal.as_ref().and_then(|raw| shading_normal(reader, raw, draws));
    if fields.eye.is_none() && material.specular != [0.0; 3] && !lights.is_empty() {
        let label = "`specular` is not zero, and nothing says from where it is seen";
        let help = "add `eye: (position: (x, y, z))`, or `eye: (direction: (x, y, z))` for one far away";
        reader.push(finding("NB0391", opening.clone(), "a truth with highlights has no eye", label, help));
    }
    if equation == Some(Equation::Lighting) && lights.is_empty() && hemisphere.is_none() && fields.lights.is_none() {
        let help = "add `lights: [(direction: (x, y, z))]`, or say with `equation` what else is computed";
        reader.push(finding("NB0391", opening, "a truth without any light", "neither `lights` nor `hemisphere`", help));
    }
    let meshes = draws.iter().map(|drawn| mesh(reader, drawn)).collect();
    Some(Truth {
        equation: equation?,
        normal: normal?,
        lights,
        eye: eye?,
        material,
        hemisphere,
        occlusion,
        color_map,
        shading_normal,
        meshes,
    })
}

/// Refuses draws with a `truth` field in a scene that has no truth.
fn without_truth(reader: &mut Reader<'_>, draws: &[LoweredDraw]) {
    for (_, place) in draws.iter().filter_map(|drawn| drawn.truth.clone()) {
        let message = "the scene has no truth that a draw could take part in";
        let help = "leave it out, or give the scene a `truth: (...)`";
        reader.push(finding("NB0394", place, message, "says nothing here", help));
    }
}

/// Returns the mesh of a draw that takes part in the truth.
fn mesh(reader: &mut Reader<'_>, drawn: &LoweredDraw) -> Option<Arc<crate::mesh::Mesh>> {
    let wanted = drawn.truth.as_ref().is_none_or(|(wanted, _)| *wanted);
    if !wanted || drawn.draw.target != 0 {
        return None;
    }
    if drawn.mesh.is_none() {
        let message = "this draw has no mesh, so there is no truth of it";
        let help = "use a mesh, such as `mesh: Triangles(vertices: [...])`, or write `truth: false` in the draw";
        let found = finding("NB0390", drawn.spans.draw.clone(), message, "its vertices are listed", help);
        reader.push(found.note("the truth needs positions, normals and tangents in object space"));
    }
    drawn.mesh.clone()
}

fn equation<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Word>) -> Option<Equation> {
    const KINDS: &[&str] = &["Lighting", "SignedProduct", "Difference", "DotProduct"];
    let (kind, rest) = reader.variant_of(raw, "equation", KINDS, 3)?;
    Some(match kind {
        0 => Equation::Lighting,
        1 => Equation::SignedProduct,
        2 => Equation::Difference,
        _ => {
            let list = Raw::<Tuple<'a, Name<VectorAttribute>>>::new(rest);
            let parts = reader.read(&list)?.0;
            let [a, b] = parts[..] else {
                let help = "write `DotProduct(PrimaryColor, SecondaryColor)`";
                let message = "a dot product has two vectors";
                return reader.refuse(finding("NB0211", reader.span(&list), message, "here", help));
            };
            Equation::DotProduct(reader.name(&a)?, reader.name(&b)?)
        }
    })
}

/// Refuses fields that only the lighting equation reads.
fn only_lighting<'a>(reader: &mut Reader<'a>, equation: Equation, fields: &source::Truth<'a>, place: Span) {
    if equation == Equation::Lighting {
        return;
    }
    for (name, text) in fields.written().filter(|(name, _)| *name != "equation") {
        let message = format!("`{name}` belongs to `equation: Lighting`");
        let (label, help) = ("not read by this equation", "leave one of the two out");
        reader.push(finding("NB0393", reader.range(text), message, label, help).related(place.clone(), "this one"));
    }
}

/// Reads the place of a light or an eye. A direction has to have a length.
fn place<'a>(
    reader: &mut Reader<'a>,
    text: &'a str,
    what: &str,
    position: &Option<Raw<'a, Numbers>>,
    direction: &Option<Raw<'a, Numbers>>,
) -> Option<crate::truth::Place> {
    let place = attribute::place(reader, text, what, position, direction)?;
    Some(match place {
        Place::Position(position) => crate::truth::Place::Position(wide(position)),
        Place::Direction(vector) => {
            if let Some(raw) = direction {
                long(reader, raw, vector)?;
            }
            crate::truth::Place::Direction(wide(vector))
        }
    })
}

/// Refuses a direction of length zero.
fn long<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, Numbers>, vector: [f32; 3]) -> Option<()> {
    if vector.iter().any(|c| *c != 0.0) {
        return Some(());
    }
    let help = "write the direction toward it, of any length";
    reader.refuse(finding("NB0392", reader.span(raw), "the zero vector points nowhere", "has no direction", help))
}

fn light<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::TruthLight<'a>>) -> Option<Light> {
    let fields = reader.read(raw)?;
    let place = place(reader, raw.text, "light", &fields.position, &fields.direction);
    let color = real_color(&fields.color(reader));
    Some(Light { place: place?, color })
}

fn eye<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::TruthPlace<'a>>) -> Option<Eye> {
    let fields = reader.read(raw)?;
    place(reader, raw.text, "eye", &fields.position, &fields.direction).map(Eye)
}

fn material<'a>(reader: &mut Reader<'a>, raw: &Option<Raw<'a, source::TruthMaterial<'a>>>) -> Material {
    let fields = raw.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
    Material {
        exponent: fields.exponent(reader),
        ambient: real_color(&fields.ambient(reader)),
        diffuse: real_color(&fields.diffuse(reader)),
        specular: real_color(&fields.specular(reader)),
        model: fields.model(reader),
        self_shadowing: fields.self_shadowing(reader),
    }
}

type Occlusion = Option<Arc<Field<1>>>;

fn hemisphere_light<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::TruthHemisphere<'a>>,
) -> (Option<HemisphereLight>, Occlusion) {
    let Some(fields) = reader.read(raw) else { return (None, None) };
    let [x, y, z, _] = fields.axis(reader);
    if let Some(raw) = &fields.axis {
        // This records a finding if the axis has no direction.
        long(reader, raw, [x, y, z]);
    }
    let light = HemisphereLight {
        axis: wide([x, y, z]),
        sky: real_color(&fields.sky(reader)),
        ground: real_color(&fields.ground(reader)),
        integral: fields.integral(reader),
    };
    let occlusion = fields.occlusion.as_ref().and_then(|raw| {
        let (height, options) = heights(reader, raw)?;
        let texels = occlusion::open_sky(&height, &options).into_iter().map(|open| [open]).collect();
        Some(Arc::new(Field { width: height.width, height: height.height, texels, wrap: options.wrap }))
    });
    (Some(light), occlusion)
}

fn normal<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::NormalSource>) -> Option<NormalSource> {
    const KINDS: &[&str] = &["Mesh", "Radial", "Hemisphere", "Height", "NormalMap"];
    let (kind, rest) = reader.variant_of(raw, "source of normals", KINDS, 1)?;
    match KINDS[kind] {
        "Mesh" => Some(NormalSource::Mesh),
        "Radial" => {
            let rest = if rest.is_empty() { "()" } else { rest };
            let [x, y, z, _] = reader.read(&Raw::<source::RadialNormals<'a>>::new(rest))?.center(reader);
            Some(NormalSource::Radial { center: wide([x, y, z]) })
        }
        "Hemisphere" => hemisphere_normals(reader, if rest.is_empty() { "()" } else { rest }),
        "Height" => {
            let (height, options) = heights(reader, &Raw::new(rest))?;
            let texels = normal_map::normals(&height, &options);
            let field = Field { width: height.width, height: height.height, texels, wrap: options.wrap };
            Some(NormalSource::Map(Arc::new(field)))
        }
        _ => {
            let file = only::<String>(reader, rest, "the name of one file")?;
            let image = picture(reader, &file)?;
            Some(NormalSource::Map(Arc::new(field(&image, |[r, g, b, _]| normal_map::decode([r, g, b])))))
        }
    }
}

/// Reads a hemisphere: the exact one, or with noise the generator's normals before they become bytes.
fn hemisphere_normals<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<NormalSource> {
    let fields = reader.read(&Raw::<source::HemisphereNormals<'a>>::new(text))?;
    let zero_outside = fields.zero_outside(reader);
    let (size, seed) = (fields.size(reader), fields.seed(reader));
    let Some(noise) = fields.noise else { return Some(NormalSource::Hemisphere { zero_outside }) };
    let noise = reader.finite(&noise)?;
    let options = hemisphere::Options { size, noise: f64::from(noise), seed: u64::from(seed), zero_outside };
    let texels = hemisphere::vectors(&options);
    Some(NormalSource::Map(Arc::new(Field { width: size, height: size, texels, wrap: false })))
}

/// Reads a height field, and the options to read its heights with.
fn heights<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::HeightFile<'a>>) -> Option<(Rgba, normal_map::Options)> {
    let fields = reader.read(raw)?;
    let file = fields.file(reader)?;
    let image = picture(reader, &file)?;
    let default = normal_map::Options::default();
    let scale = f64::from(fields.scale(reader));
    let channel = [HeightChannel::Red, HeightChannel::Alpha][fields.channel(reader)?];
    Some((image, normal_map::Options { scale, channel, ..default }))
}

/// Reads a picture from the scene's folder.
fn picture<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<Rgba> {
    let limits = ImageLimits {
        maximum_side: reader.limits.texture_side,
        maximum_decoded_bytes: reader.limits.texture_bytes,
        maximum_file_bytes: reader.limits.image_file_bytes,
    };
    texture_source::read_file(reader, raw, limits.file(), |bytes, path| image::decode(bytes, path, &limits))
}

fn field<const N: usize>(image: &Rgba, of: impl Fn([u8; 4]) -> [f64; N]) -> Field<N> {
    let texels = image.pixels.iter().map(|pixel| of(*pixel)).collect();
    Field { width: image.width, height: image.height, texels, wrap: true }
}

fn shading_normal<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::ShadingNormal<'a>>,
    draws: &[LoweredDraw],
) -> Option<ShadingNormal> {
    let fields = reader.read(raw)?;
    let space = fields.space(reader);
    let holder = match (&fields.register, &fields.unit) {
        (Some(_), Some(unit)) => {
            let message = "`unit` and `register` both say where the normals are";
            let help = "leave one of the two out";
            return reader.refuse(finding("NB0393", reader.span(unit), message, "one too many", help));
        }
        (_, Some(written)) => {
            let unit = fields.unit(reader)? as usize;
            normal_unit(reader, reader.span(written), unit, draws)?
        }
        (_, None) => {
            let written = fields.register(reader)?;
            normal_register(reader, &written)?
        }
    };
    Some(ShadingNormal { holder, space })
}

fn normal_register<'a>(reader: &mut Reader<'a>, written: &Raw<'a, Name<Register>>) -> Option<NormalHolder> {
    let register = reader.name(written)?;
    use Register::{PrimaryColor, SecondaryColor, Texture0, Texture1, Texture2, Texture3};
    if matches!(register, Texture0 | Texture1 | Texture2 | Texture3 | PrimaryColor | SecondaryColor) {
        return Some(NormalHolder::Register(register));
    }
    let message = format!("{} holds no normals when a pixel begins", register.name());
    let help = "write Texture0 to Texture3, PrimaryColor or SecondaryColor";
    reader.refuse(finding("NB0393", reader.span(written), message, "not a texture or a colour", help))
}

/// Checks that a unit has a dot product, which reads the normals, in some draw.
fn normal_unit(reader: &mut Reader<'_>, place: Span, unit: usize, draws: &[LoweredDraw]) -> Option<NormalHolder> {
    if draws.iter().any(|drawn| drawn.draw.texture_shader[unit].operation.is_dot()) {
        return Some(NormalHolder::DotProduct(unit));
    }
    let message = format!("unit {unit} of the texture shader takes no dot product in any draw");
    let help = "name a unit whose operation is a dot product or a reflection, or write `register` for one that is read in the combiners";
    reader.refuse(finding("NB0393", place, message, "reads no vector", help))
}
