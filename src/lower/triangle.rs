//! Constants of a triangle, and what they are made of.

use ninebit::state::TEXTURE_UNITS;

use crate::kind::{ANY_BINARY, Kind, Range, is_wide, unpacked};

/// Number of the unit that a printed function has as a parameter.
pub(crate) const ANY_UNIT: usize = TEXTURE_UNITS;

/// Number of the component that a printed function has as a parameter.
pub(crate) const ANY_COMPONENT: usize = 4;

fn index_of(unit: usize) -> String {
    if unit == ANY_UNIT { "unit".to_string() } else { unit.to_string() }
}

/// Returns the name of a unit's value.
pub(crate) fn name_of(unit: usize, value: &str) -> String {
    if unit == ANY_UNIT { value.to_string() } else { format!("unit{unit}_{value}") }
}

/// A part of a number of the vertices, as [`Linear`](ninebit::raster::weights::Linear) has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Part {
    /// That of the second vertex.
    Second,
    /// The difference of the first from it.
    First,
    /// The difference of the third from it.
    Third,
}

impl Part {
    /// All parts, in the order of the variants.
    pub const ALL: [Part; 3] = [Part::Second, Part::First, Part::Third];
}

/// A constant of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Field {
    /// Slope of an edge function along x.
    EdgeX(usize),
    /// Slope of an edge function along y.
    EdgeY(usize),
    /// An edge function at the centre of pixel (0, 0).
    Edge(usize),
    /// 1 if a pixel exactly on the edge belongs to the triangle.
    Owns(usize),
    /// Ratio of w of a vertex; 1 without perspective.
    Ratio(usize),
    /// A colour of a vertex: primary or secondary, channel, vertex.
    Color(usize, usize, usize),
    /// A coordinate of a unit: unit, component, part.
    Coordinate(usize, usize, Part),
    /// The fog coordinate.
    Fog(Part),
    /// The fog byte of all pixels, or -1.
    FogByte,
    /// The depth of a vertex; w for a w buffer.
    Depth(usize),
    /// The difference of a vertex's depth from that of another: that one, the vertex.
    DepthDifference(usize, usize),
    /// Ratio of w of a vertex for a w buffer. For a z buffer 1, or -1 of a vertex behind the eye.
    DepthRatio(usize),
    /// Column or row of a point in 1/16 pixel: axis.
    Sprite(usize),
    /// Size of a point in 1/8 pixel; -1 for other figures.
    SpriteSize,
    /// Mantissa of the offset of depths.
    Offset,
    /// Exponent of the offset of depths.
    OffsetExponent,
}

impl Field {
    /// Returns all constants, in the order of the printed structure.
    pub fn all() -> Vec<Field> {
        let three = [0, 1, 2];
        let edges = three.map(Field::EdgeX).into_iter().chain(three.map(Field::EdgeY)).chain(three.map(Field::Edge));
        let coordinates = (0..16).flat_map(|n| Part::ALL.map(|part| Field::Coordinate(n / 4, n % 4, part)));
        let depths = three.map(Field::Depth).into_iter();
        let depths =
            depths.chain((0..9).map(|n| Field::DepthDifference(n / 3, n % 3))).chain(three.map(Field::DepthRatio));
        let colors = (0..24).map(|n| Field::Color(n / 12, n / 3 % 4, n % 3));
        let others = [Field::FogByte, Field::OffsetExponent, Field::Sprite(0), Field::Sprite(1), Field::SpriteSize];
        let binary =
            three.map(Field::Ratio).into_iter().chain(coordinates).chain(Part::ALL.map(Field::Fog)).chain(depths);
        let numbers = [Field::Offset].into_iter().chain(colors).chain(three.map(Field::Owns)).chain(others);
        edges.chain(binary).chain(numbers).collect()
    }

    /// Returns the kind of the constant.
    pub fn kind(self) -> Kind {
        match self {
            Field::Ratio(_)
            | Field::Coordinate(..)
            | Field::Fog(_)
            | Field::Depth(_)
            | Field::DepthDifference(..)
            | Field::DepthRatio(_) => Kind::Binary,
            _ => Kind::Number,
        }
    }

