//! Follows a log from its first line to its last, and makes a scene of each frame.

use std::collections::BTreeMap;

use ninebit::state::Profile;
use ninebit_program::registers::Word as RegisterWord;

use crate::class::{self, CELSIUS, Family, KELVIN, Treatment, of_unit};
use crate::dumps::{Dumps, Ram, TextureDump};
use crate::frame::{Builder, Frame};
use crate::log::{Entry, Event, Fault, Reader, Write};
use crate::memory::Memory;
use crate::pgraph;
use crate::state::{Action, State};

/// The part of a log that becomes scenes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Part {
    /// Every frame.
    #[default]
    All,
    /// One frame, numbered from 0.
    Frame(u64),
    /// One draw, numbered from 0.
    Draw(u64),
    /// Every draw, each as a frame of its own.
    EachDraw,
}

/// What an import does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// The part of the log that becomes scenes.
    pub part: Part,
    /// Whether memory has what surfaces held before the log, in place of what they held after it.
    pub surfaces_in_memory: bool,
}

/// What a log's draws read and drew, besides its words.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Memory.
    pub memory: Memory,
    /// The dumps of a hardware tracer.
    pub dumps: Dumps,
}

/// The use of a method in a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// Number of words, with those that the log dropped.
    pub count: u64,
    /// Line of the first.
    pub line: u64,
}

/// The counts of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Uses of methods, by class and number; the number is that of an array's first method.
    pub methods: BTreeMap<(u32, u32), Use>,
    /// Number of frames that have a draw or a clear, of the part that was asked for.
    pub frames: u64,
    /// Number of flips.
    pub flips: u64,
    /// Number of draws.
    pub draws: u64,
    /// Number of draws that were stated as they were, of the part that was asked for.
    pub complete: u64,
    /// Number of draws of that part.
    pub stated: u64,
    /// Numbers of incomplete draws and clears, by the kind of what is missing.
    pub gaps: BTreeMap<&'static str, u64>,
    /// Lines that no form has: their number, and the first with its text.
    pub unknown_lines: (u64, Option<(u64, String)>),
    /// The first words of a push buffer that make no sense, with their lines or addresses.
    pub faults: Vec<(u64, Fault)>,
    /// Number of such words.
    pub fault_count: u64,
}

/// Most faults that are kept.
const FAULTS: usize = 16;

impl Summary {
    fn count(&mut self, line: u64, class: u32, method: u32, words: u64) {
        let place = Family::from_class(class).and_then(|family| family.find(method));
        let number = place.map_or(method, |place| place.method.number);
        self.methods.entry((class, number)).or_insert(Use { count: 0, line }).count += words;
    }

    /// Returns the number of words of 3D classes, or of their methods of a treatment.
    pub fn words(&self, treatment: Option<Treatment>) -> u64 {
        let treated = self.methods.iter().filter(|((class, method), _)| {
            Family::from_class(*class).is_some_and(|family| {
                let found = family.find(*method).map_or(Treatment::Open, |place| place.method.treatment);
                treatment.is_none_or(|treatment| treatment == found)
            })
        });
        treated.map(|(_, used)| used.count).sum()
    }
}

/// Follows a log.
pub struct Importer<'a> {
    state: State,
    sources: Sources,
    options: Options,
    builder: Builder,
    frame: u64,
    draw: u64,
    line: u64,
    summary: Summary,
    each: &'a mut dyn FnMut(Frame),
}

impl std::fmt::Debug for Importer<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Importer").field("frame", &self.frame).field("draw", &self.draw).finish_non_exhaustive()
    }
}

