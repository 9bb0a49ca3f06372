//! Checks that textures are legal on a chip: formats, sides, layers, levels and border texels, by kind.

use crate::diagnostic::{Diagnostic, needs_nv2a, only_nv2a};
use crate::place::Span;
use crate::shown;
use crate::state::{AddressMode, LARGEST_VOLUME, Named, Profile, TextureFormat, TextureKind, TextureUnit};

/// Checks textures for a chip. Each check returns the finding at the given place, or `None` if the texture is legal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureChecks {
    /// The chip that is checked for.
    pub profile: Profile,
    /// Longest side that the [`Limits`](crate::limits::Limits) allow, in texels. The chip may allow less.
    pub largest_side: u32,
}

/// Returns a message that something cannot have these sides.
fn cannot(what: &str, [width, height]: [u32; 2]) -> String {
    format!("{what} cannot be {width} x {height}")
}

/// Returns the finding that a side has no texels.
pub fn no_texels(what: &str, sides: [u32; 2], place: Option<Span>) -> Diagnostic {
    Diagnostic::error("NB0219", place, cannot(what, sides))
        .label("no texels")
        .rule("TEX-7")
        .help("write at least 1 for both")
}

/// Returns the finding that a colour key stands under a filter, or `None` if the filters are nearest.
pub fn filtered_key(unit: &TextureUnit, place: Option<Span>) -> Option<Diagnostic> {
    (!unit.is_nearest()).then(|| {
        Diagnostic::error("NB0402", place, "it is not known what a colour key does under a filter")
            .label("cannot be modelled")
            .rule("KEY-1")
            .help("write `min_filter: Nearest, mag_filter: Nearest`, as programs with keyed textures did")
    })
}

/// Returns the finding that a texture of indices has no palette.
pub fn missing_palette(name: &str, place: Option<Span>) -> Diagnostic {
    Diagnostic::error("NB0234", place, format!("the texture `{name}` is of format P8 and has no palette"))
        .label("which colours?")
        .rule("TEX-1")
        .help("write `palette: \"...\"` in the texture or in this unit")
}

/// Returns the finding that a texture's format reads no palette.
pub fn unread_palette(format: TextureFormat, place: Option<Span>) -> Diagnostic {
    Diagnostic::error("NB0234", place, format!("a texture of format {} reads no palette", format.name()))
        .label("never read")
        .rule("TEX-1")
        .help("leave `palette` out, or write `format: P8`")
}

impl TextureChecks {
    /// Checks the address modes along s and t of a rectangle.
    pub fn rectangle_modes(
        self,
        kind: TextureKind,
        modes: [AddressMode; 2],
        place: Option<Span>,
    ) -> Option<Diagnostic> {
        let other = modes.into_iter().find(|mode| *mode != AddressMode::ClampToEdge)?;
        (kind == TextureKind::Rectangle && self.profile == Profile::Nv10).then(|| {
            let message = format!("a rectangle texture cannot be addressed with {} on Nv10", other.name());
            Diagnostic::error("NB0330", place, message)
                .label("not as a rectangle")
                .rule("TEX-7")
                .help("write `address: ClampToEdge`, or `profile: Nv2a`")
        })
    }

    /// Checks that the chip has the format.
    pub fn format(self, format: TextureFormat, place: Option<Span>) -> Option<Diagnostic> {
        let what = format!("texture format {}", format.name());
        needs_nv2a(self.profile, format.is_nv2a_only(), "NB0320", place, &what, "TEX-1")
    }

    /// Checks the sides: within the limits, powers of two except for rectangles, and square for cube maps.
    pub fn sides(
        self,
        kind: TextureKind,
        format: TextureFormat,
        [width, height]: [u32; 2],
        place: Option<Span>,
    ) -> Option<Diagnostic> {
        let what = match kind {
            TextureKind::TwoDimensional => "a texture",
            TextureKind::Rectangle => "a rectangle texture",
            TextureKind::Cube => "a face of a cube map",
            TextureKind::ThreeDimensional => "a layer of a volume",
        };
        let most = self.largest_side.min(kind.largest_side(format, self.profile));
        if width.max(height) > most {
            return Some(self.too_large(what, [width, height], most, place));
        }
        if width == 0 || height == 0 {
            return Some(no_texels(what, [width, height], place));
        }
        if kind == TextureKind::Rectangle {
            return self.rectangle(format, [width, height], place);
        }
        if format.is_paired() {
            let message = format!("{what} cannot be {}", format.name());
            return Some(
                Diagnostic::error("NB0330", place, message)
                    .label("a linear format")
                    .rule("TEX-1")
                    .help("write `kind: Rectangle`"),
            );
        }
        if !(width.is_power_of_two() && height.is_power_of_two()) {
            let next = |side: u32| side.checked_next_power_of_two().unwrap_or(most).min(most);
            let finding = Diagnostic::error("NB0219", place, cannot(what, [width, height]))
                .label("sides must be powers of two")
                .rule("TEX-7");
            let other = if kind == TextureKind::TwoDimensional { ", or write `kind: Rectangle`" } else { "" };
            return Some(finding.help(format!("make it {} x {}, for example{other}", next(width), next(height))));
        }
        (kind == TextureKind::Cube && width != height).then(|| {
            Diagnostic::error("NB0231", place, cannot("faces of a cube map", [width, height]))
                .label("not square")
                .rule("TEX-12")
                .help("make every face as wide as high")
        })
    }

