//! Probes of the raster operations (ROP-1 to ROP-6), and of surfaces that are read back.

use crate::probes::{Answers, single};
use crate::sheet::{ALPHA_ONLY, OVER, RGB_ONLY, Sheet, bind, cell, copy, opaque};
use crate::table::{Row, bytes};
use ninebit::state::*;
use std::collections::BTreeMap;

/// A sequence of draws of the blend tests, which ends in one texel.
#[derive(Clone, Copy)]
enum Stack {
    /// Draws levels 1 to n, each of which stores RGB and blends alpha.
    A,
    /// Draws one level, which blends all channels.
    B,
    /// Draws one level, which blends RGB and stores alpha.
    C,
}

impl Stack {
    fn colors(self, level: usize) -> Vec<[u8; 4]> {
        const LEVELS: [[u8; 4]; 4] = [[0, 204, 0, 127], [204, 0, 0, 255], [0, 0, 255, 128], [255, 255, 255, 0]];
        match (self, level) {
            (Stack::A, n) => LEVELS[..n].to_vec(),
            (Stack::B, 1) | (Stack::C, 4) => vec![[255, 255, 255, 221]],
            (Stack::B, 2) => vec![[0, 0, 221, 221]],
            (Stack::B, 4) | (Stack::C, 1) => vec![[0, 221, 0, 221]],
            (_, level) => panic!("no level {level}"),
        }
    }

    /// Returns the passes for each colour: the channels that are drawn, and whether they are blended.
    fn passes(self) -> &'static [([bool; 4], bool)] {
        match self {
            Stack::A => &[(RGB_ONLY, false), (ALPHA_ONLY, true)],
            Stack::B => &[([true; 4], true)],
            Stack::C => &[(RGB_ONLY, true), (ALPHA_ONLY, false)],
        }
    }
}

/// Draws the stack on a texture, and the texture over a grey background.
fn stacks(rows: &[Row], stack: impl Fn(&Row) -> Stack) -> Answers {
    let mut sheet = Sheet::new();
    let canvas = sheet.target(SurfaceFormat::A8R8G8B8, [0; 4]);
    let frame = sheet.target(SurfaceFormat::A8R8G8B8, [0; 4]);
    let texture = sheet.reads(canvas, TextureFormat::A8R8G8B8);
    for (n, row) in rows.iter().enumerate() {
        let stack = stack(row);
        sheet.draw(cell(canvas, n, row.bytes("texel")));
        for color in stack.colors(row.number("level")) {
            for (color_mask, blended) in stack.passes() {
                let blend = blended.then(|| row.blend());
                sheet.draw(Draw { color_mask: *color_mask, blend, blend_constant: [85; 4], ..cell(canvas, n, color) });
            }
        }
        let grey: u8 = row.number("background");
        sheet.draw(cell(frame, n, [grey, grey, grey, 255]));
    }
    sheet.draw(Draw { blend: Some(OVER), ..copy(frame, texture) });
    single(sheet.show(frame, rows.len()))
}

/// Draws the rows of `blend-stack-a`.
pub fn stack_a(rows: &[Row]) -> Answers {
    stacks(rows, |_| Stack::A)
}

/// Draws the rows of `blend-stack-b`.
pub fn stack_b(rows: &[Row]) -> Answers {
    stacks(rows, |_| Stack::B)
}

/// Draws the rows of `blend-stack-c`.
pub fn stack_c(rows: &[Row]) -> Answers {
    stacks(rows, |_| Stack::C)
}

/// Draws the rows of `blend-spot`.
pub fn spot(rows: &[Row]) -> Answers {
    stacks(rows, |row| match row.text("stack") {
        "A" => Stack::A,
        "B" => Stack::B,
        "C" => Stack::C,
        other => panic!("no stack {other}"),
    })
}

/// Adds a target of every format, and returns a function that finds them.
fn surfaces(sheet: &mut Sheet) -> impl Fn(SurfaceFormat) -> usize + use<> {
    let targets: Vec<usize> = SurfaceFormat::ALL.iter().map(|format| sheet.target(*format, [0; 4])).collect();
    move |format| targets[SurfaceFormat::ALL.iter().position(|f| *f == format).unwrap()]
}