impl<'a> Importer<'a> {
    /// Makes an importer for a log that begins in `state`. `each` takes the frames.
    pub fn new(state: State, sources: Sources, options: Options, each: &'a mut dyn FnMut(Frame)) -> Importer<'a> {
        let (builder, summary) = (Builder::new(0, options.surfaces_in_memory), Summary::default());
        Importer { state, sources, options, builder, frame: 0, draw: 0, line: 0, summary, each }
    }

    /// Returns the state as it is now.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Follows an entry.
    pub fn take(&mut self, entry: &Entry) {
        let Entry { line, event } = entry;
        self.line = *line;
        match event {
            Event::Write(Write { class, method, .. }) => self.summary.count(*line, *class, *method, 1),
            Event::Dropped { class, method, count } => self.summary.count(*line, *class, *method, count.unwrap_or(1)),
            Event::Fault(fault) => {
                self.summary.fault_count += 1;
                if self.summary.faults.len() < FAULTS {
                    self.summary.faults.push((*line, *fault));
                }
            }
            _ => {}
        }
        match self.state.follow(*line, event) {
            Some(Action::Draw(batch)) => {
                if self.wants() {
                    self.take_dumps();
                    self.builder.draw(&self.state, &self.sources, &batch, self.draw);
                }
                self.draw += 1;
                if self.options.part == Part::EachDraw {
                    self.hand_over(self.draw);
                }
            }
            Some(Action::Clear(word))
                if matches!(self.options.part, Part::All) || self.options.part == Part::Frame(self.frame) =>
            {
                self.builder.clear(&self.state, *line, word);
            }
            Some(Action::Flip) => {
                self.summary.flips += 1;
                self.flip();
            }
            _ => {}
        }
    }

    fn wants(&self) -> bool {
        match self.options.part {
            Part::All | Part::EachDraw => true,
            Part::Frame(frame) => frame == self.frame,
            Part::Draw(draw) => draw == self.draw,
        }
    }

    /// Takes the dumps of a draw: registers and constants complete the state, and textures go into memory, where the units read them.
    fn take_dumps(&mut self) {
        let dumps = &self.sources.dumps;
        let registers = dumps.registers(self.draw).map(|dump| pgraph::methods(&dump)).unwrap_or_default();
        let [program, constants] =
            [Ram::Program, Ram::Constants].map(|ram| dumps.ram(self.draw, ram).unwrap_or_default());
        self.state.complete(&registers, &program, &constants);
        for TextureDump { unit, layer, bytes } in self.sources.dumps.textures(self.draw) {
            let Some(address) = self.state.get(of_unit(class::SET_TEXTURE_OFFSET, unit)) else { continue };
            let count = bytes.len() as u64;
            let address = u64::from(address) + u64::from(layer) * count;
            if self.sources.memory.put(address, bytes) {
                self.builder.forget_images(address..address + count);
            }
        }
    }

    fn flip(&mut self) {
        self.frame += 1;
        if self.options.part != Part::EachDraw {
            self.hand_over(self.frame);
        }
    }

    /// Ends the frame that is being built, and begins one of this number.
    fn hand_over(&mut self, next: u64) {
        let builder = std::mem::replace(&mut self.builder, Builder::new(next, self.options.surfaces_in_memory));
        if !builder.is_empty() {
            let frame = builder.finish(&self.sources);
            self.summary.frames += 1;
            for drawn in &frame.drawn {
                if drawn.number.is_some() {
                    self.summary.stated += 1;
                    self.summary.complete += u64::from(drawn.gaps.is_empty());
                }
                let mut kinds: Vec<&str> = drawn.gaps.iter().map(crate::gap::Gap::kind).collect();
                kinds.sort_unstable();
                kinds.dedup();
                for kind in kinds {
                    *self.summary.gaps.entry(kind).or_default() += 1;
                }
            }
            (self.each)(frame);
        }
    }

    /// Ends the log, and returns its counts. `reader` read it, if it is text.
    pub fn finish(mut self, reader: Option<&Reader>) -> Summary {
        if let Some(batch) = self.state.unfinished() {
            if self.wants() {
                self.builder.unfinished(&batch, self.draw);
            }
            self.draw += 1;
        }
        self.frame += 1;
        self.hand_over(self.frame);
        self.summary.draws = self.draw;
        if let Some(reader) = reader {
            self.summary.unknown_lines = (reader.unknown, reader.first_unknown.clone());
        }
        self.summary
    }
}

/// Follows a whole log that is in memory, for tests and for small logs.
pub fn import(text: &[u8], state: State, memory: &Memory, options: Options) -> (Vec<Frame>, Summary) {
    let mut frames = Vec::new();
    let mut each = |frame| frames.push(frame);
    let sources = Sources { memory: memory.clone(), ..Sources::default() };
    let mut importer = Importer::new(state, sources, options, &mut each);
    let mut reader = Reader::new();
    reader.feed(text, &mut |entry| importer.take(&entry));
    reader.finish(&mut |entry| importer.take(&entry));
    let summary = importer.finish(Some(&reader));
    (frames, summary)
}

/// Returns the words of a chip's combiners that a log leaves set, a method and its word a line; `None` if the bytes are no log. Register words
/// alone are none: they have a reader of their own.
pub fn combiner_words(bytes: &[u8], chip: Profile) -> Option<String> {
    let class = if chip == Profile::Nv10 { CELSIUS } else { KELVIN };
    let (mut reader, mut words) = (Reader::of_class(class), BTreeMap::new());
    let mut take = |entry: Entry| {
        if let Event::Write(Write { class, method, word }) = entry.event
            && Family::from_class(class).is_some_and(|family| family.profile() == chip)
            && RegisterWord::of_method(method, chip).is_some()
        {
            words.insert(method, word);
        }
    };
    reader.feed(bytes, &mut take);
    reader.finish(&mut take);
    let lines = words.iter().map(|(method, word)| format!("0x{method:04x} 0x{word:08x}\n"));
    reader.is_log().then(|| lines.collect())
}

/// A line of assumed state that says nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AssumptionError {
    /// Number of the line, from 1.
    pub line: usize,
    /// The line.
    pub text: String,
}

