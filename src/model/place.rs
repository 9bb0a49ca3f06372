//! Parts of a program, and where they are written in a text.

/// A range of bytes in a text.
pub type Span = std::ops::Range<usize>;

/// A part of a program that a finding can point at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// All general stages.
    Stages,
    /// The start of a general stage.
    Stage(usize),
    /// Separate constants of a general stage.
    StageConstants(usize),
    /// Separate constants of the final combiner.
    FinalConstants,
    /// A part of a portion of a general stage.
    General {
        /// Index of the stage.
        stage: usize,
        /// Whether the portion is the alpha portion.
        alpha: bool,
        /// The part of the portion.
        part: Part,
    },
    /// An input of the final combiner, 0 to 6 for A to G.
    FinalInput(usize),
    /// The component of an input of the final combiner, 0 to 6 for A to G, if it is written.
    FinalComponent(usize),
}

/// A part of a portion. Products are numbered 0 (AB) and 1 (CD).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// An input, 0 to 3 for A to D.
    Input(usize),
    /// The component of an input, 0 to 3 for A to D, if it is written.
    Component(usize),
    /// The destination of AB (0), CD (1) or the sum (2).
    Output(usize),
    /// The notation that makes a product a dot product.
    Dot(usize),
    /// The notation that sends the blue of a product to alpha.
    BlueToAlpha(usize),
    /// The output scale.
    Scale,
    /// The output bias.
    Bias,
}

/// The places of a program's parts in its text. A part that is not written has no place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Places(Vec<(Place, Span)>);

impl Places {
    /// Records the place of a part.
    pub fn set(&mut self, place: Place, span: Span) {
        self.0.push((place, span));
    }

    /// Returns the place of a part, or `None` if it is not written.
    pub(crate) fn get(&self, place: Place) -> Option<Span> {
        self.0.iter().find(|(known, _)| *known == place).map(|(_, span)| span.clone())
    }
}