/// Draws the rows of `surface-blend`: several blends on a surface, which is then shown by a texture unit.
pub fn surface(rows: &[Row]) -> Answers {
    let mut sheet = Sheet::new();
    let surfaces = surfaces(&mut sheet);
    let frame = sheet.target(SurfaceFormat::A8R8G8B8, [0; 4]);
    for (n, row) in rows.iter().enumerate() {
        let format: SurfaceFormat = row.named("format");
        let canvas = surfaces(format);
        let blend =
            Blend { equation: BlendEquation::Add, source: row.named("source"), destination: row.named("destination") };
        sheet.draw(cell(canvas, n, row.bytes("cleared")));
        for color in row.list("colors") {
            sheet.draw(Draw { blend: Some(blend), ..cell(canvas, n, bytes(color)) });
        }
        let texture = sheet.reads(canvas, format.texture_format());
        let mut shown = cell(frame, n, [255; 4]);
        bind(&mut shown, 0, texture);
        shown.combiners = Combiners::showing(FinalRegister::Texture0);
        opaque(&mut shown);
        sheet.draw(shown);
    }
    single(sheet.show(frame, rows.len()))
}

/// Draws the rows of `destination-alpha`: one blend with the destination's alpha as the source factor, shown over grey.
pub fn destination_alpha(rows: &[Row]) -> Answers {
    let mut sheet = Sheet::new();
    let surfaces = surfaces(&mut sheet);
    let frame = sheet.target(SurfaceFormat::A8R8G8B8, [85, 85, 85, 255]);
    for (n, row) in rows.iter().enumerate() {
        let format: SurfaceFormat = row.named("format");
        let canvas = surfaces(format);
        let blend = Blend { equation: BlendEquation::Add, source: row.named("source"), destination: BlendFactor::Zero };
        sheet.draw(cell(canvas, n, [0, 0, 0, row.number("cleared_alpha")]));
        sheet.draw(Draw { blend: Some(blend), ..cell(canvas, n, [255, 255, 255, 34]) });
        let mut shown = cell(frame, n, [255; 4]);
        shown.combiners = Combiners::showing(FinalRegister::Texture0);
        shown.blend = Some(OVER);
        let read_as = match format {
            SurfaceFormat::X1R5G5B5Z | SurfaceFormat::X1R5G5B5O => TextureFormat::A1R5G5B5,
            SurfaceFormat::R5G6B5 => TextureFormat::R5G6B5,
            _ => TextureFormat::A8R8G8B8,
        };
        bind(&mut shown, 0, sheet.reads(canvas, read_as));
        if row.text("shown") == "opaque" {
            opaque(&mut shown);
        }
        sheet.draw(shown);
    }
    single(sheet.show(frame, rows.len()))
}

/// Draws the rows of `signed-texel`: a signed channel, shown by one blend.
pub fn signed_texel(rows: &[Row]) -> Answers {
    let mut sheet = Sheet::new();
    let frame = sheet.target(SurfaceFormat::A8R8G8B8, [0; 4]);
    let channel = |row: &Row| "rgba".find(row.text("channel")).unwrap();
    let texture = sheet.texels(rows.iter().map(|row| {
        let fill = if channel(row) == 3 { 255 } else { 0 };
        let mut texel = [fill, fill, fill, row.number("alpha")];
        texel[channel(row)] = row.number("byte");
        texel
    }));
    for (n, row) in rows.iter().enumerate() {
        let grey: u8 = row.number("destination");
        sheet.draw(cell(frame, n, [grey, grey, grey, 255]));
        let mut shown = cell(frame, n, [255; 4]);
        bind(&mut shown, 0, texture);
        shown.textures[0].as_mut().unwrap().signed[channel(row)] = row.flag("signed");
        shown.combiners = Combiners::showing(FinalRegister::Texture0);
        shown.blend = Some(Blend { equation: row.named("equation"), ..OVER });
        sheet.draw(shown);
    }
    single(sheet.show(frame, rows.len()))
}

