//! The pieces of the generic text: each prints a rule by reading the order of a pixel with given values, once for every value of the field that
//! selects.

use ninebit::algebra::{Algebra, Site};
use ninebit::combiner::registers::Registers;
use ninebit::combiner::{final_combiner, general};
use ninebit::number::{Integer, Register as _};
use ninebit::rop::{blend, surface};
use ninebit::state::*;
use ninebit_program::registers::{OPERATIONS, raster};

use crate::code::{Code, Kind, Line, Operand, Operation, Range, enclosing};
use crate::input::{Input, Local};
use crate::kind::is_wide;
use crate::number::{Factor, Number, Sum, Word};
use crate::order::{Block, Listing};

/// A function of the generic text.
#[derive(Debug)]
pub(super) struct Piece {
    /// Comment of the function: what it does.
    pub(super) about: &'static str,
    pub(super) name: &'static str,
    /// Parameter that selects a case; `None` if there is only one case.
    pub(super) chooses: Option<&'static str>,
    /// The other parameters, as text.
    pub(super) parameters: &'static str,
    /// Array that holds the results; `None` if a single value is returned.
    pub(super) array: Option<&'static str>,
    /// If the array holds the inputs as well, the number of channels, to each of which the case is applied.
    pub(super) each: Option<usize>,
    pub(super) kind: Kind,
    /// Whether numbers of the results are 64 bits wide, whatever their range.
    pub(super) wide: bool,
    pub(super) cases: Vec<Case>,
}

/// Makes a piece with a single case that returns a number.
pub(super) fn piece(name: &'static str, about: &'static str, parameters: &'static str, cases: Vec<Case>) -> Piece {
    Piece { about, name, chooses: None, parameters, array: None, each: None, kind: Kind::Number, wide: false, cases }
}

impl Piece {
    /// Sets the parameter that selects a case.
    pub(super) fn by(self, parameter: &'static str) -> Piece {
        Piece { chooses: Some(parameter), ..self }
    }

    /// Returns whether the results are numbers that may need more than 32 bits.
    pub(super) fn is_wide(&self) -> bool {
        self.kind == Kind::Number && (self.wide || is_wide(range(&self.cases)))
    }

    /// Sets the array that holds the results.
    pub(super) fn filling(self, array: &'static str) -> Piece {
        Piece { array: Some(array), ..self }
    }

    /// Makes the results numbers of 64 bits.
    pub(super) fn wide(self) -> Piece {
        Piece { wide: true, ..self }
    }

    /// Makes the results binary numbers.
    pub(super) fn binary(self) -> Piece {
        Piece { kind: Kind::Binary, ..self }
    }

    /// Sets the array whose channels are changed one by one, and their number.
    fn changing(self, array: &'static str, each: usize) -> Piece {
        Piece { array: Some(array), each: Some(each), ..self }
    }
}

/// A case: the code for one value of the field that selects.
#[derive(Debug)]
pub(super) struct Case {
    pub(super) value: u32,
    pub(super) name: String,
    pub(super) lines: Vec<Line>,
    pub(super) results: Vec<Operand>,
    pub(super) range: Range,
}

/// The range of a register that stages write.
const REGISTER: Range = (-256, 255);
/// The range of a byte.
const BYTE: Range = (0, 255);
/// The range of an input of the final combiner: SPARE0 + SECONDARY goes up to 510 (FIN-3).
const FINAL: Range = (0, 510);

const A: [&str; 3] = ["a[0]", "a[1]", "a[2]"];
const B: [&str; 3] = ["b[0]", "b[1]", "b[2]"];
const FRAGMENT: [&str; 4] = ["fragment[0]", "fragment[1]", "fragment[2]", "fragment[3]"];
const SOURCE: [&str; 4] = ["source[0]", "source[1]", "source[2]", "source[3]"];
const DESTINATION: [&str; 4] = ["destination[0]", "destination[1]", "destination[2]", "destination[3]"];
const CONSTANT: [&str; 4] = ["constant[0]", "constant[1]", "constant[2]", "constant[3]"];

/// Reads a rule for one value of a field, and writes down its code.
pub(super) struct Reader<'a> {
    pub(super) code: &'a Code,
    listing: Listing<'a>,
    /// Number of times that all sums are halved: two if factors are in steps of a half, otherwise none.
    halvings: u32,
}

