//! Lowers inputs of the combiners: register, component, mapping.

use super::*;
use ninebit::legality::{final_mapping, only_final};

/// The parts of an input: index of the mapping, register, and component; mapping and component are `None` if they are not written.
struct Parts<'a, R> {
    mapping: Option<usize>,
    register: R,
    component: Option<(Component, Raw<'a, source::Word>)>,
}

/// Reads `Register`, `(Register, Component)`, `Mapping(Register)` or `Mapping(Register, Component)`.
fn parts<'a, R: Named>(
    reader: &mut Reader<'a>,
    raw: Raw<'a, source::Word>,
    mappings: &[&'static str],
) -> Option<Parts<'a, R>> {
    let (head, rest) = raw.split();
    if let (Some(register), "") = (R::from_name(head), rest) {
        return Some(Parts { mapping: None, register, component: None });
    }
    let mapping = mappings.iter().position(|name| *name == head);
    if mapping.is_none() && !(head.is_empty() && rest.starts_with('(')) {
        return if R::from_name(head).is_some() {
            let message = format!("`{head}` takes nothing in parentheses");
            let help = format!("for a component write `({head}, Alpha)`");
            reader.refuse(finding("NB0205", reader.range(rest), message, "not expected here", help))
        } else if FinalRegister::from_name(head).is_some() {
            reader.refuse(only_final(reader.span(&raw), head, "use it as input A, B, C or D of `final_combiner`"))
        } else {
            let known: Vec<&'static str> = R::NAMES.iter().chain(mappings).copied().collect();
            reader.unknown_variant(&raw, "input", &known)
        };
    }
    let inner = Raw::<Tuple<'a, source::Word>>::new(rest);
    let list = reader.read(&inner)?.0;
    let (register, component) = match list[..] {
        [register] => (register, None),
        [register, component] => (register, Some(component)),
        _ => {
            let message = "an input is a register and perhaps a component";
            let help = "write `(Texture0, Alpha)` or `ExpandNormal(Texture0)`";
            return reader.refuse(finding("NB0211", reader.span(&inner), message, "here", help));
        }
    };
    let name = register.split().0;
    if R::from_name(name).is_none() && FinalRegister::from_name(name).is_some() {
        // The register exists, but not in this combiner.
        return parts(reader, register, &[]);
    }
    let component = match component {
        Some(raw) => Some((reader.name(&raw.as_other())?, raw)),
        None => None,
    };
    Some(Parts { mapping, register: reader.name(&register.as_other())?, component })
}

/// Reads an input of a general portion. Also returns the place of its component if it is written.
pub(super) fn general_input<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::Input>,
    alpha: bool,
) -> Option<(CombinerInput, Option<Span>)> {
    let Parts { mapping, register, component } = parts::<Register>(reader, raw.as_other(), InputMapping::NAMES)?;
    let place = component.as_ref().map(|(_, raw)| reader.span(raw));
    let component = component.map_or(if alpha { Component::Alpha } else { Component::Rgb }, |(written, _)| written);
    let mapping = mapping.map_or(InputMapping::UnsignedIdentity, |index| InputMapping::ALL[index]);
    Some((CombinerInput { register, component, mapping }, place))
}

/// Reads an input of the final combiner; `alpha` says that it is G. Also returns the place of its component if it is written.
pub(super) fn final_input<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::FinalInput>,
    alpha: bool,
) -> Option<(FinalInput, Option<Span>)> {
    let (head, _) = raw.split();
    if let Some(finding) = InputMapping::from_name(head).and_then(|mapping| final_mapping(reader.range(head), mapping))
    {
        return reader.refuse(finding);
    }
    let words = ["UnsignedIdentity", "Invert", "UnsignedInvert"];
    let Parts { mapping, register, component } = parts::<FinalRegister>(reader, raw.as_other(), &words)?;
    let place = component.as_ref().map(|(_, raw)| reader.span(raw));
    let component = component.map_or(if alpha { Component::Alpha } else { Component::Rgb }, |(written, _)| written);
    Some((FinalInput { register, component, invert: mapping.is_some_and(|index| index > 0) }, place))
}
