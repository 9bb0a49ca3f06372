//! What a printed function is given.

use crate::code::{Kind, Range};

/// One of the numbers that a pixel or a draw brings. Channels are R, G, B, A.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Input {
    /// The interpolated diffuse: a channel.
    Primary(usize),
    /// The interpolated specular: a channel.
    Secondary(usize),
    /// The fog register: a channel. Alpha is the factor.
    Fog(usize),
    /// What a unit yields: unit and channel.
    Texture(usize, usize),
    /// A fetched texel of a unit: unit and place. 0 to 3 are the footprint of a level, row by row, 4 to 7 that of the next.
    Texel(usize, usize),
    /// A weight of a unit's filter, in 256ths.
    Weight(usize, Weight),
    /// Which texels of a unit are the border colour: bit n is texel n.
    Outside(usize),
    /// The word that the surface holds.
    Destination,
    /// A constant colour of a general stage: stage, which of the two, channel.
    StageConstant(usize, usize, usize),
    /// A constant colour of the final combiner: which of the two, channel.
    FinalConstant(usize, usize),
    /// A channel of the draw's fog colour.
    FogColor(usize),
    /// A channel of the blend constant.
    BlendConstant(usize),
    /// The reference of the alpha test.
    AlphaReference,
    /// A channel of a unit's border colour: unit and channel.
    BorderColor(usize, usize),
    /// A variable of the text that the value stands in.
    Local(Local),
}

/// A variable of the text that a value stands in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Local {
    /// How it is written.
    pub name: &'static str,
    /// What it is.
    pub kind: Kind,
    /// What it can be.
    pub range: Range,
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
    /// All of them, in their order.
    pub const ALL: [Weight; 5] = [Weight::U, Weight::V, Weight::NextU, Weight::NextV, Weight::Level];

    /// The name of a port.
    pub fn name(self) -> &'static str {
        ["u", "v", "next_u", "next_v", "level"][self as usize]
    }
}

impl Input {
    /// What it can be.
    pub fn range(self) -> Range {
        match self {
            Input::Texture(..) => (-256, 255),
            Input::Texel(..) | Input::Destination => (0, 0xffff_ffff),
            Input::Local(local) => local.range,
            _ => (0, 255),
        }
    }

    /// What it is.
    pub fn kind(self) -> Kind {
        match self {
            Input::Texel(..) | Input::Destination => Kind::Word,
            Input::Local(local) => local.kind,
            _ => Kind::Number,
        }
    }

    /// Whether it belongs to the draw and not to the pixel.
    pub fn is_constant(self) -> bool {
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