impl<'a> Reader<'a> {
    pub(super) fn local(&self, name: &'static str, range: Range) -> Number<'a> {
        Number::new(self.code, self.code.input(Input::Local(Local { name, kind: Kind::Number, range }), range))
    }

    pub(super) fn all<const N: usize>(&self, names: [&'static str; N], range: Range) -> [Number<'a>; N] {
        names.map(|name| self.local(name, range))
    }

    pub(super) fn word(&self, name: &'static str) -> Word<'a> {
        let range = (0, 0xffff_ffff);
        Word(Number::new(self.code, self.code.input(Input::Local(Local { name, kind: Kind::Word, range }), range)))
    }

    fn factor(&self, value: Number<'a>) -> Factor<'a> {
        Factor { value, halves: self.halvings > 0 }
    }

    /// Maps a register's value. The result is in steps of a half if other factors are.
    fn mapped(&mut self, mapping: InputMapping, x: Number<'a>) -> Number<'a> {
        let factor = self.listing.map(mapping, x);
        let whole = self.halvings > 0 && !factor.halves;
        if whole { factor.value.multiplied(Number::Constant(2)) } else { factor.value }
    }

    /// Returns a sum in the steps that all sums have.
    fn sum(&self, sum: Sum<'a>) -> Number<'a> {
        sum.alike(Sum { value: Number::Constant(0), halvings: self.halvings })[0].value
    }
}

/// Makes pieces for the given policies.
pub(super) struct Maker {
    pub(super) policies: Policies,
    pub(super) block: Block,
}

impl Maker {
    pub(super) fn case(
        &self,
        value: u32,
        name: &str,
        of: impl for<'a> FnOnce(&mut Reader<'a>) -> Vec<Number<'a>>,
    ) -> Case {
        let code = Code::default();
        let mut listing = Listing::new(&code, self.policies);
        listing.enter(self.block);
        let halvings = if self.policies.half_bias == HalfBiasConstant::Half127And5 { 2 } else { 0 };
        let results: Vec<Operand> =
            of(&mut Reader { code: &code, listing, halvings }).into_iter().map(Number::operand).collect();
        let range = enclosing(results.iter().map(|result| code.range(*result)));
        let (lines, renamed) = code.reachable(&results);
        Case { value, name: name.to_string(), lines, results: results.into_iter().map(renamed).collect(), range }
    }

    /// Makes two cases: a flag that is not set, and one that is.
    pub(super) fn flagged(
        &self,
        [no, yes]: [&str; 2],
        of: impl for<'a> Fn(&mut Reader<'a>, bool) -> Vec<Number<'a>>,
    ) -> Vec<Case> {
        vec![self.case(0, no, |reader| of(reader, false)), self.case(1, yes, |reader| of(reader, true))]
    }

    /// Makes a case for each value of a field.
    pub(super) fn cases<T: Named + 'static>(
        &self,
        value: impl Fn(T) -> u32,
        of: impl for<'a> Fn(&mut Reader<'a>, T) -> Vec<Number<'a>>,
    ) -> Vec<Case> {
        T::ALL.iter().map(|one| self.case(value(*one), one.name(), |reader| of(reader, *one))).collect()
    }
}

/// Returns the range of the results of all cases.
pub(super) fn range(cases: &[Case]) -> Range {
    enclosing(cases.iter().map(|case| case.range))
}

/// Returns all pieces, in the order in which a pixel passes through them.
pub(super) fn pieces(policies: Policies) -> Vec<Piece> {
    let maker = Maker { policies, block: Block::Piece };
    let mut pieces = general_stages(&maker);
    pieces.extend(final_stage(&maker));
    pieces.extend(raster(&Maker { policies, block: Block::Raster }));
    pieces
}

/// Returns the result of each mapping for each value of a register, from -256 to 255, by reading the rule with that value.
pub(super) fn mapped(policies: Policies) -> Vec<Vec<i64>> {
    let maker = Maker { policies, block: Block::Piece };
    let one = |mapping: InputMapping, x: i64| {
        let case = maker.case(0, "", |reader| vec![reader.mapped(mapping, Number::Constant(x))]);
        // The result of a constant is a constant.
        case.range.0
    };
    InputMapping::ALL.iter().map(|mapping| (REGISTER.0..=REGISTER.1).map(|x| one(*mapping, x)).collect()).collect()
}

fn general_stages(maker: &Maker) -> Vec<Piece> {
    let color = maker.case(0, "", |reader| {
        reader.code.by("NUM-5");
        surface::channels(SurfaceFormat::A8R8G8B8, reader.word("word")).map(Word::number).to_vec()
    });
    let mapped = |x: &'static str| {
        let number = |mapping: InputMapping| mapping as u32;
        maker.cases(number, |reader, mapping| vec![reader.mapped(mapping, reader.local(x, REGISTER))])
    };
    let factor = range(&mapped("x"));
    let products = maker.flagged(["a product of each channel", "a dot product, the same in each"], |reader, is_dot| {
        let [x, y] = [A, B].map(|names| reader.all(names, factor).map(|value| reader.factor(value)));
        let sums = general::product(Site::product(0, 0), is_dot, &x, &y, &mut reader.listing);
        sums.map(|sum| reader.sum(sum)).to_vec()
    });
    let product = maker.case(0, "", |reader| {
        let [x, y] = ["a", "b"].map(|name| [reader.factor(reader.local(name, factor))]);
        let [sum] = general::product(Site::product(0, 3), false, &x, &y, &mut reader.listing);
        vec![reader.sum(sum)]
    });
    let full = range(&products);
    let takes_cd = maker.cases(
        |select: MuxSelect| (select == MuxSelect::Msb).into(),
        |reader, select| {
            let alpha = reader.local("spare0_alpha", REGISTER);
            vec![reader.listing.choice(select, alpha).number()]
        },
    );
    let third = maker.flagged(["the sum", "the mux"], |reader, mux| {
        let [ab, cd] = reader.all(["ab", "cd"], full).map(|value| Sum { value, halvings: reader.halvings });
        let takes_cd = !reader.local("takes_cd", (0, 1)).is_zero();
        let third = general::third(mux, takes_cd, ab, cd, &mut reader.listing);
        vec![reader.sum(third)]
    });
    let most = range(&third);
    let sums = (most.0.min(full.0), most.1.max(full.1));
    let output = |sum: &'static str| -> Vec<Case> {
        let case = |(value, bias, scale): &(u32, Bias, Scale)| {
            maker.case(*value, &format!("{}, {}", bias.name(), scale.name()), |reader| {
                let portion = Portion { bias: *bias, scale: *scale, ..Portion::idle(Component::Rgb) };
                let sum = Sum { value: reader.local(sum, sums), halvings: reader.halvings };
                vec![general::output(&portion, sum, &mut reader.listing)]
            })
        };
        OPERATIONS.iter().map(case).collect()
    };
    let about_mux = "Whether muxes take CD: by the least or the most significant bit of SPARE0's alpha.";
    vec![
        piece("nb_color", "A constant: R, G, B, A of A8R8G8B8.", "@uint word", vec![color]).filling("channels[4]"),
        piece("nb_mapped", "An input by its mapping.", "@int x", mapped("x")).by("mapping"),
        piece("nb_mapped_rgb", "The same of R, G and B.", "", mapped("x[c]")).by("mapping").changing("x[3]", 3),
        piece("nb_products", "AB or CD of an RGB portion, not yet rounded.", "@in @int a[3], @in @int b[3]", products)
            .by("is_dot")
            .filling("sums[3]"),
        piece("nb_product", "AB or CD of an alpha portion, not yet rounded.", "@int a, @int b", vec![product]),
        piece("nb_takes_cd", about_mux, "@int spare0_alpha", takes_cd).by("by_most"),
        piece("nb_third", "The third output of a portion, not yet rounded.", "@int takes_cd, @int ab, @int cd", third)
            .by("mux"),
        piece("nb_output", "An output as a register: rounded, biased, scaled, limited.", "@int sum", output("sum"))
            .by("operation"),
        piece("nb_output_rgb", "The same of R, G and B.", "", output("sum[c]")).by("operation").changing("sum[3]", 3),
    ]
}

