//! Units that are configured by state and not by columns: a stage, a final combiner, a program, a blend, a texture unit.
//!
//! `ninebit op` builds them from options. Their columns are named as in traces.

use super::texture::{CubeDirection, FilteredChannel, LinearAddress, NearestAddress, one_channel};
use super::{CHANNELS, Column, Conditions, Kind, Unit, bytes, channels, paired, put};
use crate::unit::observed;
use ninebit::combiner::final_combiner::{self, PlannedFinal};
use ninebit::combiner::general::{self, PlannedPortion, PlannedStage};
use ninebit::combiner::registers::{self, Registers, channel_name};
use ninebit::engine;
use ninebit::number::{Lane, Pair};
use ninebit::plan::{Plan, PlanError, PlanOptions};
use ninebit::rop::surface;
use ninebit::state::*;
use ninebit::texture::cube::Face;
use ninebit::texture::report::{Report, address_step};
use ninebit::texture::unit;
use ninebit::trace::{Observer, Recorder, Rule, Silent, Step, plain};

/// Returns a column for each channel of each register, in the order of [`Register::ALL`].
pub fn register_columns() -> Vec<Column> {
    let columns = Register::ALL.iter().flat_map(|register| {
        channels(registers::name(*register), CHANNELS, |name| match register {
            Register::Zero => Column::unsigned(name, 1, 0),
            Register::ConstantColor0 | Register::ConstantColor1 => Column::byte(name),
            _ => Column::register(name),
        })
    });
    columns.collect()
}

/// Returns the registers of a row.
fn register_file<L: Lane>(at: impl Fn(usize) -> L) -> Registers<L> {
    let mut file = Registers::new();
    for (n, register) in Register::ALL.iter().enumerate() {
        file.load(*register, [0, 1, 2, 3].map(|channel| at(4 * n + channel)));
    }
    file
}

/// Returns the columns of the channels of the fragment, of which `live` are bits.
fn fragment(live: u8) -> Vec<Column> {
    let channel = |c: usize| Column::result(&format!("fragment.{}", channel_name(c)), Kind::Signed(10));
    (0..4).filter(|c| live >> c & 1 != 0).map(channel).collect()
}

/// A portion of a general stage, on the contents of registers.
#[derive(Debug)]
pub struct ConfiguredStage {
    /// Both portions and the constant colours; the latter are not loaded.
    pub stage: GeneralStage,
    /// The portion of which results are shown: RGB or alpha.
    pub portion: Component,
    /// The bit of SPARE0's alpha that the mux reads.
    pub mux_select: MuxSelect,
}

impl ConfiguredStage {
    /// Returns what the portion writes: registers and channels.
    fn written(&self) -> Vec<(Register, usize)> {
        let (planned, channels) = match self.portion {
            Component::Alpha => (PlannedPortion::whole(self.stage.alpha, 8), 3..4),
            _ => (PlannedPortion::whole(self.stage.rgb, 7), 0..3),
        };
        let outputs = [planned.portion.ab_output, planned.portion.cd_output, planned.portion.sum_output];
        let outputs = (0..3).zip(outputs).filter(|(n, _)| planned.live[*n] != 0);
        let written = outputs.flat_map(|(n, register)| {
            let blue = planned.blue_to_alpha.get(n).is_some_and(|blue| *blue).then_some(3);
            channels.clone().chain(blue).map(move |channel| (register, channel))
        });
        written.collect()
    }

    fn run<L: Lane>(
        &self,
        _: &[i64],
        at: impl Fn(usize) -> L,
        conditions: &Conditions,
        observer: &mut impl Observer,
    ) -> Vec<L> {
        let mut file = register_file(at);
        let stage = PlannedStage::whole(0, &self.stage);
        general::run(&stage, self.mux_select, &conditions.policies, &mut file, observer);
        self.written().into_iter().map(|(register, channel)| file.read(register, channel)).collect()
    }
}

impl Unit for ConfiguredStage {
    known_as!("combiner", &["CMB-1", "CMB-2", "CMB-3", "CMB-4", "CMB-5", "CMB-6", "CMB-7", "CMB-8", "CMB-9", "CMB-10", "CMB-11", "NUM-2", "NUM-3"], "a portion of a general stage"; takes [register_columns()]);