    /// Returns the words of a constant's value in GLSL and WGSL: one; or two, the lower one first, of a number that may need more than 32 bits; or
    /// mantissa and exponent of a binary number, which is [packed](crate::code::packed).
    pub fn words(self, value: i64) -> Vec<u32> {
        match self {
            field if field.kind() == Kind::Binary => {
                let (mantissa, exponent) = unpacked(value);
                vec![mantissa as u32, exponent as u32]
            }
            field if is_wide(field.range()) => vec![value as u32, (value >> 32) as u32],
            _ => vec![value as u32],
        }
    }

    /// Returns the member of the printed structure.
    pub(crate) fn member(self) -> String {
        match self {
            Field::EdgeX(k) => format!("edge_x[{k}]"),
            Field::EdgeY(k) => format!("edge_y[{k}]"),
            Field::Edge(k) => format!("edge[{k}]"),
            Field::Owns(k) => format!("owns[{k}]"),
            Field::Ratio(k) => format!("ratio[{k}]"),
            Field::Color(set, channel, k) => format!("color[{set}][{channel}][{k}]"),
            Field::Coordinate(unit, component, part) => {
                let component = if component == ANY_COMPONENT { "n".to_string() } else { component.to_string() };
                format!("coordinate[{}][{component}][{}]", index_of(unit), part as usize)
            }
            Field::Fog(part) => format!("fog[{}]", part as usize),
            Field::DepthRatio(k) => format!("depth_ratio[{k}]"),
            Field::Sprite(axis) => format!("sprite[{axis}]"),
            Field::SpriteSize => "sprite_size".to_string(),
            Field::FogByte => "fog_byte".to_string(),
            Field::Depth(k) => format!("depth[{k}]"),
            Field::DepthDifference(reference, k) => format!("depth_difference[{reference}][{k}]"),
            Field::Offset => "offset".to_string(),
            Field::OffsetExponent => "offset_exponent".to_string(),
        }
    }

    pub(crate) fn range(self) -> Range {
        match self {
            Field::EdgeX(_) | Field::EdgeY(_) => (-(1 << 29), 1 << 29),
            Field::Edge(_) => (-(1 << 52), 1 << 52),
            Field::Owns(_) => (0, 1),
            Field::Color(..) => (0, 255),
            Field::Sprite(_) => (-(1 << 16), 1 << 16),
            Field::SpriteSize => (-1, 511),
            Field::FogByte => (-1, 255),
            Field::Offset => (-(1 << 62), 1 << 62),
            Field::OffsetExponent => (-2000, 2000),
            _ => ANY_BINARY,
        }
    }
}

/// What a vertex has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Attribute {
    /// Column or row in 1/16 pixel (RAS-1): axis.
    Position(usize),
    /// z in steps of the depth buffer, binary32.
    Z,
    /// w, binary32.
    W,
    /// A colour byte: primary or secondary, channel.
    Color(usize, usize),
    /// A coordinate, binary32: unit, component.
    Coordinate(usize, usize),
    /// The fog coordinate, or the factor limited to 0..1, binary32.
    Fog,
}

impl Attribute {
    /// Returns the kind of the attribute.
    pub fn kind(self) -> Kind {
        if matches!(self, Attribute::Position(_) | Attribute::Color(..)) { Kind::Number } else { Kind::Word }
    }

    /// Returns the member of the printed structure.
    pub(crate) fn member(self) -> String {
        match self {
            Attribute::Position(axis) => format!("position[{axis}]"),
            Attribute::Z => "z".to_string(),
            Attribute::W => "w".to_string(),
            Attribute::Color(set, channel) => format!("color[{set}][{channel}]"),
            Attribute::Coordinate(unit, component) => format!("coordinate[{}][{component}]", index_of(unit)),
            Attribute::Fog => "fog".to_string(),
        }
    }

    pub(crate) fn range(self) -> Range {
        match self {
            Attribute::Position(_) => (-(1 << 24), 1 << 24),
            Attribute::Color(..) => (0, 255),
            _ => (0, u32::MAX.into()),
        }
    }
}