fn final_stage(maker: &Maker) -> Vec<Piece> {
    let invert = |x: &'static str| {
        maker.flagged(["as it is", "inverted"], |reader, inverted| {
            vec![final_combiner::input(reader.local(x, (REGISTER.0, FINAL.1)), inverted, &mut reader.listing)]
        })
    };
    let color_sum = maker.flagged(["as it is", "limited to one"], |reader, color_sum_clamp| {
        let [spare0, secondary] = reader.all(["spare0", "secondary"], BYTE);
        let state = FinalCombiner { color_sum_clamp, ..FinalCombiner::default() };
        reader.code.by("FIN-3");
        vec![final_combiner::color_sum(spare0, secondary, &state, &mut reader.listing)]
    });
    let final_product = maker.case(0, "", |reader| {
        let [e, f] = reader.all(["e", "f"], FINAL);
        vec![final_combiner::product(e, f, &mut reader.listing)]
    });
    let rgb = maker.case(0, "", |reader| {
        let from = [FinalRegister::Fog, FinalRegister::PrimaryColor, FinalRegister::Texture0, FinalRegister::Texture1];
        let mut state = FinalCombiner::default();
        let mut registers = Registers::from_value(Number::ZERO);
        for (n, value) in reader.all(["a", "b", "c", "d"], FINAL).into_iter().enumerate() {
            state.inputs[n] = FinalInput { register: from[n], component: Component::Rgb, invert: false };
            registers.load(final_combiner::general(from[n]), [value; 4]);
        }
        vec![final_combiner::evaluate(&state, &registers, &mut reader.listing).fragment[0]]
    });
    let about_rgb = "A channel of the fragment: A B + (1 - A) C + D.";
    vec![
        piece("nb_final_input", "An input of the final combiner.", "@int x", invert("x")).by("invert"),
        piece("nb_final_input_rgb", "The same of R, G and B.", "", invert("x[c]")).by("invert").changing("x[3]", 3),
        piece("nb_color_sum", "SPARE0 + SECONDARY.", "@int spare0, @int secondary", color_sum).by("clamp_sum"),
        piece("nb_final_product", "E times F.", "@int e, @int f", vec![final_product]),
        piece("nb_final_rgb", about_rgb, "@int a, @int b, @int c, @int d", vec![rgb]),
    ]
}