    fn results(&self) -> Vec<Column> {
        let name = |(register, channel)| format!("{}.{}", registers::name(register), channel_name(channel));
        self.written().into_iter().map(|place| Column::result(&name(place), Kind::Signed(9))).collect()
    }

    computed!(run);
}

/// The final combiner, on the contents of registers.
#[derive(Debug)]
pub struct ConfiguredFinal {
    /// The inputs and the settings of the sum; constant colours are not loaded.
    pub state: FinalCombiner,
    /// Whether alpha is computed.
    pub alpha: bool,
}

impl ConfiguredFinal {
    fn planned(&self) -> PlannedFinal {
        PlannedFinal { live: if self.alpha { 15 } else { 7 }, ..PlannedFinal::whole(self.state) }
    }

    fn run<L: Lane>(
        &self,
        _: &[i64],
        at: impl Fn(usize) -> L,
        Conditions { profile, policies }: &Conditions,
        observer: &mut impl Observer,
    ) -> [L; 4] {
        final_combiner::run(&self.planned(), *profile, policies, &mut register_file(at), observer)
    }
}

impl Unit for ConfiguredFinal {
    known_as!("final combiner", &["FIN-1", "FIN-2", "FIN-3", "FIN-4", "FIN-5"], "the final combiner"; takes [register_columns()]);

    fn results(&self) -> Vec<Column> {
        fragment(self.planned().live)
    }

    computed!(run);
}

/// A pixel program, on the contents of registers.
#[derive(Debug)]
pub struct ConfiguredProgram {
    /// The general stages, with their constants, and the final combiner.
    pub combiners: Combiners,
}

impl ConfiguredProgram {
    fn run<L: Lane>(
        &self,
        _: &[i64],
        at: impl Fn(usize) -> L,
        Conditions { profile, policies }: &Conditions,
        observer: &mut impl Observer,
    ) -> [L; 4] {
        let bytes = |constants: [[u8; 4]; 2], _| constants.map(|constant| constant.map(L::byte));
        self.combiners.observed(&mut register_file(at), bytes, (*profile, policies), observer)
    }
}

impl Unit for ConfiguredProgram {
    known_as!("program", &["CMB-1", "CMB-2", "CMB-3", "CMB-4", "CMB-5", "CMB-6", "CMB-7", "CMB-8", "CMB-9", "CMB-10", "CMB-11", "CMB-13", "NUM-2", "NUM-3", "FIN-1", "FIN-2", "FIN-3", "FIN-4", "FIN-5"], "a pixel program"; takes [register_columns()]; gives [fragment(15)]);

    computed!(run);
}

/// A fragment, blended and stored: a scene of one pixel, whose colours each row sets.
#[derive(Debug)]
pub struct ConfiguredBlend {
    scene: Scene,
    surface: SurfaceFormat,
    /// Channels that the surface stores, as bits R, G, B, A.
    written: u8,
}

impl ConfiguredBlend {
    /// Returns the unit of a blend on a surface.
    ///
    /// # Errors
    ///
    /// The chip does not blend so on this surface.
    pub fn new(blend: Blend, surface: SurfaceFormat, profile: Profile) -> Result<ConfiguredBlend, Vec<PlanError>> {
        let corners = [[0.0, 0.0, 0.0, 1.0], [0.0, 2.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0]];
        let draw = Draw {
            vertices: corners.into_iter().map(|position| Vertex { position, ..Vertex::default() }).collect(),
            indices: [0, 1, 2].into(),
            combiners: Combiners::showing(FinalRegister::ConstantColor0),
            blend: Some(blend),
            ..Draw::default()
        };
        let targets = vec![Target::new(1, 1, surface)];
        let scene = Scene { profile, targets, draws: vec![draw], ..Scene::default() };
        let written = plan(&scene)?.draws()[0].written;
        Ok(ConfiguredBlend { scene, surface, written })
    }

