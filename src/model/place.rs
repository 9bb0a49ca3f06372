//! Parts of a program, and where they stand in a text.

/// A part of a text: its bytes from `start` to before `end`.
pub type Span = std::ops::Range<usize>;

/// A part of a program that a finding can point at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// All general stages.
    Stages,
    /// The beginning of a general stage.
    Stage(usize),
    /// Constants of its own that a general stage has.
    StageConstants(usize),
    /// Constants of its own that the final combiner has.
    FinalConstants,
    /// Part of a portion of a general stage.
    General {
        /// Index of the stage.
        stage: usize,
        /// The alpha portion.
        alpha: bool,
        /// Which part of the portion.
        part: Part,
    },
    /// An input of the final combiner: 0 to 6 for A to G.
    FinalInput(usize),
    /// The component of an input of the final combiner, if it is written.
    FinalComponent(usize),
}

/// A part of a portion. Products are 0 (AB) and 1 (CD).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// An input: 0 to 3 for A to D.
    Input(usize),
    /// The component of an input, if it is written.
    Component(usize),
    /// A destination: of AB, of CD, of the sum.
    Output(usize),
    /// What makes a product a dot product.
    Dot(usize),
    /// What sends the blue of a product to alpha.
    BlueToAlpha(usize),
    /// The output scale.
    Scale,
    /// The output bias.
    Bias,
}

/// Where the parts of a program stand: bytes of its text. What is not written has no place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Places(Vec<(Place, Span)>);

impl Places {
    /// Notes a place.
    pub fn set(&mut self, place: Place, span: Span) {
        self.0.push((place, span));
    }

    /// Where a part stands; `None` if it is not written.
    pub fn get(&self, place: Place) -> Option<Span> {
        self.0.iter().find(|(known, _)| *known == place).map(|(_, span)| span.clone())
    }
}
