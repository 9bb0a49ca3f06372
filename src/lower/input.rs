//! The inputs of a printed function.

use crate::kind::{Kind, Range};
use crate::triangle::{Attribute, Field};

/// An input: a number that a pixel or a draw provides. Channels are R, G, B, A.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Input {
    /// The interpolated diffuse colour: channel.
    Primary(usize),
    /// The interpolated specular colour: channel.
    Secondary(usize),
    /// The fog register: channel. Alpha is the fog factor.
    Fog(usize),
    /// The colour that a texture unit yields: unit and channel.
    Texture(usize, usize),
    /// A fetched texel: unit and index. 0 to 3 are the footprint in a level, row by row, 4 to 7 that in the next level.
    Texel(usize, usize),
    /// A weight of a unit's filter, in 256ths: unit and weight.
    Weight(usize, Weight),
    /// The texels that are the border colour: unit. Bit n stands for texel n.
    Outside(usize),
    /// The word that the surface holds.
    Destination,
    /// A constant colour of a general stage: stage, number of the constant, channel.
    StageConstant(usize, usize, usize),
    /// A constant colour of the final combiner: number of the constant, channel.
    FinalConstant(usize, usize),
    /// The draw's fog colour: channel.
    FogColor(usize),
    /// The blend constant: channel.
    BlendConstant(usize),
    /// The reference of the alpha test.
    AlphaReference,
    /// A unit's border colour: unit and channel.
    BorderColor(usize, usize),
    /// A local variable of the printed text.
    Local(Local),
    /// The column of the pixel.
    X,
    /// The row of the pixel.
    Y,
    /// The word that the surface holds, of a whole pixel.
    Held,
    /// The word of the depth buffer: depth, and stencil in the upper byte.
    Depth,
    /// A constant of the triangle.
    Triangle(Field),
    /// What a vertex has: number of the vertex and what.
    Vertex(usize, Attribute),
}

/// A local variable of the printed text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Local {
    /// Name of the variable in the text.
    pub(crate) name: &'static str,
    /// Kind of its value.
    pub(crate) kind: Kind,
    /// Range of its value.
    pub(crate) range: Range,
}

/// A weight of a filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Weight {
    /// The weight of the right texels.
    U,
    /// The weight of the lower texels.
    V,
    /// The weight of the next level's right texels.
    NextU,
    /// The weight of the next level's lower texels.
    NextV,
    /// The weight of the next level.
    Level,
}

impl Weight {
    /// Returns the name of the weight in ports.
    pub(crate) fn name(self) -> &'static str {
        ["u", "v", "next_u", "next_v", "level"][self as usize]
    }
}

impl Input {
    /// Returns the range of the input.
    pub(crate) fn range(self) -> Range {
        match self {
            Input::Texture(..) => (-256, 255),
            Input::Texel(..) | Input::Destination | Input::Held | Input::Depth => (0, 0xffff_ffff),
            Input::Local(local) => local.range,
            Input::X | Input::Y => (0, 4095),
            Input::Triangle(field) => field.range(),
            Input::Vertex(_, attribute) => attribute.range(),
            _ => (0, 255),
        }
    }

    /// Returns the kind of the input.
    pub fn kind(self) -> Kind {
        match self {
            Input::Texel(..) | Input::Destination | Input::Held | Input::Depth => Kind::Word,
            Input::Local(local) => local.kind,
            Input::Triangle(field) => field.kind(),
            Input::Vertex(_, attribute) => attribute.kind(),
            _ => Kind::Number,
        }
    }

    /// Returns whether it is a constant of the draw, not of the pixel.
    pub(crate) fn is_constant(self) -> bool {
        matches!(
            self,
            Input::StageConstant(..)
                | Input::FinalConstant(..)
                | Input::FogColor(_)
                | Input::BlendConstant(_)
                | Input::AlphaReference
                | Input::BorderColor(..)
        )
    }
}