    /// Returns the steps of a row, and the word that the surface holds after it.
    fn steps(&self, inputs: &[i64]) -> (Vec<Step>, u32) {
        let mut scene = self.scene.clone();
        scene.targets[0].clear_color = bytes(&inputs[4..]);
        let draw = &mut scene.draws[0];
        draw.blend_constant = bytes(&inputs[8..]);
        draw.combiners.final_combiner.constants[0] = bytes(inputs);
        // Nv10 has the same constants everywhere (CMB-12).
        draw.combiners.stages.iter_mut().for_each(|stage| stage.constants[0] = bytes(inputs));
        // The scene has been planned with other colours. The pixel exists, and the draw covers it.
        let Some(trace) = plan(&scene).ok().and_then(|plan| engine::trace(&plan, 0, (0, 0), None).ok()) else {
            return Default::default();
        };
        let steps = trace.draws.into_iter().flat_map(|draw| draw.steps);
        let wanted = |step: &Step| step.block == "store" || step.block == "blend";
        (steps.filter(wanted).collect(), trace.word)
    }
}

/// Plans a scene of which every value is computed, whatever its colours are.
fn plan(scene: &Scene) -> Result<Plan, Vec<PlanError>> {
    Ok(Plan::compile(scene, &PlanOptions { prune: false, ..PlanOptions::default() })?.blending_stored_channels())
}

impl Unit for ConfiguredBlend {
    known_as!(
        "blend", &["ROP-2", "ROP-3", "ROP-4", "ROP-5"], "a fragment, blended and stored";
        takes [["fragment", "destination", "blend_constant"].map(|name| channels(name, CHANNELS, Column::byte)).concat()]
    );

    fn results(&self) -> Vec<Column> {
        let name = |prefix: &str, channels: u8| -> Vec<Column> {
            let present = (0..4).filter(|channel| channels >> channel & 1 != 0);
            present.map(|c| Column::result(&format!("{prefix}.{}", channel_name(c)), Kind::Unsigned(32))).collect()
        };
        let word = vec![Column::result("stored.word", Kind::Unsigned(32))];
        [name("blend", self.written), word, name("field", surface::kept_channels(self.surface))].concat()
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let (steps, word) = self.steps(inputs);
        let fields = surface::channel_bits(self.surface);
        for (column, result) in self.results().into_iter().zip(results) {
            let field = column.name.strip_prefix("field.");
            let bits = field.and_then(|field| CHANNELS.iter().position(|channel| *channel == field)).map(|c| fields[c]);
            *result = match bits {
                Some(bits) => ((word & bits) >> bits.trailing_zeros()).into(),
                None => steps.iter().find(|step| step.name == column.name).map_or(0, |step| step.value),
            };
        }
    }

    fn trace(&self, inputs: &[i64], _: &Conditions, recorder: &mut Recorder) {
        recorder.steps.extend(self.steps(inputs).0);
    }
}

/// The coordinates that the unit accepts, in texels or in 1/256 texel: the first and the last.
const COORDINATES: [i64; 2] = [-16_777_216, 16_777_215];

/// A texel index in an address mode, on a side of a texture.
#[derive(Debug)]
pub struct ConfiguredAddress {
    /// The address mode.
    pub mode: AddressMode,
    /// Texels along the side.
    pub size: u32,
}

impl ConfiguredAddress {
    /// Returns the results of a unit of addresses for a coordinate in 1/256 texel.
    fn results_at(&self, unit: &dyn Unit, coordinate: i64, conditions: &Conditions) -> Vec<i64> {
        observed(unit, &[self.mode as i64, 0, self.size.into(), coordinate], conditions, &mut Silent)
    }

    /// Returns the texel, or -1 if it is the border colour.
    fn run(&self, inputs: &[i64], conditions: &Conditions, observer: &mut impl Observer) -> [i64; 1] {
        // A texel's first coordinate is 256 times its index.
        let found = self.results_at(&NearestAddress, 256 * inputs[0], conditions);
        let texel = (found[1] != 0).then_some(found[2]);
        let operands = vec![plain("index", inputs[0]), plain("size", i64::from(self.size))];
        let mut step = address_step("address", "texel", self.mode, false, operands, texel.unwrap_or(inputs[0]));
        if texel.is_none() {
            step = step.note("outside: the border colour".to_owned());
        }
        observer.step(step);
        [texel.unwrap_or(-1)]
    }
}

