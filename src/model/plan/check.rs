//! Checks that a [`Scene`] is valid, whoever made it. No other place checks all of the state.
//!
//! The front end finds most errors earlier, with their places in the text. A scene that is built in code is checked
//! here first, and nothing after this checks again: indices are in range, sides and counts within the limits, and
//! combinations are those that the chip has. Errors that depend on where vertices end up (RAS-0) are found when
//! triangles are assembled.

use super::PlanError;
use crate::diagnostic::{Diagnostic, Severity, needs_nv2a};
use crate::legality::texture::TextureChecks;
use crate::legality::{self, Notation};
use crate::limits::Limits;
use crate::place::Places;
use crate::raster::GUARD;
use crate::rop::surface;
use crate::state::*;

/// Most errors that are reported, because more would repeat the same.
const MAX_ERRORS: usize = 8;

/// Returns all errors of a scene, except for those of its vertices' positions.
pub(super) fn check(scene: &Scene, limits: &Limits) -> Vec<PlanError> {
    let mut check = Check { scene, limits, draw: None, unit: None, errors: Vec::new() };
    check.counts();
    check.targets();
    check.palettes();
    check.textures();
    for (index, draw) in scene.draws.iter().enumerate() {
        if check.errors.len() >= MAX_ERRORS {
            break;
        }
        check.draw = Some(index);
        check.of_draw(draw);
    }
    check.errors
}

mod raster;
mod unit;

struct Check<'s> {
    scene: &'s Scene,
    limits: &'s Limits,
    /// Index of the draw that is being checked.
    draw: Option<usize>,
    /// Index of its texture unit that is being checked.
    unit: Option<usize>,
    errors: Vec<PlanError>,
}

