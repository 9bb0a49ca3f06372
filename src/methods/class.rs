//! The methods of the Xbox's 3D class (Kelvin, 0x97): names, and how far each is followed.
//!
//! Numbers and names are those of envytools' register database and of nxdk's headers (docs/languages/registers.md has the combiners').

use std::sync::OnceLock;

/// The class of the NV2A's 3D engine.
pub const KELVIN: u32 = 0x97;

/// Bytes of methods that a class has.
pub const METHOD_BYTES: u32 = 0x2000;

/// The effect of a method on what an import follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Treatment {
    /// A word of state that draws read.
    State,
    /// Sets a vertex attribute.
    Vertex,
    /// A word of the vertex program.
    Program,
    /// A word of the vertex program's constants.
    Constant,
    /// Part of a draw, or a clear.
    Draw,
    /// Ends a frame.
    Flip,
    /// Changes no pixel, for the reason of [`Method::note`].
    Inert,
    /// Not modelled, for the reason of [`Method::note`].
    Open,
}

impl Treatment {
    const NAMES: [(&'static str, Treatment); 8] = [
        ("state", Treatment::State),
        ("vertex", Treatment::Vertex),
        ("program", Treatment::Program),
        ("constant", Treatment::Constant),
        ("draw", Treatment::Draw),
        ("flip", Treatment::Flip),
        ("inert", Treatment::Inert),
        ("open", Treatment::Open),
    ];

    /// Returns the word for summaries: `modelled`, `inert` or `not modelled`.
    pub fn summary(self) -> &'static str {
        match self {
            Treatment::Inert => "inert",
            Treatment::Open => "not modelled",
            _ => "modelled",
        }
    }
}

/// A method, or an array of methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Method {
    /// Number of the first, in bytes.
    pub number: u32,
    /// Number of elements.
    pub count: u32,
    /// Bytes from one element to the next.
    pub stride: u32,
    /// Words of an element.
    pub words: u32,
    /// Name without the prefix `NV097_`.
    pub name: &'static str,
    /// How far it is followed.
    pub treatment: Treatment,
    /// The reason of [`Treatment::Inert`] and [`Treatment::Open`].
    pub note: &'static str,
}

/// A method of the class, with its place in an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The array.
    pub method: &'static Method,
    /// Index of the element.
    pub element: u32,
    /// Index of the word in the element.
    pub word: u32,
}

impl Place {
    /// Returns the name with its indices: `SET_TEXTURE_OFFSET[2]`, `SET_COMPOSITE_MATRIX[5]`.
    pub fn label(&self) -> String {
        match (self.method.count, self.method.words) {
            (1, 1) => self.method.name.to_owned(),
            (1, _) => format!("{}[{}]", self.method.name, self.word),
            (_, 1) => format!("{}[{}]", self.method.name, self.element),
            _ => format!("{}[{}][{}]", self.method.name, self.element, self.word),
        }
    }
}

const TABLE: &str = include_str!("data/kelvin.tsv");

struct Table {
    methods: Vec<Method>,
    /// For each word of the class's methods, the index of its method and its place.
    places: Vec<Option<(u16, u8, u8)>>,
}

fn table() -> &'static Table {
    static TABLE_ONCE: OnceLock<Table> = OnceLock::new();
    TABLE_ONCE.get_or_init(|| {
        let methods: Vec<Method> = TABLE.lines().skip(1).filter_map(row).collect();
        let mut places = vec![None; (METHOD_BYTES / 4) as usize];
        for (index, method) in methods.iter().enumerate() {
            for element in 0..method.count {
                for word in 0..method.words {
                    let at = (method.number + element * method.stride) / 4 + word;
                    if let Some(place) = places.get_mut(at as usize) {
                        *place = Some((index as u16, element as u8, word as u8));
                    }
                }
            }
        }
        Table { methods, places }
    })
}

/// Reads a row of the table; a test reads all.
fn row(line: &'static str) -> Option<Method> {
    let mut columns = line.split('\t');
    let number = u32::from_str_radix(columns.next()?, 16).ok()?;
    let mut next = || columns.next()?.parse::<u32>().ok();
    let (count, stride, words) = (next()?, next()?, next()?);
    let name = columns.next()?;
    let treatment = columns.next()?;
    let (_, treatment) = Treatment::NAMES.iter().find(|(name, _)| *name == treatment)?;
    Some(Method { number, count, stride, words, name, treatment: *treatment, note: columns.next().unwrap_or("") })
}

/// Returns all methods in the order of their numbers.
pub fn methods() -> &'static [Method] {
    &table().methods
}

