//! The methods of the 3D classes: names, and how far each is followed.
//!
//! Numbers and names of Kelvin are those of nxdk's headers, those of Celsius of envytools' register database
//! (docs/languages/registers.md has the combiners'). State is read by Kelvin's numbers; [`Family::own`] finds the same state of Celsius.

use std::sync::OnceLock;

use ninebit::state::Profile;

/// The class of the NV2A's 3D engine.
pub const KELVIN: u32 = 0x97;

/// The class of the NV10's 3D engine.
pub const CELSIUS: u32 = 0x56;

/// Bytes of methods that a class has.
pub const METHOD_BYTES: u32 = 0x2000;

/// Classes that share their methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// NV20, NV25 and NV2A.
    #[default]
    Kelvin,
    /// NV10, NV11, NV15 and NV17.
    Celsius,
}

/// The 3D classes that are followed, each with its family.
pub const CLASSES: [(u32, Family); 6] = [
    (KELVIN, Family::Kelvin),
    (0x597, Family::Kelvin),
    (CELSIUS, Family::Celsius),
    (0x96, Family::Celsius),
    (0x98, Family::Celsius),
    (0x99, Family::Celsius),
];

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
    /// Kelvin's number of the same state or command; its own number in Kelvin.
    pub kelvin: Option<u32>,
    /// The reason of [`Treatment::Inert`] and [`Treatment::Open`].
    pub note: &'static str,
}

/// A method of the class, with its place in an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place<'a> {
    /// The array.
    pub method: &'a Method,
    /// Index of the element.
    pub element: u32,
    /// Index of the word in the element.
    pub word: u32,
}

impl Place<'_> {
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

const TABLES: [&str; 2] = [include_str!("data/kelvin.tsv"), include_str!("data/celsius.tsv")];

struct Table {
    methods: Vec<Method>,
    /// For each word of the class's methods, the index of its method and its place.
    places: Vec<Option<[u16; 3]>>,
    /// For each of Kelvin's methods, the number of the same state.
    own: Vec<Option<u16>>,
}

impl Table {
    fn new(family: Family, kelvin: Option<&Table>) -> Table {
        let rows = TABLES[family as usize].lines().skip(1);
        let methods: Vec<Method> = rows.filter_map(|line| row(family, line)).collect();
        let words = (METHOD_BYTES / 4) as usize;
        let mut table = Table { methods, places: vec![None; words], own: vec![None; words] };
        for (index, method) in table.methods.iter().enumerate() {
            for (element, word) in
                (0..method.count).flat_map(|element| (0..method.words).map(move |word| (element, word)))
            {
                let at = (method.number + element * method.stride) / 4 + word;
                if let Some(place) = table.places.get_mut(at as usize) {
                    *place = Some([index as u16, element as u16, word as u16]);
                }
                let place = Place { method: &table.methods[index], element, word };
                let own = match kelvin {
                    None => Some(4 * at),
                    Some(kelvin) => kelvin.counterpart(&place),
                };
                if let Some(slot) = own.and_then(|own| table.own.get_mut(own as usize / 4)) {
                    slot.get_or_insert((4 * at) as u16);
                }
            }
        }
        table
    }

    fn find(&self, number: u32) -> Option<Place<'_>> {
        let [index, element, word] = (*self.places.get(number as usize / 4)?)?;
        number.is_multiple_of(4).then_some(Place {
            method: &self.methods[usize::from(index)],
            element: element.into(),
            word: word.into(),
        })
    }

    /// Returns Kelvin's number, of which this is the table, of a place in another family's. An array of commands is one command there.
    fn counterpart(&self, place: &Place<'_>) -> Option<u32> {
        let first = place.method.kelvin?;
        let there = self.find(first)?.method;
        let element = if there.count > 1 { there.stride * place.element } else { 0 };
        Some(first + element + 4 * place.word)
    }
}

fn table(family: Family) -> &'static Table {
    static KELVINS: OnceLock<Table> = OnceLock::new();
    static CELSIUSES: OnceLock<Table> = OnceLock::new();
    let kelvin = || KELVINS.get_or_init(|| Table::new(Family::Kelvin, None));
    match family {
        Family::Kelvin => kelvin(),
        Family::Celsius => CELSIUSES.get_or_init(|| Table::new(Family::Celsius, Some(kelvin()))),
    }
}

/// Reads a row of a table; a test reads all.
fn row(family: Family, line: &'static str) -> Option<Method> {
    let mut columns = line.split('\t');
    let number = u32::from_str_radix(columns.next()?, 16).ok()?;
    let mut next = || columns.next()?.parse::<u32>().ok();
    let (count, stride, words) = (next()?, next()?, next()?);
    let name = columns.next()?;
    let treatment = columns.next()?;
    let (_, treatment) = Treatment::NAMES.iter().find(|(name, _)| *name == treatment)?;
    let kelvin = match family {
        Family::Kelvin => Some(number),
        Family::Celsius => u32::from_str_radix(columns.next()?, 16).ok(),
    };
    let note = columns.next().unwrap_or("");
    Some(Method { number, count, stride, words, name, treatment: *treatment, kelvin, note })
}

impl Family {
    /// Returns the family of a class; `None` if it is no 3D class that is followed.
    pub fn from_class(class: u32) -> Option<Family> {
        CLASSES.iter().find(|(number, _)| *number == class).map(|(_, family)| *family)
    }

    /// Returns the class that stands for the family.
    pub fn class(self) -> u32 {
        match self {
            Family::Kelvin => KELVIN,
            Family::Celsius => CELSIUS,
        }
    }

