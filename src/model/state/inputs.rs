//! Inputs of the combiners by their names, for programs that are written in code.

use super::{CombinerInput, Component, FinalCombiner, FinalInput, FinalRegister, InputMapping, Portion, Register};

impl Register {
    /// Returns an input that reads R, G and B by the unsigned identity.
    pub fn rgb(self) -> CombinerInput {
        CombinerInput { register: self, ..CombinerInput::zero(Component::Rgb) }
    }

    /// Returns an input that reads the alpha by the unsigned identity.
    pub fn alpha(self) -> CombinerInput {
        CombinerInput { component: Component::Alpha, ..self.rgb() }
    }

    /// Returns an input of an alpha portion that reads blue by the unsigned identity.
    pub fn blue(self) -> CombinerInput {
        CombinerInput { component: Component::Blue, ..self.rgb() }
    }
}

impl CombinerInput {
    /// Returns the input with another mapping.
    #[must_use]
    pub fn mapped(self, mapping: InputMapping) -> CombinerInput {
        CombinerInput { mapping, ..self }
    }
}

impl FinalRegister {
    /// Returns an input of A to F that reads R, G and B.
    pub fn rgb(self) -> FinalInput {
        FinalInput { register: self, ..FinalInput::zero(Component::Rgb) }
    }

    /// Returns an input that reads the alpha.
    pub fn alpha(self) -> FinalInput {
        FinalInput { component: Component::Alpha, ..self.rgb() }
    }

    /// Returns an input G that reads blue.
    pub fn blue(self) -> FinalInput {
        FinalInput { component: Component::Blue, ..self.rgb() }
    }
}

impl FinalInput {
    /// Returns the input with the other mapping: unsigned invert for unsigned identity, and the other way round.
    #[must_use]
    pub fn inverted(self) -> FinalInput {
        FinalInput { invert: !self.invert, ..self }
    }
}

macro_rules! inputs {
    ($owner:ident reads $input:ident: $($letter:ident $name:literal $index:literal),+) => {
        impl $owner {
            $(
                #[doc = concat!("Returns it with input ", $name, ".")]
                #[must_use]
                pub fn $letter(mut self, input: $input) -> $owner {
                    self.inputs[$index] = input;
                    self
                }
            )+
        }
    };
}
inputs!(Portion reads CombinerInput: a "A" 0, b "B" 1, c "C" 2, d "D" 3);
inputs!(FinalCombiner reads FinalInput: a "A" 0, b "B" 1, c "C" 2, d "D" 3, e "E" 4, f "F" 5);

impl FinalCombiner {
    /// Returns it with input G.
    #[must_use]
    pub fn g(mut self, input: FinalInput) -> FinalCombiner {
        self.g = input;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_stand_where_their_names_say() {
        let input = |register: Register| register.alpha().mapped(InputMapping::HalfBiasNegate);
        let registers = [Register::Texture0, Register::Texture1, Register::Fog, Register::Spare1];
        let [a, b, c, d] = registers.map(input);
        let portion = Portion::idle(Component::Rgb).d(d).c(c).b(b).a(a);
        for (read, register) in portion.inputs.iter().zip(registers) {
            let (component, mapping) = (Component::Alpha, InputMapping::HalfBiasNegate);
            assert_eq!(*read, CombinerInput { register, component, mapping });
        }
        assert_eq!(Register::Zero.rgb(), CombinerInput::zero(Component::Rgb));
        assert_eq!(Register::Spare0.blue().component, Component::Blue);
    }

    #[test]
    fn opengl_s_final_combiner_is_written_by_names() {
        let written = FinalCombiner::default()
            .a(FinalRegister::Fog.alpha())
            .b(FinalRegister::Spare0PlusSecondary.rgb())
            .c(FinalRegister::Fog.rgb())
            .g(FinalRegister::Spare0.alpha());
        assert_eq!(written, FinalCombiner::initial([[0; 4]; 2]));
        let others = FinalCombiner::default().d(FinalRegister::Zero.rgb().inverted()).e(FinalRegister::Fog.rgb());
        let others = others.f(FinalRegister::Texture0.alpha()).g(FinalRegister::Texture0.blue());
        assert!(others.inputs[3].invert && others.inputs[4] == FinalRegister::Fog.rgb());
        assert_eq!((others.inputs[5].component, others.g.component), (Component::Alpha, Component::Blue));
    }
}