/// Returns the method with a number in bytes; `None` if the class has no known method there.
pub fn find(number: u32) -> Option<Place> {
    let table = table();
    let (index, element, word) = (*table.places.get(number as usize / 4)?)?;
    number.is_multiple_of(4).then_some(Place {
        method: &table.methods[usize::from(index)],
        element: element.into(),
        word: word.into(),
    })
}

/// Returns the number and, where there is one, the name of a method: `0x1b00 SET_TEXTURE_OFFSET[0]`.
pub fn label(number: u32) -> String {
    match find(number) {
        Some(place) => format!("0x{number:04x} {}", place.label()),
        None => format!("0x{number:04x}"),
    }
}

/// Declares constants for methods that are read one by one.
macro_rules! numbers {
    ($($name:ident = $number:literal),+ $(,)?) => {
        $(#[doc = concat!("`", stringify!($name), "`.")] pub const $name: u32 = $number;)+
        #[cfg(test)]
        const NUMBERS: &[(&str, u32)] = &[$((stringify!($name), $number)),+];
    };
}
numbers! {
    FLIP_STALL = 0x130, SET_SURFACE_CLIP_HORIZONTAL = 0x200, SET_SURFACE_CLIP_VERTICAL = 0x204, SET_SURFACE_FORMAT = 0x208, SET_SURFACE_PITCH = 0x20c,
    SET_SURFACE_COLOR_OFFSET = 0x210, SET_SURFACE_ZETA_OFFSET = 0x214, SET_CONTROL0 = 0x290, SET_FOG_MODE = 0x29c, SET_FOG_GEN_MODE = 0x2a0,
    SET_FOG_ENABLE = 0x2a4, SET_FOG_COLOR = 0x2a8, SET_WINDOW_CLIP_TYPE = 0x2b4, SET_WINDOW_CLIP_HORIZONTAL = 0x2c0,
    SET_WINDOW_CLIP_VERTICAL = 0x2e0, SET_ALPHA_TEST_ENABLE = 0x300, SET_BLEND_ENABLE = 0x304, SET_CULL_FACE_ENABLE = 0x308,
    SET_DEPTH_TEST_ENABLE = 0x30c, SET_DITHER_ENABLE = 0x310, SET_LIGHTING_ENABLE = 0x314, SET_POINT_PARAMS_ENABLE = 0x318,
    SET_POINT_SMOOTH_ENABLE = 0x31c, SET_LINE_SMOOTH_ENABLE = 0x320, SET_POLY_SMOOTH_ENABLE = 0x324, SET_STENCIL_TEST_ENABLE = 0x32c,
    SET_POLY_OFFSET_POINT_ENABLE = 0x330, SET_POLY_OFFSET_LINE_ENABLE = 0x334, SET_POLY_OFFSET_FILL_ENABLE = 0x338, SET_ALPHA_FUNC = 0x33c,
    SET_ALPHA_REF = 0x340, SET_BLEND_FUNC_SFACTOR = 0x344, SET_BLEND_FUNC_DFACTOR = 0x348, SET_BLEND_COLOR = 0x34c, SET_BLEND_EQUATION = 0x350,
    SET_DEPTH_FUNC = 0x354, SET_COLOR_MASK = 0x358, SET_DEPTH_MASK = 0x35c, SET_STENCIL_MASK = 0x360, SET_STENCIL_FUNC = 0x364,
    SET_STENCIL_FUNC_REF = 0x368, SET_STENCIL_FUNC_MASK = 0x36c, SET_STENCIL_OP_FAIL = 0x370, SET_STENCIL_OP_ZFAIL = 0x374,
    SET_STENCIL_OP_ZPASS = 0x378, SET_SHADE_MODEL = 0x37c, SET_LINE_WIDTH = 0x380, SET_POLYGON_OFFSET_SCALE_FACTOR = 0x384,
    SET_POLYGON_OFFSET_BIAS = 0x388, SET_FRONT_POLYGON_MODE = 0x38c, SET_BACK_POLYGON_MODE = 0x390, SET_CLIP_MIN = 0x394, SET_CLIP_MAX = 0x398,
    SET_CULL_FACE = 0x39c, SET_FRONT_FACE = 0x3a0, SET_SPECULAR_ENABLE = 0x3b8, SET_POINT_SIZE = 0x43c, SET_FOG_PARAMS = 0x9c0,
    SET_FLAT_SHADE_OP = 0x9fc, SET_VIEWPORT_OFFSET = 0xa20, SET_COLOR_KEY_COLOR = 0xae0, SET_VIEWPORT_SCALE = 0xaf0,
    SET_TRANSFORM_PROGRAM = 0xb00, SET_TRANSFORM_CONSTANT = 0xb80, SET_STIPPLE_ENABLE = 0x147c, SET_STIPPLE_PATTERN = 0x1480,
    SET_EDGE_FLAG = 0x16bc, SET_VERTEX_DATA_ARRAY_OFFSET = 0x1720, SET_VERTEX_DATA_ARRAY_FORMAT = 0x1760, SET_LOGIC_OP_ENABLE = 0x17bc, SET_LIGHT_TWO_SIDE_ENABLE = 0x17c4,
    SET_SHADER_CLIP_PLANE_MODE = 0x17f8, SET_BEGIN_END = 0x17fc, ARRAY_ELEMENT16 = 0x1800, ARRAY_ELEMENT32 = 0x1808, DRAW_ARRAYS = 0x1810,
    INLINE_ARRAY = 0x1818, SET_EYE_VECTOR = 0x181c, SET_VERTEX_DATA4F_M = 0x1a00, SET_TEXTURE_OFFSET = 0x1b00, SET_TEXTURE_FORMAT = 0x1b04,
    SET_TEXTURE_ADDRESS = 0x1b08, SET_TEXTURE_CONTROL0 = 0x1b0c, SET_TEXTURE_CONTROL1 = 0x1b10, SET_TEXTURE_FILTER = 0x1b14,
    SET_TEXTURE_IMAGE_RECT = 0x1b1c, SET_TEXTURE_PALETTE = 0x1b20, SET_TEXTURE_BORDER_COLOR = 0x1b24, SET_TEXTURE_SET_BUMP_ENV_MAT = 0x1b28,
    SET_TEXTURE_SET_BUMP_ENV_SCALE = 0x1b38, SET_TEXTURE_SET_BUMP_ENV_OFFSET = 0x1b3c, SET_ZMIN_MAX_CONTROL = 0x1d78,
    SET_ANTI_ALIASING_CONTROL = 0x1d7c, SET_ZSTENCIL_CLEAR_VALUE = 0x1d8c, SET_COLOR_CLEAR_VALUE = 0x1d90, CLEAR_SURFACE = 0x1d94,
    SET_CLEAR_RECT_HORIZONTAL = 0x1d98, SET_CLEAR_RECT_VERTICAL = 0x1d9c, SET_SHADOW_COMPARE_FUNC = 0x1e6c, SET_SHADER_STAGE_PROGRAM = 0x1e70,
    SET_DOT_RGBMAPPING = 0x1e74, SET_SHADER_OTHER_STAGE_INPUT = 0x1e78, SET_TRANSFORM_EXECUTION_MODE = 0x1e94, SET_TRANSFORM_PROGRAM_LOAD = 0x1e9c,
    SET_TRANSFORM_PROGRAM_START = 0x1ea0, SET_TRANSFORM_CONSTANT_LOAD = 0x1ea4,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_read() {
        assert_eq!(methods().len(), TABLE.lines().count() - 1);
        for pair in methods().windows(2) {
            assert!(pair[0].number < pair[1].number, "{}", pair[1].name);
        }
        let explained = |method: &&Method| matches!(method.treatment, Treatment::Inert | Treatment::Open);
        for method in methods().iter().filter(explained) {
            assert!(!method.note.is_empty(), "{} has no reason", method.name);
        }
    }

    #[test]
    fn no_two_methods_share_a_number() {
        let words: u32 = methods().iter().map(|method| method.count * method.words).sum();
        assert_eq!(table().places.iter().flatten().count() as u32, words);
    }

    #[test]
    fn constants_are_the_tables() {
        for (name, number) in NUMBERS {
            let place = find(*number).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((place.method.name, place.element, place.word), (*name, 0, 0));
        }
    }

    #[test]
    fn labels_have_indices() {
        assert_eq!(label(0x1b40), "0x1b40 SET_TEXTURE_OFFSET[1]");
        assert_eq!(label(0x694), "0x0694 SET_COMPOSITE_MATRIX[5]");
        assert_eq!(label(0x1b6c), "0x1b6c SET_TEXTURE_SET_BUMP_ENV_MAT[1][1]");
        assert_eq!(label(0x17fc), "0x17fc SET_BEGIN_END");
        assert_eq!(label(0x1ffc), "0x1ffc");
        assert_eq!((find(0x201), find(0x4_0000)), (None, None));
    }
}
