//! Inputs of the combiners: register, component, mapping, and which of them go together (CMB-12).

use super::combiner::Walk;
use super::*;
use crate::scene::raw::Tuple;
use crate::state::{CombinerInput, Component, FinalInput, FinalRegister, InputMapping, Named, Register};

/// NV10 has two texture registers.
pub(super) fn on_chip(reader: &mut Reader<'_>, register: &str, place: Range<usize>) {
    if matches!(register, "Texture2" | "Texture3") && reader.profile == Profile::Nv10 {
        reader.push(target::only_nv2a("NB0302", place, &format!("register {register}"), "CMB-12"));
    }
}

/// An input taken apart: index of the mapping (`None`: none written), the register, the component if written.
struct Parts<'a, R> {
    mapping: Option<usize>,
    register: R,
    component: Option<(Component, Raw<'a, source::Word>)>,
}

/// `Register`, `(Register, Component)`, `Mapping(Register)` or `Mapping(Register, Component)`.
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
        if R::from_name(head).is_some() {
            reader.push(
                Diagnostic::error("NB0205", reader.range(rest), format!("`{head}` takes nothing in parentheses"))
                    .label("not expected here")
                    .help(format!("for a component write `({head}, Alpha)`")),
            );
        } else if FinalRegister::from_name(head).is_some() {
            reader.push(
                Diagnostic::error("NB0313", reader.span(&raw), format!("{head} exists only in the final combiner"))
                    .label("not in a general stage")
                    .rule("CMB-12")
                    .help("use it as input A, B, C or D of `final_combiner`"),
            );
        } else {
            let known: Vec<&'static str> = R::NAMES.iter().chain(mappings).copied().collect();
            reader.unknown_variant(&raw, "input", &known);
        }
        return None;
    }
    let inner = Raw::<Tuple<'a, source::Word>>::new(rest);
    let list = reader.read(&inner)?.0;
    let (register, component) = match list[..] {
        [register] => (register, None),
        [register, component] => (register, Some(component)),
        _ => {
            reader.push(
                Diagnostic::error("NB0211", reader.span(&inner), "an input is a register and perhaps a component")
                    .label("here")
                    .help("write `(Texture0, Alpha)` or `ExpandNormal(Texture0)`"),
            );
            return None;
        }
    };
    let name = register.split().0;
    if R::from_name(name).is_none() && FinalRegister::from_name(name).is_some() {
        // Known, but not here.
        return parts(reader, register, &[]);
    }
    let component = match component {
        Some(raw) => Some((reader.name(&raw.as_other())?, raw)),
        None => None,
    };
    Some(Parts { mapping, register: reader.name(&register.as_other())?, component })
}

pub(super) fn general_input<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::Input>,
    alpha: bool,
) -> Option<CombinerInput> {
    let Parts { mapping, register, component } = parts::<Register>(reader, raw.as_other(), InputMapping::NAMES)?;
    let place = reader.span(raw);
    let wrong = if alpha { Component::Rgb } else { Component::Blue };
    if let Some((written, raw)) = &component
        && *written == wrong
    {
        let message =
            if alpha { "an alpha portion has no RGB to read" } else { "an RGB portion cannot read just blue" };
        let help = if alpha { "take Alpha (the default here) or Blue" } else { "take Rgb (the default here) or Alpha" };
        reader.push(Diagnostic::error("NB0311", reader.span(raw), message).label("not here").rule("CMB-12").help(help));
    }
    let component = component.map_or(if alpha { Component::Alpha } else { Component::Rgb }, |(written, _)| written);
    on_chip(reader, register.name(), place.clone());
    secondary_alpha(reader, register == Register::SecondaryColor && component == Component::Alpha, place.clone());
    if register == Register::Fog && component == Component::Alpha {
        let help = if alpha { "write `(Fog, Blue)` for the fog colour's blue" } else { "read Rgb here" };
        reader.push(
            Diagnostic::error("NB0308", place, "the fog factor is readable in the final combiner only")
                .label("Fog's alpha")
                .rule("CMB-12")
                .help(help),
        );
    }
    let mapping = mapping.map_or(InputMapping::UnsignedIdentity, |index| InputMapping::ALL[index]);
    Some(CombinerInput { register, component, mapping })
}

fn secondary_alpha(reader: &mut Reader<'_>, read: bool, place: Range<usize>) {
    if read && reader.profile == Profile::Nv10 {
        reader.push(
            Diagnostic::error("NB0309", place, "the alpha of SecondaryColor is not defined on Nv10")
                .label("undefined")
                .rule("CMB-13")
                .help("profile Nv2a defines it: write `profile: Nv2a`, or read the alpha of PrimaryColor"),
        );
    }
}

/// Which of the final combiner's inputs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// A to D.
    Sum,
    /// E and F.
    Product,
    /// G.
    Alpha,
}

pub(super) fn final_input<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::FinalInput>,
    place: Place,
    walk: &mut Walk,
) -> Option<FinalInput> {
    let span = reader.span(raw);
    let (head, _) = raw.split();
    let mapping = InputMapping::from_name(head);
    if mapping.is_some_and(|m| !matches!(m, InputMapping::UnsignedIdentity | InputMapping::UnsignedInvert)) {
        reader.push(
            Diagnostic::error("NB0311", reader.range(head), format!("the final combiner has no mapping {head}"))
                .label("not here")
                .rule("FIN-1")
                .help(
                    "its inputs are taken as they are, or inverted: `Spare0`, `Invert(Spare0)`; map in a general stage",
                ),
        );
        return None;
    }
    let words = ["UnsignedIdentity", "Invert", "UnsignedInvert"];
    let Parts { mapping, register, component } = parts::<FinalRegister>(reader, raw.as_other(), &words)?;
    let default = if place == Place::Alpha { Component::Alpha } else { Component::Rgb };
    let wrong = if place == Place::Alpha { Component::Rgb } else { Component::Blue };
    if let Some((written, raw)) = &component
        && *written == wrong
    {
        let help = match place {
            Place::Alpha => "G reads Alpha (the default) or Blue",
            _ => "inputs A to F read Rgb (the default) or Alpha",
        };
        let message = format!("this input cannot read {wrong:?}");
        reader.push(Diagnostic::error("NB0311", reader.span(raw), message).label("not here").rule("CMB-12").help(help));
    }
    let component = component.map_or(default, |(written, _)| written);
    on_chip(reader, register.name(), span.clone());
    let special = matches!(register, FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF);
    if special && (place != Place::Sum || component == Component::Alpha) {
        reader.push(
            Diagnostic::error("NB0313", span.clone(), format!("{} cannot be read here", register.name()))
                .label("only as the RGB of input A, B, C or D")
                .rule("FIN-1")
                .help("read Spare0 or another register"),
        );
    }
    let alpha = component == Component::Alpha;
    secondary_alpha(reader, register == FinalRegister::SecondaryColor && alpha, span.clone());
    walk.read(reader, register, alpha, span);
    Some(FinalInput { register, component, invert: mapping.is_some_and(|index| index > 0) })
}