fn raster(maker: &Maker) -> Vec<Piece> {
    let format = raster::surface_format;
    let passes = maker.cases(raster::compare_function, |reader, function: CompareFunction| {
        reader.code.by("ROP-1");
        let [alpha, reference] = reader.all(["alpha", "reference"], BYTE);
        vec![Integer::compared(alpha, function, reference).number()]
    });
    let factors = maker.cases(raster::blend_factor, |reader, factor: BlendFactor| {
        let [source, destination, constant] = [SOURCE, DESTINATION, CONSTANT].map(|names| reader.all(names, BYTE));
        reader.code.by("ROP-4");
        let all = [0, 1, 2, 3];
        all.map(|c| blend::factor(factor, c, &source, &destination, &constant, &mut reader.listing)).to_vec()
    });
    let blended = maker.cases(raster::blend_equation, |reader, equation: BlendEquation| {
        let [s, d, fs, fd] = reader.all(["s", "d", "fs", "fd"], BYTE);
        let state = Blend { equation, source: BlendFactor::ConstantColor, destination: BlendFactor::ConstantAlpha };
        let constant = [fs, Number::ZERO, Number::ZERO, fd];
        reader.code.by("ROP-2");
        vec![blend::evaluate(&state, 0, &[s; 4], &[d; 4], &constant, &mut reader.listing).blended]
    });
    let truncated = maker.cases(format, |reader, format: SurfaceFormat| {
        blend::truncated(format, reader.all(FRAGMENT, BYTE), &mut reader.listing).to_vec()
    });
    let channels = maker.cases(format, |reader, format: SurfaceFormat| {
        reader.code.by("ROP-5");
        surface::channels(format, reader.word("word")).map(Word::number).to_vec()
    });
    let packed = maker.cases(format, |reader, format: SurfaceFormat| {
        let rgba = reader.all(FRAGMENT, BYTE);
        reader.code.by("ROP-5");
        vec![surface::packed(format, rgba.map(Number::word)).0]
    });
    let mask = maker.cases(format, |reader, format: SurfaceFormat| {
        reader.code.by("ROP-6");
        let word = reader.word("color_mask");
        let bits = [0, 1, 2, 3].map(|n: usize| {
            let field = raster::COLOR_MASK[n];
            let bits = surface::write_mask(format, std::array::from_fn(|c| c == n));
            (word >> field.shift & Word::from(field.most())) * Word::from(bits)
        });
        let [r, g, b, a] = bits;
        vec![(r | g | b | a).0]
    });
    let blends = maker.cases(format, |_, format: SurfaceFormat| vec![Number::Constant(surface::blends(format).into())]);
    let whole = maker.cases(format, |_, format: SurfaceFormat| {
        vec![Number::Constant((surface::write_mask(format, [true; 4]) == u32::MAX).into())]
    });
    let word = |piece: Piece| Piece { kind: Kind::Word, ..piece.by("format") };
    let three = "@in @int source[4], @in @int destination[4], @in @int constant[4]";
    vec![
        piece("nb_passes", "The alpha test.", "@int alpha, @int reference", passes).by("compare"),
        piece("nb_blends", "Whether a surface can be blended with.", "", blends).by("format"),
        piece("nb_truncated", "A fragment without what the surface drops.", "@in @int fragment[4]", truncated)
            .by("format")
            .filling("source[4]"),
        piece("nb_channels", "What a surface holds: R, G, B, A.", "@uint word", channels)
            .by("format")
            .filling("destination[4]"),
        piece("nb_blend_factors", "A blend factor, of each channel.", three, factors)
            .by("factor")
            .filling("factors[4]"),
        piece("nb_blended", "A blended channel.", "@int s, @int d, @int fs, @int fd", blended).by("equation"),
        piece("nb_whole", "Whether the four channels are all bits of a surface's words.", "", whole).by("format"),
        word(piece("nb_packed", "A fragment as a stored word.", "@in @int fragment[4]", packed)),
        word(piece("nb_write_mask", "The bits of a stored word that are written.", "@uint color_mask", mask)),
    ]
}

