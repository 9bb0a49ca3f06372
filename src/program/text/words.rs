//! The words of the language: registers, components, mappings.

use ninebit::legality::{Help, Notation};
use ninebit::state::{CombinerInput, Component, FinalInput, FinalRegister, InputMapping, Named as _, Scale};

/// Names of the registers, in the order of [`FinalRegister`]. The last two exist only in the final combiner.
const REGISTERS: &str = "zero const0 const1 fog col0 col1 tex0 tex1 tex2 tex3 spare0 spare1 color_sum final_product";

/// Functions of general inputs, with their mapping and the mapping that they have after a minus, if any.
pub(super) const MAPPINGS: &[(&str, InputMapping, Option<InputMapping>)] = &[
    ("unsigned", InputMapping::UnsignedIdentity, None),
    ("unsigned_invert", InputMapping::UnsignedInvert, None),
    ("expand", InputMapping::ExpandNormal, Some(InputMapping::ExpandNegate)),
    ("half_bias", InputMapping::HalfBiasNormal, Some(InputMapping::HalfBiasNegate)),
];

/// Returns the names of the registers, in the order of [`FinalRegister`].
pub fn registers() -> impl Iterator<Item = &'static str> {
    REGISTERS.split(' ')
}

/// Takes the mapping off an operand: `-expand(tex0.a)` is `tex0.a` by [`InputMapping::ExpandNegate`]. `None` if no mapping is written.
#[must_use]
pub fn take_mapping(operand: &str) -> Option<(InputMapping, &str)> {
    let (is_negative, rest) =
        operand.trim().strip_prefix('-').map_or((false, operand.trim()), |rest| (true, rest.trim()));
    let Some((name, source)) = rest.strip_suffix(')').and_then(|call| call.split_once('(')) else {
        return is_negative.then_some((InputMapping::SignedNegate, rest));
    };
    let (_, mapping, negated) = MAPPINGS.iter().find(|(known, ..)| *known == name.trim())?;
    let mapping = if is_negative { (*negated)? } else { *mapping };
    Some((mapping, source.trim()))
}

pub(super) fn find(name: &str) -> Option<FinalRegister> {
    registers().position(|known| known == name).map(|number| FinalRegister::ALL[number])
}

/// Returns the name of a register.
pub fn register(register: impl Into<FinalRegister>) -> &'static str {
    registers().nth(register.into() as usize).unwrap_or_default()
}

/// Prints a register with its component. In an alpha portion (`alpha`) the component is always printed, except for zero.
pub(crate) fn source(of: impl Into<FinalRegister>, component: Component, alpha: bool) -> String {
    let of = of.into();
    let plain = if alpha { Component::Alpha } else { Component::Rgb };
    let name = register(of);
    match component {
        Component::Rgb if component != plain => format!("{name}.rgb"),
        Component::Blue => format!("{name}.b"),
        Component::Alpha if component != plain || of != FinalRegister::Zero => format!("{name}.a"),
        Component::Rgb | Component::Alpha => name.to_owned(),
    }
}

/// Prints an input of a general stage.
pub(crate) fn operand(input: &CombinerInput, alpha: bool) -> String {
    mapped(input.mapping, source(input.register, input.component, alpha))
}

/// Prints a source with the function of a mapping.
pub fn mapped(mapping: InputMapping, source: String) -> String {
    match mapping {
        InputMapping::UnsignedIdentity => format!("unsigned({source})"),
        InputMapping::UnsignedInvert => format!("unsigned_invert({source})"),
        InputMapping::ExpandNormal => format!("expand({source})"),
        InputMapping::ExpandNegate => format!("-expand({source})"),
        InputMapping::HalfBiasNormal => format!("half_bias({source})"),
        InputMapping::HalfBiasNegate => format!("-half_bias({source})"),
        InputMapping::SignedIdentity => source,
        InputMapping::SignedNegate => format!("-{source}"),
    }
}

/// Prints an input of the final combiner; `alpha` says that it is G.
pub(crate) fn final_operand(input: &FinalInput, alpha: bool) -> String {
    let source = source(input.register, input.component, alpha);
    if input.invert { format!("unsigned_invert({source})") } else { source }
}

/// Returns the name of the statement that sets a scale; `None` for scale one.
pub(super) fn scale(scale: Scale) -> Option<&'static str> {
    match scale {
        Scale::One => None,
        Scale::Two => Some("scale_by_two"),
        Scale::Four => Some("scale_by_four"),
        Scale::Half => Some("scale_by_one_half"),
    }
}

/// The language's notation for findings about legality.
#[derive(Clone, Copy, Debug)]
pub struct Words;

impl Notation for Words {
    fn register(&self, of: FinalRegister) -> &'static str {
        register(of)
    }

    fn help(&self, help: Help) -> &'static str {
        match help {
            Help::EmptyStage => "write `{}` for a stage that changes nothing",
            Help::SharedConstants => {
                "give all stages and the final combiner the same constants, outside the stages; profile Nv2a allows own ones"
            }
            Help::OtherRegister => "send one of them to another register, or to `discard`",
            Help::BiasScale => "with a bias the scale is one or two",
            Help::FogColor => "read `fog` without a component here",
            Help::FogBlue => "write `fog.b` for the fog colour's blue",
            Help::SecondaryAlpha => "profile Nv2a defines it: write `profile: Nv2a`, or read `col0.a`",
            Help::RgbComponents | Help::FinalComponents => "read the register as it is, or its `.a`",
            Help::AlphaComponents => "read its `.a` (also without a component) or `.b`",
            Help::FinalAlphaComponents => "`out.a` reads `.a` (also without a component) or `.b`",
            Help::Writable => "write to spare0, spare1, col0, col1 or a texture register",
            Help::OtherInput => "read spare0 or another register",
        }
    }
}