impl Unit for ConfiguredAddress {
    known_as!(
        "address", &["TEX-7", "TEX-8"], "a texel index, brought inside the image";
        takes [Column::signed("index", 25, COORDINATES[0], COORDINATES[1])];
        gives [Column::result("texel", Kind::Signed(14))]
    );

    computed!(plain run);
}

/// Largest component of a direction. It has as many bits as on the chip (TEX-12).
const MAX_COMPONENT: i64 = 1 << 28;

/// A look-up in a cube map.
#[derive(Debug)]
pub struct ConfiguredCube {
    /// Texels along a side of each face.
    pub side: u32,
}

impl ConfiguredCube {
    fn run(&self, inputs: &[i64], conditions: &Conditions, observer: &mut impl Observer) -> [i64; 9] {
        let row = [&[self.side.into()], inputs].concat();
        let found = observed(&CubeDirection, &row, conditions, observer);
        let clamped = ConfiguredAddress { mode: AddressMode::ClampToEdge, size: self.side };
        let [x, y] = [found[1], found[2]].map(|c| clamped.results_at(&NearestAddress, c, conditions)[2]);
        let [u, v] = [found[1], found[2]].map(|c| clamped.results_at(&LinearAddress, c, conditions));
        [found[0], found[1], found[2], x, y, u[3], u[5], v[3], v[5]]
    }
}

impl Unit for ConfiguredCube {
    known_as!(
        "cube", &["TEX-12", "TEX-13", "TEX-14"], "a look-up in a cube map";
        takes [["unit0.N_x0", "unit0.N_y0", "unit0.N_z0"].map(|name| Column::signed(name, 30, -MAX_COMPONENT, MAX_COMPONENT))];
        gives [
            Column::result("face", Kind::Name(Face::NAMES)),
            Column::results(["u", "v", "x", "y", "linear_x", "linear_x", "linear_y", "linear_y"], Kind::Signed(26)),
        ]
    );

    computed!(plain run);
}

/// The linear filter of one channel.
#[derive(Debug)]
pub struct ConfiguredFilter {
    /// Whether the channel is signed.
    pub signed: bool,
    /// Whether the last two columns are coordinates instead of weights.
    pub coordinates: bool,
}

impl ConfiguredFilter {
    fn run(&self, inputs: &[i64], conditions: &Conditions, observer: &mut impl Observer) -> Vec<i64> {
        let mut row = [&[self.signed.into()], inputs].concat();
        if self.coordinates {
            let (unit, at) = (one_channel(self.signed), [inputs[4], inputs[5]]);
            let (report, ideal) = (Report { unit: &unit, prefix: "" }, at.map(|c| c as f64));
            let (_, weights) = unit::footprint_weights::<Pair, _>(&report, at, ideal, Rule::Int4, observer);
            row[5..].copy_from_slice(&weights.map(|weight| weight.fixed.into()));
        }
        observed(&FilteredChannel, &row, conditions, observer)
    }
}

impl Unit for ConfiguredFilter {
    known_as!(
        "filter", &["TEX-6", "TEX-18"], "the linear filter of one channel";
        gives [Column::results(["mix", "register"], Kind::Signed(9))]
    );

    fn inputs(&self) -> Vec<Column> {
        let [least, last] = if self.signed { [-128, 127] } else { [0, 255] };
        let texel = |place| Column::signed(&format!("unit0.texel{place}.r"), 9, least, last);
        let texels = ["00", "10", "01", "11"].map(texel);
        let (names, [first, last]) = match self.coordinates {
            true => (["unit0.u", "unit0.v"], COORDINATES),
            false => (["unit0.weight_u", "unit0.weight_v"], [0, 255]),
        };
        texels.into_iter().chain(names.map(|name| Column::signed(name, 25, first, last))).collect()
    }

    computed!(plain run);
}