/// A write of a stage: a channel of an output, or the blue of an output to alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Write {
    Channel { output: usize, channel: usize },
    BlueToAlpha { output: usize },
}

/// Returns the writes of a stage in the order of CMB-1 and CMB-11. Channel 3 is that of the alpha portion.
pub(super) fn writes() -> Vec<Write> {
    let code = Code::default();
    let mut listing = Listing::new(&code, Policies::DEFAULT);
    listing.enter(Block::Piece);
    let portion = |component| Portion {
        ab_output: Register::Spare0,
        cd_output: Register::Spare0,
        sum_output: Register::Spare0,
        ..Portion::idle(component)
    };
    let rgb = Portion { ab_blue_to_alpha: true, cd_blue_to_alpha: true, ..portion(Component::Rgb) };
    let stage = GeneralStage { rgb, alpha: portion(Component::Alpha), constants: [[0; 4]; 2] };
    let stage = general::PlannedStage::whole(0, &stage);
    let mut registers = Registers::from_value(Number::ZERO);
    let values = general::evaluate(&stage, MuxSelect::Lsb, &registers, &mut listing);
    listing.take_sites();
    general::write(&stage, &values, &mut registers, &mut listing);
    let blue = (0..2).map(|output| (Site::blue_to_alpha(output), Write::BlueToAlpha { output }));
    let channels = (0..3).flat_map(|output| {
        (0..4).map(move |channel| (Site::write(output, channel), Write::Channel { output, channel }))
    });
    let known: Vec<(Site, Write)> = blue.chain(channels).collect();
    let write = |site: Site| known.iter().find(|(known, _)| *known == site).map(|(_, write)| *write);
    listing.take_sites().into_iter().filter_map(write).collect()
}

/// Returns what SPARE0 holds before the first stage (CMB-13): for each channel, the channel of TEXTURE0 that it copies, or `None` if it is 0.
pub(super) fn initial_spare0() -> [Option<usize>; 4] {
    let mut program = Combiners { stages: Vec::new(), ..Combiners::default() };
    program.final_combiner.inputs[3].register = FinalRegister::Spare0;
    program.final_combiner.g =
        FinalInput { register: FinalRegister::Spare0, component: Component::Alpha, invert: false };
    let code = Code::default();
    let mut listing = Listing::new(&code, Policies::DEFAULT);
    listing.enter(Block::Piece);
    let mut registers = Registers::from_value(Number::ZERO);
    let texture = [0, 1, 2, 3].map(|c| Number::new(&code, code.input(Input::Texture(0, c), BYTE)));
    registers.load(Register::Texture0, texture);
    let fragment = program.evaluate(registers, |_, _, _| [[Number::ZERO; 4]; 2], &mut listing);
    fragment.map(|value| match code.operation(value.operand()) {
        Some(Operation::Input(Input::Texture(_, channel))) => Some(channel),
        _ => None,
    })
}