impl Check<'_> {
    fn refuse(
        &mut self,
        code: &'static str,
        rule: impl Into<Option<&'static str>>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.errors.push(PlanError { draw: self.draw, ..PlanError::new(code, rule, message, help) });
    }

    fn report(&mut self, finding: Diagnostic) {
        let Diagnostic { code, rule, message, help, .. } = finding;
        let error = PlanError::new(code, rule, message, help.unwrap_or_default());
        self.errors.push(PlanError { draw: self.draw, unit: self.unit, ..error });
    }

    /// Refuses a feature that only nv2a has.
    fn only_nv2a(&mut self, code: &'static str, rule: &'static str, has: bool, what: &str) {
        self.accept(needs_nv2a(self.scene.profile, has, code, None, what, rule));
    }

    fn accept(&mut self, finding: Option<Diagnostic>) {
        finding.into_iter().for_each(|finding| self.report(finding));
    }

    /// Returns whether there is no finding about a texture, and refuses it otherwise.
    fn accepts(&mut self, texture: &Texture, finding: Option<Diagnostic>) -> bool {
        let Some(mut finding) = finding else { return true };
        finding.message = format!("texture `{}`: {}", texture.name, finding.message);
        finding.help = Some(format!("{}: {}", finding.label, finding.help.unwrap_or_default()));
        self.report(finding);
        false
    }

    fn texture_checks(&self) -> TextureChecks {
        TextureChecks { profile: self.scene.profile, largest_side: self.limits.texture_side }
    }

    fn counts(&mut self) {
        let Scene { targets, draws, .. } = self.scene;
        let total = |count: fn(&Draw) -> usize| draws.iter().map(count).fold(0, usize::saturating_add);
        let limits = *self.limits;
        for (code, count, most, what) in [
            ("NB0608", targets.len(), limits.targets, "render targets"),
            ("NB0604", draws.len(), limits.draws, "draws"),
            ("NB0603", total(|draw| draw.vertices.len()), limits.vertices, "vertices of all draws"),
            ("NB0609", total(|draw| draw.indices.len()), limits.indices, "indices of all draws"),
            ("NB0605", self.scene.textures.len(), limits.textures, "textures"),
        ] {
            if count > most {
                self.refuse(
                    code,
                    None,
                    format!("{count} {what} are more than {most}"),
                    "`limits::Limits` says what is allowed",
                );
            }
        }
        let side = |target: &Target| u64::from(target.width.min(1 << 16)) * u64::from(target.height.min(1 << 16));
        let bytes = targets.iter().map(|target| side(target) * if target.depth.is_some() { 8 } else { 4 });
        let bytes = bytes.fold(0, u64::saturating_add);
        if bytes > limits.surface_bytes {
            let message = format!("the targets take {bytes} bytes; {} are allowed", limits.surface_bytes);
            self.refuse("NB0607", None, message, "make the targets smaller, or fewer");
        }
        // Textures that share their words are counted separately, because they are decoded separately.
        let bytes: u64 = self.scene.textures.iter().map(texel_bytes).fold(0, u64::saturating_add);
        if bytes > limits.texture_bytes {
            let message = format!("the textures take {bytes} bytes; {} are allowed", limits.texture_bytes);
            self.refuse("NB0607", None, message, "make the textures smaller, or fewer");
        }
    }

    fn targets(&mut self) {
        let most = self.limits.target_side.min((GUARD / 16) as u32);
        let profile = self.scene.profile;
        for target in &self.scene.targets {
            let Target { name, width, height, format, depth, contents, depth_contents, .. } = target;
            for (side, what) in [(*width, "width"), (*height, "height")] {
                if !(1..=most).contains(&side) {
                    let message = format!("the {what} of target `{name}` is {side}");
                    self.refuse("NB0606", "RAS-0", message, format!("take 1 to {most}"));
                }
            }
            if let Some(words) = contents {
                let what = format!("target `{name}` begins with");
                self.contents(target, words, (&what, "ROP-5"), (8 * format.bytes(), format.name()));
            }
            if let Some(words) = depth_contents {
                let what = format!("the depth buffer of target `{name}` begins with");
                match depth.map(|depth| depth.format) {
                    Some(format) => {
                        self.contents(target, words, (&what, "DEP-2"), (format.stored_bits(), format.name()));
                    }
                    None => {
                        let message = format!("target `{name}` has contents of a depth buffer, and no depth buffer");
                        self.refuse("NB0226", None, message, "give it a depth buffer, or no such contents");
                    }
                }
            }
            self.accept(legality::surface::format(*format, profile, None));
            self.accept(depth.and_then(|depth| legality::surface::depth_format(depth.format, profile, None)));
            if let Some(depth) = depth
                && depth.clear >> depth.format.bits() != 0
            {
                let message = format!("target `{name}` clears its depth to {:#x}", depth.clear);
                self.refuse("NB0206", "DEP-2", message, format!("take at most {} bits", depth.format.bits()));
            }
            if let Some(depth) = depth
                && depth.clear_stencil != 0
                && !depth.format.has_stencil()
            {
                let message = format!("target `{name}` clears a stencil that {} does not have", depth.format.name());
                self.refuse("NB0216", "STN-1", message, "take Z24S8, or clear the stencil to 0");
            }
        }
    }

    /// Checks that the contents have one word for each pixel, with no bits above the pixel's.
    fn contents(
        &mut self,
        target: &Target,
        words: &[u32],
        (what, rule): (&str, &'static str),
        (bits, format): (u32, &str),
    ) {
        let pixels = u64::from(target.width) * u64::from(target.height);
        if words.len() as u64 != pixels {
            self.refuse("NB0226", None, format!("{what} {} words", words.len()), format!("its pixels take {pixels}"));
        }
        if bits < 32
            && let Some(at) = words.iter().position(|word| word >> bits != 0)
        {
            let message = format!("{what} {:#x} at word {at}", words[at]);
            self.refuse("NB0226", rule, message, format!("a pixel of {format} has {bits} bits"));
        }
    }

    fn palettes(&mut self) {
        for Palette { name, entries } in &self.scene.palettes {
            if !Palette::LENGTHS.contains(&entries.len()) {
                let message = format!("palette `{name}` has {} entries", entries.len());
                self.refuse("NB0233", "TEX-1", message, "take 32, 64, 128 or 256");
            }
        }
    }

    fn textures(&mut self) {
        for texture in &self.scene.textures {
            if self.errors.len() >= MAX_ERRORS {
                return;
            }
            let name = &texture.name;
            let finding = self.texture_checks().format(texture.format, None);
            self.accepts(texture, finding);
            match &texture.image {
                TextureImage::Texels(texels) => {
                    if self.sides(texture, texels.width, texels.height) {
                        self.texels(texture, texels);
                    }
                }
                TextureImage::Target { target } | TextureImage::Depth { target } => {
                    let Some(shown) = self.scene.targets.get(*target) else {
                        let (message, help) = missing("target", *target, self.scene.targets.len());
                        self.refuse("NB0212", None, format!("texture `{name}` shows {message}"), help);
                        continue;
                    };
                    let of_depths = matches!(texture.image, TextureImage::Depth { .. });
                    let (pixel, texel) = (shown.format.bytes(), texture.format.bytes());
                    let columns = match texture.format.depth() {
                        Some(format) => {
                            let same = shown.depth.is_some_and(|depth| depth.format.bits() == format.bits());
                            (of_depths && same).then_some(shown.width)
                        }
                        // It is not known how texels of another size follow each other in a texture that is not a
                        // rectangle.
                        None if pixel != texel && texture.kind != TextureKind::Rectangle => None,
                        None if of_depths
                            || texture.format.is_compressed()
                            || texture.format.is_paired()
                            || texture.format == TextureFormat::P8 =>
                        {
                            None
                        }
                        None => surface::texel_columns(shown.width, pixel, texel),
                    };
                    if matches!(texture.kind, TextureKind::Cube | TextureKind::ThreeDimensional) || columns.is_none() {
                        let (kind, format) = (texture.kind.name(), texture.format.name());
                        let what = if of_depths { "the depths of " } else { "" };
                        let message =
                            format!("texture `{name}` shows {what}target `{}` as {kind}, {format}", shown.name);
                        let help = "take TwoDimensional or Rectangle, and a format of texels as long as the pixels (a Rectangle may \
                                    have others, whole ones in each row), of depths for a depth buffer";
                        self.refuse("NB0218", "TEX-1", message, help);
                    }
                    self.sides(texture, columns.unwrap_or(shown.width), shown.height);
                }
            }
        }
    }

    /// Returns whether the chip accepts the sides.
    fn sides(&mut self, texture: &Texture, width: u32, height: u32) -> bool {
        let finding = self.texture_checks().sides(texture.kind, texture.format, [width, height], None);
        self.accepts(texture, finding)
    }

    /// Checks levels, border and words of a texture whose sides are legal.
    fn texels(&mut self, texture: &Texture, texels: &Texels) {
        let Texture { name, kind, format, .. } = texture;
        let Texels { width, height, levels, layers, border, words } = texels;
        let checks = self.texture_checks();
        let found = checks.levels(*kind, *levels, None).or_else(|| checks.layers(*kind, *layers, None));
        let found = found.or_else(|| checks.border(*kind, *format, None).filter(|_| *border));
        if !self.accepts(texture, found) {
            return;
        }
        let most = Level::most(*width, *height);
        if !(1..=most).contains(levels) {
            let message = format!("texture `{name}` has {levels} levels");
            self.refuse("NB0230", "TEX-9", message, format!("{} of {width} x {height} take 1 to {most}", kind.name()));
            return;
        }
        if *kind != TextureKind::ThreeDimensional && *layers != 1 {
            let message = format!("texture `{name}` ({}) has {layers} layers", kind.name());
            self.refuse("NB0334", "VOL-1", message, "only a volume has more than one");
            return;
        }
        let faces = if *kind == TextureKind::Cube { CUBE_FACES as usize } else { *layers as usize };
        let expected = faces * Level::chain(*format, *width, *height, *levels, *border).1;
        if words.len() != expected {
            let message = format!("texture `{name}` has {} words", words.len());
            self.refuse("NB0235", "TEX-1", message, format!("its faces and levels take {expected}"));
            return;
        }
        if format.is_paired()
            && let Some(at) = words.as_chunks().0.iter().position(|[a, b]| (a ^ b) & 0xffff != 0)
        {
            let message =
                format!("words {} and {} of texture `{name}` do not have the same chroma", 2 * at, 2 * at + 1);
            self.refuse("NB0206", "TEX-1", message, "give both texels of a pair the same low 16 bits, Cb and Cr");
        }
        let bits = format.word_bits();
        if format.depth().is_none()
            && bits < 32
            && let Some(at) = words.iter().position(|word| word >> bits != 0)
        {
            let message = format!("word {at} of texture `{name}` is {:#x}", words[at]);
            self.refuse("NB0206", "TEX-1", message, format!("a texel of {} has {bits} bits", format.name()));
        }
    }

    fn of_draw(&mut self, draw: &Draw) {
        let count = draw.vertices.len();
        if let Some(at) = draw.indices.iter().position(|index| *index as usize >= count) {
            let message = format!("index {at} is {}, and the draw has {count} vertices", draw.indices[at]);
            self.refuse("NB0212", "RAS-4", message, "indices count vertices from 0");
        }
        if draw.fog.enabled
            && draw.fog.function.is_none()
            && let Some(at) = (0..count).find(|at| draw.vertices.fog(*at).is_nan())
        {
            let message = format!("the fog factor of vertex {at} is no number");
            self.refuse(
                "NB0207",
                "INT-5n",
                message,
                "factors run from 0, all fog, to 1; with a fog function coordinates may be anything",
            );
        }
        self.strokes(draw);
        self.combiners(draw);
        self.units(draw);
        match self.scene.targets.get(draw.target) {
            Some(target) => self.operations(draw, target),
            None => {
                let (message, help) = missing("target", draw.target, self.scene.targets.len());
                self.refuse("NB0212", None, format!("the draw goes into {message}"), help);
            }
        }
    }

    fn operations(&mut self, draw: &Draw, target: &Target) {
        if let Some(test) = &draw.depth_test {
            self.accept(legality::draw::depth_test(target, None));
            self.depth_test(draw, test);
        }
        if draw.stencil_test.is_some() {
            self.accept(legality::draw::stencil_test(target, None));
        }
        if let Some(clip) = &draw.window_clip {
            self.accept(legality::draw::window_clip(clip.rectangles.len(), None));
        }
        let Some(blend) = draw.blend else { return };
        self.accept(legality::surface::blending(target.format, None));
        self.accept(legality::surface::blend_equation(blend.equation, self.scene.profile, None));
    }

    fn combiners(&mut self, draw: &Draw) {
        let checked = legality::check(&draw.combiners, self.scene.profile, &Places::default(), &Words);
        for finding in
            checked.findings.into_iter().filter(|finding| finding.severity == Severity::Error).take(MAX_ERRORS)
        {
            self.report(finding);
        }
    }

    fn units(&mut self, draw: &Draw) {
        let profile = self.scene.profile;
        self.only_nv2a("NB0344", "TEX-19", draw.convert_yuv, "a conversion from YUV");
        for (index, (unit, stage)) in draw.textures.iter().zip(&draw.texture_shader).enumerate() {
            let conventional = matches!(stage.operation, ShaderOperation::None | ShaderOperation::Sample);
            let idle = unit.is_none() && stage.operation == ShaderOperation::None;
            let missing = index >= profile.texture_units() && !idle;
            self.only_nv2a("NB0319", "CMB-12", missing, &format!("texture unit {index}"));
            self.only_nv2a("NB0340", "TSH-10", !conventional, "a texture shader");
            self.stage(draw, index, stage);
            if let Some(unit) = unit {
                self.unit = Some(index);
                self.unit(draw, index, unit, stage);
                self.unit = None;
            } else if stage.operation.samples() {
                self.report(legality::shader::unbound(index, None));
            }
        }
    }

    /// Checks the stage of a unit.
    fn stage(&mut self, draw: &Draw, index: usize, stage: &ShaderStage) {
        let name = stage.operation.name();
        if stage.coordinate_set >= draw.texture_shader.len() {
            let message = format!("stage {index} takes coordinate set {}", stage.coordinate_set);
            self.refuse("NB0319", "TSH-10", message, "a vertex has the sets 0 to 3");
        }
        if stage.previous >= index.max(1) {
            self.report(legality::shader::later_unit(index, stage.previous, None));
        }
        self.accept(legality::shader::order(&draw.texture_shader, index, None, None));
        let finite = match stage.operation {
            ShaderOperation::BumpEnvironment { matrix, luminance } => {
                matrix.iter().chain(luminance.iter().flatten()).all(|number| number.is_finite())
            }
            ShaderOperation::DotReflectConstantEye { eye } => eye.iter().all(|number| number.is_finite()),
            _ => true,
        };
        if !finite {
            self.refuse(
                "NB0207",
                "NUM-0",
                format!("a number of {name} at stage {index} is not finite"),
                "take finite numbers",
            );
        }
    }

    /// Checks a unit, and the texture that it samples.
    fn unit(&mut self, draw: &Draw, index: usize, unit: &TextureUnit, stage: &ShaderStage) {
        let profile = self.scene.profile;
        let Some(texture) = self.scene.textures.get(unit.texture) else {
            let (message, help) = missing("texture", unit.texture, self.scene.textures.len());
            self.refuse("NB0212", None, format!("unit {index} samples {message}"), help);
            return;
        };
        let Texture { name, kind, format, image } = texture;
        if stage.operation.samples() {
            self.accept(legality::shader::kind(&stage.operation, *kind, None));
        }
        match unit.palette {
            Some(palette) if *format == TextureFormat::P8 && palette >= self.scene.palettes.len() => {
                let (message, help) = missing("palette", palette, self.scene.palettes.len());
                self.refuse("NB0212", "TEX-1", format!("unit {index} reads {message}"), help);
            }
            None if *format == TextureFormat::P8 => self.report(legality::texture::missing_palette(name, None)),
            Some(_) if *format != TextureFormat::P8 => {
                self.accepts(texture, Some(legality::texture::unread_palette(*format, None)));
            }
            _ => {}
        }
        if image.target() == Some(draw.target) {
            let message = format!("unit {index} samples the target that the draw goes into");
            self.refuse("NB0217", None, message, "draw into another target and sample that one");
        }
        if unit.color_key.is_some() {
            self.accept(legality::texture::filtered_key(unit, None));
        }
        if unit.color_key.is_some() && matches!(format, TextureFormat::R16B16 | TextureFormat::Y16) {
            let message = format!("a colour key on the format {} is not known", format.name());
            self.refuse("NB0402", "KEY-1", message, "take a format of bytes");
        }
        self.sampling(draw, index, unit, texture);
        let modes = [unit.address_s, unit.address_t];
        if profile == Profile::Nv10 {
            let findings = modes.map(|mode| self.texture_checks().address_mode(mode, None));
            self.accept(findings.into_iter().flatten().next());
            self.only_nv2a("NB0318", "TEX-18", unit.signed != [false; 4], "a signed texture channel");
        }
        let finding = self.texture_checks().rectangle_modes(*kind, modes, None);
        self.accepts(texture, finding);
        let TextureUnit { lod_bias, min_lod, max_lod, .. } = *unit;
        if !(-4096..=4095).contains(&lod_bias) || !(0..=4095).contains(&max_lod) || !(0..=max_lod).contains(&min_lod) {
            let message = format!("unit {index} has lod_bias {lod_bias}, min_lod {min_lod}, max_lod {max_lod}");
            let help =
                "the bias is -4096 to 4095, the least lod 0 to 4095 and at most the greatest, which is at most 4095";
            self.refuse("NB0206", "TEX-9", message, help);
        }
    }
}

/// Returns the bytes of a texture's words.
fn texel_bytes(texture: &Texture) -> u64 {
    match &texture.image {
        TextureImage::Texels(texels) => 4 * texels.words.len() as u64,
        TextureImage::Target { .. } | TextureImage::Depth { .. } => 0,
    }
}

/// Returns message and help for an index past the end of its list.
fn missing(what: &str, index: usize, count: usize) -> (String, String) {
    let help = if count == 0 { format!("add a {what} first") } else { format!("take 0 to {}", count - 1) };
    (format!("{what} {index} of {count}"), help)
}

/// The notation of the state itself.
struct Words;

impl Notation for Words {}