/// Draws the rows of `alpha-test`.
pub fn alpha_test(rows: &[Row]) -> Answers {
    let mut sheet = Sheet::new();
    let frame = sheet.target(SurfaceFormat::A8R8G8B8, [0; 4]);
    for (n, row) in rows.iter().enumerate() {
        sheet.draw(cell(frame, n, row.bytes("destination")));
        let [r, g, b] = row.bytes("source");
        let mut tested = cell(frame, n, [r, g, b, row.number("alpha")]);
        tested.alpha_test = row.flag("enabled").then(|| AlphaTest { function: row.named("function"), reference: 127 });
        tested.blend = Some(OVER);
        sheet.draw(tested);
    }
    single(sheet.show(frame, rows.len()))
}

/// Draws the rows of `color-key`: a texel with a key over a background.
pub fn color_key(rows: &[Row]) -> Answers {
    let mut sheet = Sheet::new();
    let frame = sheet.target(SurfaceFormat::A8R8G8B8, [0; 4]);
    let mut textures = BTreeMap::new();
    for format in [TextureFormat::A8R8G8B8, TextureFormat::X8R8G8B8] {
        textures.insert(format.name(), sheet.texels_of(format, rows.iter().map(|row| row.bytes("texel"))));
    }
    for (n, row) in rows.iter().enumerate() {
        sheet.draw(cell(frame, n, row.bytes("background")));
        let mut keyed = cell(frame, n, [255; 4]);
        bind(&mut keyed, 0, textures[row.text("format")]);
        if let Some(unit) = &mut keyed.textures[0] {
            let key = || ColorKey { color: row.bytes("key"), mode: row.named("mode") };
            unit.color_key = (row.text("mode") != "-").then(key);
        }
        keyed.combiners = Combiners::showing(FinalRegister::Texture0);
        if row.flag("blended") {
            keyed.blend = Some(OVER);
        } else {
            opaque(&mut keyed);
        }
        sheet.draw(keyed);
    }
    single(sheet.show(frame, rows.len()))
}

/// Draws the rows of `color-mask`: the last draw must not change alpha.
pub fn color_mask(rows: &[Row]) -> Answers {
    let mut sheet = Sheet::new();
    let frame = sheet.target(SurfaceFormat::A8R8G8B8, [0; 4]);
    for (n, row) in rows.iter().enumerate() {
        sheet.draw(cell(frame, n, [34, 34, 34, row.number("cleared_alpha")]));
        if row.text("drawn_alpha") != "-" {
            sheet.draw(Draw { blend: Some(OVER), ..cell(frame, n, [200, 150, 100, row.number("drawn_alpha")]) });
        }
        let blend = Blend {
            equation: BlendEquation::Add,
            source: BlendFactor::DestinationAlpha,
            destination: BlendFactor::Zero,
        };
        sheet.draw(Draw { blend: Some(blend), color_mask: RGB_ONLY, ..cell(frame, n, [90, 80, 70, 60]) });
    }
    single(sheet.show(frame, rows.len()))
}

/// Draws the rows of `alpha-chain`: the captured programs draw a texture onto itself n times, whereas this draws from one surface to the
/// next.
pub fn alpha_chain(rows: &[Row]) -> Answers {
    let answer = |row: &Row| {
        let mut sheet = Sheet::new();
        let mut texture = sheet.texels(std::iter::once(row.bytes("texel")));
        for _ in 0..row.number("passes") {
            let surface = sheet.target(SurfaceFormat::A8R8G8B8, [0; 4]);
            sheet.draw(copy(surface, texture));
            let mut pass = Draw { blend: Some(OVER), ..copy(surface, texture) };
            let stage = &mut pass.combiners.stages[0];
            stage.constants[0][3] = row.number("constant");
            stage.alpha.inputs[0].register = Register::Texture0;
            stage.alpha.inputs[1].register = Register::ConstantColor0;
            stage.alpha.ab_output = Register::Spare0;
            pass.combiners.final_combiner.g.register = FinalRegister::Spare0;
            sheet.draw(pass);
            texture = sheet.reads(surface, TextureFormat::A8R8G8B8);
        }
        let frame = sheet.target(SurfaceFormat::A8R8G8B8, row.bytes("destination"));
        sheet.draw(Draw { blend: Some(OVER), ..copy(frame, texture) });
        sheet.show(frame, 1)
    };
    rows.iter().map(answer).collect()
}
