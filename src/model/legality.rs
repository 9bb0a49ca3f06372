//! Checks that a program is legal on a chip (CMB-12 and related rules), from the state alone.
//!
//! Every language of programs is checked here. Its front end records the places of what it read, and names registers in its own terms.

pub mod draw;
pub mod shader;
pub mod surface;
pub mod texture;

use super::place::{Part, Place, Places};
use crate::diagnostic::{Diagnostic, only_nv2a};
use crate::place::Span;
use crate::state::*;

/// The terms of a language.
pub trait Notation {
    /// Returns the language's name of a register of the final combiner.
    fn register(&self, register: FinalRegister) -> &'static str {
        register.name()
    }

    /// Returns the language's name of an output scale.
    fn scale(&self, scale: Scale) -> &'static str {
        scale.name()
    }

    /// Returns the advice on a finding, in the language's terms.
    fn help(&self, help: Help) -> &'static str {
        help.text()
    }
}

named! {
    /// Advice that each language expresses in its own terms.
    pub enum Help =>
    /// Returns the advice in the terms of the state.
    text: &'static str {
        /// The program has no stage: how to write one that does nothing.
        EmptyStage => "one whose portions are `Portion::idle` changes nothing",
        /// Stages have different constants on nv10: how to write those of the whole program.
        SharedConstants => "give all stages and the final combiner the same constants; the profile Nv2a allows own ones",
        /// Two results are sent to one register.
        OtherRegister => "send one of them to another register, or to Zero, which discards it",
        /// A bias is combined with a scale of 4 or 1/2.
        BiasScale => "with this bias the scale is One or Two",
        /// An RGB portion reads the fog factor.
        FogColor => "read Rgb here",
        /// An alpha portion reads the fog factor.
        FogBlue => "read Blue here, the fog colour's",
        /// The secondary colour's alpha is read on nv10.
        SecondaryAlpha => "the profile Nv2a defines it; or read the alpha of PrimaryColor",
        /// An RGB portion reads blue.
        RgbComponents => "take Rgb or Alpha",
        /// An alpha portion reads RGB.
        AlphaComponents => "take Alpha or Blue",
        /// An input A to F reads blue.
        FinalComponents => "inputs A to F read Rgb or Alpha",
        /// Input G reads RGB.
        FinalAlphaComponents => "G reads Alpha or Blue",
        /// The destination is read-only.
        Writable => "write to Spare0, Spare1, PrimaryColor, SecondaryColor or a texture register",
        /// A register of the final combiner is read where it cannot be.
        OtherInput => "read Spare0 or another register",
    }
}

/// The result of checking a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LegalityReport {
    /// Errors and warnings, in no particular order.
    pub findings: Vec<Diagnostic>,
    /// The first place that reads the result of each texture unit. `None` if nothing reads it, or if the place is not
    /// in the text.
    pub reads: [Option<Span>; 4],
}

/// Checks the number of general stages. `place` returns where a stage is written.
pub fn stage_count(count: usize, profile: Profile, place: impl Fn(usize) -> Option<Span>) -> Option<Diagnostic> {
    let most = profile.general_stages();
    if count <= most {
        return None;
    }
    let finding = Diagnostic::error("NB0301", place(most), format!("{count} general stages; {profile:?} has {most}"))
        .label(format!("stage {most} is the first too many"))
        .rule("CMB-12");
    Some(if count <= Profile::Nv2a.general_stages() {
        finding.help("profile Nv2a has 8: write `profile: Nv2a`, or use fewer stages")
    } else {
        finding.help("use fewer stages")
    })
}

/// Checks a program. If it has too many stages, nothing else is checked.
pub fn check(combiners: &Combiners, profile: Profile, places: &Places, notation: &dyn Notation) -> LegalityReport {
    let mut check = Check {
        profile,
        places,
        notation,
        checked: LegalityReport::default(),
        // SPARE0.a starts as the alpha of texture 0.
        spares: [false, true, false, false],
        textures: [[false; 2]; 4],
    };
    if let Some(finding) = stage_count(combiners.stages.len(), profile, |stage| places.get(Place::Stage(stage))) {
        check.checked.findings.push(finding);
        return check.checked;
    }
    check.stages(combiners);
    check.final_combiner(combiners);
    check.checked
}

/// Returns the finding that a general stage reads a register of the final combiner. Front ends call it, because the
/// state cannot express this.
pub fn only_final(place: Span, name: &str, help: &str) -> Diagnostic {
    Diagnostic::error("NB0313", place, format!("{name} exists only in the final combiner"))
        .label("not in a general stage")
        .rule("CMB-12")
        .help(help)
}