    /// Returns the finding that a side is too long.
    pub fn too_large(self, what: &str, [width, height]: [u32; 2], most: u32, place: Option<Span>) -> Diagnostic {
        let on = if self.profile == Profile::Nv10 { "; profile Nv2a allows 4096" } else { "" };
        Diagnostic::error("NB0321", place, format!("{what} of {width} x {height} is too large"))
            .label(format!("a side has at most {most} texels on {:?}", self.profile))
            .rule("TEX-7")
            .help(format!("scale it down{on}"))
    }

    /// Checks a rectangle texture. Linear layouts have neither compressed blocks nor palettes; nv10 has four of them,
    /// which need an even width.
    fn rectangle(self, format: TextureFormat, [width, height]: [u32; 2], place: Option<Span>) -> Option<Diagnostic> {
        let (message, help) = if !format.is_linear(Profile::Nv2a) {
            let message = format!("a rectangle texture cannot be {}", format.name());
            (message, "use another format, or another kind")
        } else if !format.is_linear(self.profile) {
            let message = format!("a rectangle texture cannot be {} on Nv10", format.name());
            (message, "use A8R8G8B8, R5G6B5, A1R5G5B5 or I8, or write `profile: Nv2a`")
        } else if self.profile == Profile::Nv10 && width % 2 == 1 {
            let message = format!("a rectangle texture cannot be {width} x {height} on Nv10: its width is odd");
            (message, "make the width even, or write `profile: Nv2a`")
        } else if format.is_paired() && width % 2 == 1 {
            let message = format!("a texture of {} cannot be {width} x {height}: texels lie in pairs", format.name());
            (message, "make the width even")
        } else {
            return None;
        };
        Some(Diagnostic::error("NB0330", place, message).label("not as a rectangle").rule("TEX-7").help(help))
    }

    /// Checks the layers of a volume, which only nv2a has.
    pub fn layers(self, kind: TextureKind, layers: u32, place: Option<Span>) -> Option<Diagnostic> {
        if kind != TextureKind::ThreeDimensional {
            return None;
        }
        if self.profile == Profile::Nv10 {
            return Some(only_nv2a("NB0334", place, "a texture of three dimensions", "VOL-1"));
        }
        let legal = layers.is_power_of_two() && layers <= LARGEST_VOLUME;
        (!legal).then(|| {
            Diagnostic::error("NB0334", place, format!("a volume cannot have {layers} layers"))
                .label("a power of two of them")
                .rule("VOL-1")
                .help(format!("give it 1, 2, 4 and so on, at most {LARGEST_VOLUME}"))
        })
    }

    /// Checks the levels. Rectangles and volumes have a single level.
    pub fn levels(self, kind: TextureKind, levels: u32, place: Option<Span>) -> Option<Diagnostic> {
        let (what, rule, help) = match kind {
            TextureKind::ThreeDimensional => {
                ("volume", "VOL-1", "write `levels: 1`: which of them a volume reads is not known")
            }
            TextureKind::Rectangle => {
                ("rectangle texture", "TEX-9", "write `levels: 1`, or scale it to powers of two and leave `kind` out")
            }
            _ => return None,
        };
        let message = format!("{} cannot have {levels} levels", shown::a(what));
        (levels > 1).then(|| Diagnostic::error("NB0230", place, message).label("one at most").rule(rule).help(help))
    }

    /// Checks the address mode. A border colour is known for nv2a only.
    pub fn address_mode(self, mode: AddressMode, place: Option<Span>) -> Option<Diagnostic> {
        needs_nv2a(self.profile, mode == AddressMode::ClampToBorder, "NB0317", place, "a border colour", "TEX-7")
    }

    /// Checks border texels, which are allowed for uncompressed textures of two dimensions on nv2a.
    pub fn border(self, kind: TextureKind, format: TextureFormat, place: Option<Span>) -> Option<Diagnostic> {
        if self.profile == Profile::Nv10 {
            return Some(only_nv2a("NB0331", place, "a texture with border texels", "TEX-7"));
        }
        if kind == TextureKind::TwoDimensional && !format.is_compressed() {
            return None;
        }
        let what = if format.is_compressed() { format.name() } else { kind.name() };
        let help = "border texels are modelled for uncompressed textures of two dimensions: write `border: false`";
        Some(
            Diagnostic::error("NB0331", place, format!("a texture with border texels cannot be {what}"))
                .label("does not go with it")
                .rule("TEX-7")
                .help(help),
        )
    }
}