    /// Returns the chip whose rules draw.
    pub fn profile(self) -> Profile {
        match self {
            Family::Kelvin => Profile::Nv2a,
            Family::Celsius => Profile::Nv10,
        }
    }

    /// Returns all methods in the order of their numbers.
    pub fn methods(self) -> &'static [Method] {
        &table(self).methods
    }

    /// Returns the method with a number in bytes; `None` if the class has no known method there.
    pub fn find(self, number: u32) -> Option<Place<'static>> {
        table(self).find(number)
    }

    /// Returns Kelvin's number of a method.
    pub fn kelvin(self, place: &Place<'_>) -> Option<u32> {
        table(Family::Kelvin).counterpart(place)
    }

    /// Returns the number of the state that has this number in Kelvin; `None` if the class has no such state.
    pub fn own(self, kelvin: u32) -> Option<u32> {
        table(self).own.get(kelvin as usize / 4).copied().flatten().map(u32::from)
    }

    /// Returns the number and, where there is one, the name of a method: `0x1b00 SET_TEXTURE_OFFSET[0]`.
    pub fn label(self, number: u32) -> String {
        match self.find(number) {
            Some(place) => format!("0x{number:04x} {}", place.label()),
            None => format!("0x{number:04x}"),
        }
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
    SET_SURFACE_COLOR_OFFSET = 0x210, SET_SURFACE_ZETA_OFFSET = 0x214, SET_CONTROL0 = 0x290, SET_LIGHT_CONTROL = 0x294, SET_COLOR_MATERIAL = 0x298, SET_FOG_MODE = 0x29c, SET_FOG_GEN_MODE = 0x2a0,
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
    SET_TEXGEN_VIEW_MODEL = 0x9cc, SET_FLAT_SHADE_OP = 0x9fc, SET_VIEWPORT_OFFSET = 0xa20, SET_COLOR_KEY_COLOR = 0xae0, SET_VIEWPORT_SCALE = 0xaf0,
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

/// Returns the method of texture unit `unit` for the method of unit 0.
pub(crate) fn of_unit(method: u32, unit: usize) -> u32 {
    method + 64 * unit as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    const FAMILIES: [Family; 2] = [Family::Kelvin, Family::Celsius];

    #[test]
    fn every_row_is_read() {
        for family in FAMILIES {
            assert_eq!(family.methods().len(), TABLES[family as usize].lines().count() - 1);
            for pair in family.methods().windows(2) {
                assert!(pair[0].number < pair[1].number, "{}", pair[1].name);
            }
            let explained = |method: &&Method| matches!(method.treatment, Treatment::Inert | Treatment::Open);
            for method in family.methods().iter().filter(explained) {
                assert!(!method.note.is_empty(), "{} has no reason", method.name);
            }
        }
    }

    #[test]
    fn no_two_methods_share_a_number() {
        for family in FAMILIES {
            let words: u32 = family.methods().iter().map(|method| method.count * method.words).sum();
            assert_eq!(table(family).places.iter().flatten().count() as u32, words);
        }
    }

    #[test]
    fn constants_are_the_tables() {
        for (name, number) in NUMBERS {
            let place = Family::Kelvin.find(*number).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((place.method.name, place.element, place.word), (*name, 0, 0));
        }
    }

    /// Combiners have other words there, which are read by their own numbers.
    #[test]
    fn state_of_celsius_has_a_number_of_kelvin() {
        let read = |method: &&Method| !matches!(method.treatment, Treatment::Inert | Treatment::Open);
        for method in Family::Celsius.methods().iter().filter(read) {
            let own_words = ["RC_", "VIEW_MATRIX_ENABLE"].iter().any(|name| method.name.starts_with(name));
            assert_eq!(method.kelvin.is_none(), own_words, "{}", method.name);
            let there = method.kelvin.and_then(|number| Family::Kelvin.find(number));
            assert_eq!(there.is_none(), own_words, "{}", method.name);
            if let Some(there) = there {
                assert_eq!(there.method.treatment, method.treatment, "{}", method.name);
                assert!(there.word == 0 && (there.element == 0 || method.count == 1), "{}", method.name);
            }
        }
        assert_eq!(Family::Celsius.own(SET_TEXTURE_OFFSET + 64), Some(0x21c));
        assert_eq!(Family::Celsius.own(SET_BEGIN_END), Some(0xdfc));
        assert_eq!(Family::Celsius.own(SET_STIPPLE_ENABLE), None);
        assert_eq!(Family::Kelvin.own(SET_TEXTURE_OFFSET + 64), Some(SET_TEXTURE_OFFSET + 64));
        let last = Family::Celsius.find(0x1ffc).expect("inline words end the class");
        assert_eq!(Family::Celsius.kelvin(&last), Some(INLINE_ARRAY));
    }

    #[test]
    fn labels_have_indices() {
        let label = |number| Family::Kelvin.label(number);
        assert_eq!(label(0x1b40), "0x1b40 SET_TEXTURE_OFFSET[1]");
        assert_eq!(label(0x694), "0x0694 SET_COMPOSITE_MATRIX[5]");
        assert_eq!(label(0x1b6c), "0x1b6c SET_TEXTURE_SET_BUMP_ENV_MAT[1][1]");
        assert_eq!(label(0x17fc), "0x17fc SET_BEGIN_END");
        assert_eq!(label(0x1ffc), "0x1ffc");
        assert_eq!((Family::Kelvin.find(0x201), Family::Kelvin.find(0x4_0000)), (None, None));
        assert_eq!(Family::Celsius.label(0x21c), "0x021c TEX_OFFSET[1]");
    }
}