/// Returns the finding that an input of the final combiner has a mapping other than identity or inversion, or `None` if
/// it has not. Front ends call it, because the state cannot express this.
pub fn final_mapping(place: impl Into<Option<Span>>, mapping: InputMapping) -> Option<Diagnostic> {
    let has = matches!(mapping, InputMapping::UnsignedIdentity | InputMapping::UnsignedInvert);
    let message = format!("the final combiner has no mapping {}", mapping.name());
    let finding = Diagnostic::error("NB0311", place, message).label("not here").rule("FIN-1");
    let help = "its inputs are taken as they are, or inverted: `Spare0`, `Invert(Spare0)`; map in a general stage";
    (!has).then(|| finding.help(help))
}

/// Checks a program in the order of execution.
struct Check<'p> {
    profile: Profile,
    places: &'p Places,
    notation: &'p dyn Notation,
    checked: LegalityReport,
    /// Whether SPARE0.rgb, SPARE0.a, SPARE1.rgb and SPARE1.a are defined.
    spares: [bool; 4],
    /// Whether a stage has written RGB and alpha of TEXTURE0 to TEXTURE3.
    textures: [[bool; 2]; 4],
}

impl Check<'_> {
    fn push(&mut self, finding: Diagnostic) {
        self.checked.findings.push(finding);
    }

    fn name(&self, register: impl Into<FinalRegister>) -> &'static str {
        self.notation.register(register.into())
    }

    fn stages(&mut self, combiners: &Combiners) {
        if combiners.stages.is_empty() {
            let finding = Diagnostic::error(
                "NB0323",
                self.places.get(Place::Stages),
                "the combiners have at least one general stage",
            )
            .label("none here")
            .rule("CMB-12")
            .help(self.notation.help(Help::EmptyStage));
            self.push(finding);
        }
        // A text with separate constants is reported where it writes them, so that differences elsewhere are not
        // reported again.
        let owners = (0..combiners.stages.len()).map(Place::StageConstants).chain([Place::FinalConstants]);
        let written = owners.map(|owner| self.places.get(owner)).any(|place| place.is_some());
        for (index, stage) in combiners.stages.iter().enumerate() {
            let differ = !written && stage.constants != combiners.final_combiner.constants;
            self.own_constants(Place::StageConstants(index), differ, "general stages");
            // Both portions read what earlier stages have written.
            self.portion(index, &stage.rgb, false);
            self.portion(index, &stage.alpha, true);
            self.blue_to_alpha(index, stage);
            self.write(stage);
        }
    }

    /// Checks separate constants of one stage or of the final combiner, which nv10 does not have.
    fn own_constants(&mut self, place: Place, differ: bool, owner: &str) {
        let span = self.places.get(place);
        if self.profile == Profile::Nv10 && (span.is_some() || differ) {
            let finding = Diagnostic::error("NB0303", span, format!("Nv10 has no own constants for {owner}"))
                .label("not on this chip")
                .rule("CMB-12")
                .help(self.notation.help(Help::SharedConstants));
            self.push(finding);
        }
    }

    fn portion(&mut self, stage: usize, portion: &Portion, alpha: bool) {
        let at = |part| Place::General { stage, alpha, part };
        let outputs = [portion.ab_output, portion.cd_output, portion.sum_output];
        for (n, output) in outputs.into_iter().enumerate() {
            self.output(at(Part::Output(n)), output);
        }
        self.distinct(outputs, at);
        let writes = outputs.iter().any(|register| *register != Register::Zero);
        for (n, input) in portion.inputs.iter().enumerate() {
            let place = self.places.get(at(Part::Input(n)));
            if input.component == if alpha { Component::Rgb } else { Component::Blue } {
                let (message, help) = if alpha {
                    ("an alpha portion has no RGB to read", Help::AlphaComponents)
                } else {
                    ("an RGB portion cannot read just blue", Help::RgbComponents)
                };
                self.component(at(Part::Component(n)), place.clone(), message.to_owned(), help);
            }
            let register = FinalRegister::from(input.register);
            let reads_alpha = input.component == Component::Alpha;
            self.on_chip(register, place.clone());
            self.secondary_alpha(register, reads_alpha, place.clone());
            if register == FinalRegister::Fog && reads_alpha {
                let help = if alpha { Help::FogBlue } else { Help::FogColor };
                let finding =
                    Diagnostic::error("NB0308", place.clone(), "the fog factor is readable in the final combiner only")
                        .label("Fog's alpha")
                        .rule("CMB-12")
                        .help(self.notation.help(help));
                self.push(finding);
            }
            if writes {
                self.read(register, reads_alpha, place);
            }
        }
        if alpha {
            for (on, part, what) in [
                (portion.ab_dot_product, Part::Dot(0), "dot products"),
                (portion.cd_dot_product, Part::Dot(1), "dot products"),
                (portion.ab_blue_to_alpha, Part::BlueToAlpha(0), "blue-to-alpha"),
                (portion.cd_blue_to_alpha, Part::BlueToAlpha(1), "blue-to-alpha"),
            ] {
                if on {
                    let place = self.places.get(at(part));
                    self.push(
                        Diagnostic::error("NB0306", place, format!("the alpha portion has no {what}"))
                            .label("not here")
                            .rule("CMB-12")
                            .help("write it in the `rgb` portion"),
                    );
                }
            }
        }
        if portion.bias == Bias::NegativeHalf && matches!(portion.scale, Scale::Four | Scale::Half) {
            let scale = self.notation.scale(portion.scale);
            let mut finding = Diagnostic::error(
                "NB0307",
                self.places.get(at(Part::Bias)),
                format!("bias NegativeHalf does not go with scale {scale}"),
            )
            .label("this bias")
            .rule("CMB-9")
            .help(self.notation.help(Help::BiasScale));
            if let Some(scale) = self.places.get(at(Part::Scale)) {
                finding = finding.related(scale, "this scale");
            }
            self.push(finding);
        }
    }

    fn output(&mut self, place: Place, register: Register) {
        let span = self.places.get(place);
        if matches!(register, Register::ConstantColor0 | Register::ConstantColor1 | Register::Fog) {
            let finding = Diagnostic::error("NB0312", span, format!("{} cannot be written", self.name(register)))
                .label("read only")
                .rule("CMB-12")
                .help(self.notation.help(Help::Writable));
            self.push(finding);
        } else {
            self.on_chip(register.into(), span);
        }
    }

    /// Checks that no two results of a portion go to the same register.
    fn distinct(&mut self, outputs: [Register; 3], at: impl Fn(Part) -> Place) {
        for second in 1..3 {
            let register = outputs[second];
            let first = outputs[..second].iter().position(|first| *first == register && register != Register::Zero);
            if let Some(first) = first {
                let [again, first] = [second, first].map(|n| self.places.get(at(Part::Output(n))));
                let mut finding =
                    Diagnostic::error("NB0310", again, format!("two results go to {}", self.name(register)))
                        .label("again here")
                        .rule("CMB-12")
                        .help(self.notation.help(Help::OtherRegister));
                if let Some(first) = first {
                    finding = finding.related(first, "first here");
                }
                self.push(finding);
                return;
            }
        }
    }

    /// Checks blue-to-alpha within a stage.
    fn blue_to_alpha(&mut self, index: usize, stage: &GeneralStage) {
        let (rgb, alpha) = (&stage.rgb, &stage.alpha);
        for (n, on, output) in [(0, rgb.ab_blue_to_alpha, rgb.ab_output), (1, rgb.cd_blue_to_alpha, rgb.cd_output)] {
            if !on {
                continue;
            }
            let place = self.places.get(Place::General { stage: index, alpha: false, part: Part::BlueToAlpha(n) });
            if self.profile == Profile::Nv10 {
                self.push(only_nv2a("NB0304", place.clone(), "blue-to-alpha", "CMB-11"));
            }
            for (m, written) in [alpha.ab_output, alpha.cd_output, alpha.sum_output].into_iter().enumerate() {
                if written == output && output != Register::Zero {
                    let message = format!("two results go to the alpha of {}", self.name(output));
                    let mut finding = Diagnostic::error("NB0305", place.clone(), message)
                        .label("blue goes there")
                        .rule("CMB-12")
                        .help("send one of them to another register");
                    let other = Place::General { stage: index, alpha: true, part: Part::Output(m) };
                    if let Some(other) = self.places.get(other) {
                        finding = finding.related(other, "the alpha portion writes it, too");
                    }
                    self.push(finding);
                }
            }
        }
    }

    fn final_combiner(&mut self, combiners: &Combiners) {
        let state = &combiners.final_combiner;
        self.own_constants(Place::FinalConstants, false, "the final combiner");
        for (n, input) in state.inputs.iter().chain([&state.g]).enumerate() {
            let place = self.places.get(Place::FinalInput(n));
            let wrong = if n == 6 { Component::Rgb } else { Component::Blue };
            if input.component == wrong {
                let help = if n == 6 { Help::FinalAlphaComponents } else { Help::FinalComponents };
                let message = format!("this input cannot read {wrong:?}");
                self.component(Place::FinalComponent(n), place.clone(), message, help);
            }
            self.on_chip(input.register, place.clone());
            let alpha = input.component == Component::Alpha;
            let special = matches!(input.register, FinalRegister::Spare0PlusSecondary | FinalRegister::ETimesF);
            if special && (n >= 4 || alpha) {
                let message = format!("{} cannot be read here", self.name(input.register));
                let finding = Diagnostic::error("NB0313", place.clone(), message)
                    .label("only as the RGB of input A, B, C or D")
                    .rule("FIN-1")
                    .help(self.notation.help(Help::OtherInput));
                self.push(finding);
            }
            self.secondary_alpha(input.register, alpha, place.clone());
            self.read(input.register, alpha, place);
        }
    }

    fn component(&mut self, written: Place, input: Option<Span>, message: String, help: Help) {
        let place = self.places.get(written).or(input);
        let help = self.notation.help(help);
        self.push(Diagnostic::error("NB0311", place, message).label("not here").rule("CMB-12").help(help));
    }

    /// Checks that the chip has the register: NV10 has two texture registers.
    fn on_chip(&mut self, register: FinalRegister, place: Option<Span>) {
        if matches!(register, FinalRegister::Texture2 | FinalRegister::Texture3) && self.profile == Profile::Nv10 {
            let what = format!("register {}", self.name(register));
            self.push(only_nv2a("NB0302", place, &what, "CMB-12"));
        }
    }

    fn secondary_alpha(&mut self, register: FinalRegister, alpha: bool, place: Option<Span>) {
        if register == FinalRegister::SecondaryColor && alpha && self.profile == Profile::Nv10 {
            let message = format!("the alpha of {} is not defined on Nv10", self.name(register));
            let finding = Diagnostic::error("NB0309", place, message)
                .label("undefined")
                .rule("CMB-13")
                .help(self.notation.help(Help::SecondaryAlpha));
            self.push(finding);
        }
    }

    /// Records a read, and warns if nothing defines the value. Inputs that are not in the text are ignored.
    fn read(&mut self, register: FinalRegister, alpha: bool, place: Option<Span>) {
        let Some(place) = place else { return };
        if let Some(unit) = texture(register) {
            if !self.textures[unit][usize::from(alpha)] {
                self.checked.reads[unit].get_or_insert(place);
            }
            return;
        }
        let index = match register {
            FinalRegister::Spare0 | FinalRegister::Spare0PlusSecondary => usize::from(alpha),
            FinalRegister::Spare1 => 2 + usize::from(alpha),
            _ => return,
        };
        if self.spares[index] {
            return;
        }
        // One warning for each is enough.
        self.spares[index] = true;
        let name = self.name([FinalRegister::Spare0, FinalRegister::Spare1][index / 2]);
        let what = ["RGB", "alpha"][index % 2];
        self.push(
            Diagnostic::warning("NB0903", place, format!("{name}'s {what} is read before a stage writes it"))
                .label("no document says what this is; the model takes 0")
                .rule("CMB-13")
                .help("write the register in an earlier stage, or read another"),
        );
    }

    /// Records what a stage writes.
    fn write(&mut self, stage: &GeneralStage) {
        let mut note = |register: Register, alpha: bool| match register {
            Register::Spare0 => self.spares[usize::from(alpha)] = true,
            Register::Spare1 => self.spares[2 + usize::from(alpha)] = true,
            other => {
                if let Some(unit) = texture(other.into()) {
                    self.textures[unit][usize::from(alpha)] = true;
                }
            }
        };
        for (portion, alpha) in [(&stage.rgb, false), (&stage.alpha, true)] {
            for output in [portion.ab_output, portion.cd_output, portion.sum_output] {
                note(output, alpha);
            }
        }
        for (blue, output) in
            [(stage.rgb.ab_blue_to_alpha, stage.rgb.ab_output), (stage.rgb.cd_blue_to_alpha, stage.rgb.cd_output)]
        {
            if blue {
                note(output, true);
            }
        }
    }
}

/// Returns the texture unit of a register, if it has one.
fn texture(register: FinalRegister) -> Option<usize> {
    match register {
        FinalRegister::Texture0 => Some(0),
        FinalRegister::Texture1 => Some(1),
        FinalRegister::Texture2 => Some(2),
        FinalRegister::Texture3 => Some(3),
        _ => None,
    }
}
