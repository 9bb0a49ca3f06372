//! Generates pictures that a scene describes instead of naming a file.

use super::*;

/// A function that returns the colour at a column and row.
type PixelAt = Box<dyn Fn(u32, u32) -> [u8; 4]>;

/// A picture whose pixels have not been packed yet.
pub(super) struct Picture {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) pixels: Vec<[u8; 4]>,
    /// Place of its sides in the text.
    pub(super) place: Span,
}

/// Generates the picture of `Solid(...)`, `Checker(...)` or `Ramp(...)`.
pub(super) fn picture<'a>(reader: &mut Reader<'a>, kind: Variant, text: &'a str, request: &Request) -> Option<Picture> {
    let ((width, height, place), pixel): ((u32, u32, Span), PixelAt) = match kind {
        Variant::Solid => {
            let fields = reader.read(&Raw::<source::SolidImage<'a>>::new(text))?;
            let sides = (fields.width(reader), fields.height(reader));
            let sides = self::sides(reader, sides, request)?;
            let color = fields.color(reader).and_then(|raw| color::constant(reader, &raw))?;
            (sides, Box::new(move |_, _| color))
        }
        Variant::Checker => {
            let fields = reader.read(&Raw::<source::CheckerImage<'a>>::new(text))?;
            let sides = (fields.width(reader), fields.height(reader));
            let sides = self::sides(reader, sides, request)?;
            let cell = fields.cell(reader);
            let colors = fields.colors.as_ref().map(|raw| color::constants(reader, raw));
            let [first, second] = colors.unwrap_or([[255; 4], [0, 0, 0, 255]]);
            (sides, Box::new(move |x, y| if (x / cell + y / cell) % 2 == 0 { first } else { second }))
        }
        _ => {
            let fields = reader.read(&Raw::<source::RampImage<'a>>::new(text))?;
            let sides = (fields.width(reader), fields.height(reader));
            let sides = self::sides(reader, sides, request)?;
            let from = fields.from(reader).and_then(|raw| color::constant(reader, &raw));
            let to = fields.to(reader).and_then(|raw| color::constant(reader, &raw));
            let vertical = fields.axis(reader)? == 1;
            let (from, to, last) = (from?, to?, if vertical { sides.1 - 1 } else { sides.0 - 1 });
            let mix = move |a: u8, b: u8, at: u32| match last {
                0 => a,
                last => ((u32::from(a) * (last - at) + u32::from(b) * at + last / 2) / last) as u8,
            };
            let pixel = move |x: u32, y: u32| {
                let at = if vertical { y } else { x };
                [0, 1, 2, 3].map(|channel| mix(from[channel], to[channel], at))
            };
            (sides, Box::new(pixel))
        }
    };
    afford(reader, place.clone(), u64::from(width) * u64::from(height))?;
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    for y in 0..height {
        pixels.extend((0..width).map(|x| pixel(x, y)));
    }
    Some(Picture { width, height, pixels, place })
}