/// Reads state that the user or another log states, and sets it: lines of any form of a log, or a method's name with its word,
/// `SET_COLOR_MASK 0x01010101`, `SET_COMBINER_COLOR_ICW[1] = 0x04200000`. What draws is left out. Lines without a class are of `class`. Returns the
/// methods that were set.
///
/// # Errors
/// The first line that is neither.
pub fn assume(state: &mut State, class: u32, text: &str) -> Result<Vec<u32>, AssumptionError> {
    let mut methods = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let mut reader = Reader::of_class(class);
        let mut writes = Vec::new();
        let mut take = |entry: Entry| {
            if let Event::Write(write) = entry.event {
                writes.push(write);
            }
        };
        reader.feed(line.as_bytes(), &mut take);
        reader.finish(&mut take);
        if reader.unknown > 0 {
            let named = named(line, Family::from_class(class).unwrap_or_default());
            let (method, word) = named.ok_or_else(|| AssumptionError { line: number + 1, text: line.to_owned() })?;
            writes = vec![Write { class, method, word }];
        }
        for Write { class, method, word } in writes {
            state.assume(class, method, word);
            methods.push(method);
        }
    }
    Ok(methods)
}

/// Reads a method's name, an index in brackets or none, and a word.
fn named(line: &str, family: Family) -> Option<(u32, u32)> {
    let line = line.trim();
    let end = line.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(line.len());
    let (name, rest) = line.split_at(end);
    let prefixes = ["NV097_", "NV10_3D_"];
    let name = prefixes.iter().find_map(|prefix| name.strip_prefix(prefix)).unwrap_or(name).to_ascii_uppercase();
    let method = family.methods().iter().find(|method| method.name == name)?;
    let (mut number, mut rest) = (method.number, rest.trim_start());
    let strides = if method.count == 1 { [4, 4] } else { [method.stride, 4] };
    for stride in strides {
        let Some((index, after)) = rest.strip_prefix('[').and_then(|rest| rest.split_once(']')) else { break };
        number = number.checked_add(index.trim().parse::<u32>().ok()?.checked_mul(stride)?)?;
        rest = after.trim_start();
    }
    let found = family.find(number)?;
    let word = rest.trim_start_matches([':', '=', ' ']).trim().trim_end_matches(';');
    let word = match word.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).ok()?,
        None => word.parse::<u32>().ok().or_else(|| word.parse::<f32>().ok().map(f32::to_bits))?,
    };
    (found.method.number == method.number).then_some((number, word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assumptions_are_lines_or_names() {
        let mut state = State::default();
        let text = "# what the driver sets first\nNV097_SET_COLOR_MASK 0x01010101\nset_combiner_color_icw[1] = 0x04200000\n\
                    0x0304 0x1\nSET_COMPOSITE_MATRIX[5]: 0.5\nSET_TEXTURE_SET_BUMP_ENV_MAT[1][2] 1.0\n\
                    nv2a_pgraph_method 0: 0x97 -> 0x1d94 NV097_CLEAR_SURFACE[0] 0xf3";
        assert!(assume(&mut state, KELVIN, text).is_ok());
        assert_eq!(state.get(class::SET_COLOR_MASK), Some(0x0101_0101));
        assert_eq!(state.get(0xac4), Some(0x0420_0000));
        assert_eq!((state.get(0x304), state.get(0x694)), (Some(1), Some(0.5_f32.to_bits())));
        assert_eq!(state.get(class::SET_TEXTURE_SET_BUMP_ENV_MAT + 64 + 8), Some(1.0_f32.to_bits()));
        let wrong = assume(&mut state, KELVIN, "\nSET_NOTHING 1").unwrap_err();
        assert_eq!((wrong.line, wrong.text.as_str()), (2, "SET_NOTHING 1"));
        assert!(assume(&mut state, KELVIN, "SET_COLOR_MASK[4] 1").is_err());
    }

    fn frames(text: &str, part: Part) -> (Vec<Frame>, Summary) {
        import(text.as_bytes(), State::default(), &Memory::default(), Options { part, ..Options::default() })
    }

    #[test]
    fn the_combiners_of_a_log_are_its_last_words() {
        let log = "nv2a_pgraph_method 0: 0x97 -> 0x0ac0 NV097_SET_COMBINER_COLOR_ICW[0] 0x1\n\
                   nv2a_pgraph_method 0: 0x97 -> NV097_SET_COMBINER_COLOR_ICW[0]<0xac0> (0x2 {[A: Zero]} <0x2>)\n\
                   nv2a_pgraph_method 0: 0x97 -> 0x0304 NV097_SET_BLEND_ENABLE[0] 0x1\n";
        assert_eq!(combiner_words(log.as_bytes(), Profile::Nv2a).as_deref(), Some("0x0ac0 0x00000002\n"));
        assert_eq!(combiner_words(b"0x0ac0 0x00000002\n", Profile::Nv2a), None);
        assert_eq!(combiner_words(b"RC_IN_RGB 0x00000002\n", Profile::Nv2a), None);
    }

    #[test]
    fn frames_end_at_flips() {
        let surface = "0x0200 0x00400000\n0x0204 0x00400000\n0x0208 0x128\n0x0210 0x1000\n0x0290 0x100000\n0x1d98 0x003f0000\n0x1d9c 0x003f0000\n";
        let clear = "0x1d90 0xff102030\n0x1d94 0xf0\n";
        let text = format!("{surface}{clear}0x0130 0x0\n{clear}0x0130 0x0\n0x0130 0x0\n");
        let (all, summary) = frames(&text, Part::All);
        assert_eq!((all.len(), summary.frames, summary.draws), (2, 2, 0));
        assert!(all.iter().all(Frame::is_complete), "{all:?}");
        assert_eq!(all[0].scene.targets[0].clear_color, [0x10, 0x20, 0x30, 0xff]);
        let (second, _) = frames(&text, Part::Frame(1));
        assert_eq!((second.len(), second[0].number), (1, 1));
        let used = summary.methods[&(KELVIN, class::CLEAR_SURFACE)];
        assert_eq!((used.count, used.line), (2, 9));
    }

    #[test]
    fn nothing_is_invented() {
        let (all, summary) = frames("0x17fc 0x5\n0x1818 0x0\n0x17fc 0x0\n0x17fc 0x6\n", Part::All);
        assert_eq!((summary.draws, summary.complete), (2, 0));
        let gaps: Vec<String> = all[0].drawn.iter().flat_map(|drawn| &drawn.gaps).map(ToString::to_string).collect();
        assert!(gaps.iter().any(|gap| gap.contains("SET_SURFACE_FORMAT were never set in this log")), "{gaps:?}");
        assert!(gaps.iter().any(|gap| gap == "the log ends within the draw"), "{gaps:?}");
        assert!(all[0].scene.draws.is_empty());
    }
}
