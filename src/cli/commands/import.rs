//! The command `ninebit import`: logs of real programs become scenes.

mod chip;

use self::chip::Comparison;
use super::scene::write_scene;
use super::*;
use std::collections::BTreeMap;
use std::fmt::Write as _;

use ninebit::limits::{LOG, Limits, MEMORY_IMAGE};
use ninebit::plan::PlanOptions;
use ninebit_files::output::write_below;
use ninebit_files::pending::PendingFolder;
use ninebit_files::read::{self, Kind, ReadError};
use ninebit_methods::class::{self, Family, KELVIN, Treatment};
use ninebit_methods::dumps::{Dumps, LOG_FILE};
use ninebit_methods::explain::{combiners, register_words, settings};
use ninebit_methods::frame::Frame;
use ninebit_methods::import::{Importer, Options, Part, Sources, Summary, assume};
use ninebit_methods::log::{Fault, Reader};
use ninebit_methods::memory::Memory;
use ninebit_methods::pgraph;
use ninebit_methods::pushbuffer::{self, Stop};
use ninebit_methods::state::State;
use ninebit_report::explain::{explain, explanation_text};
use ninebit_scene::assets::Bundle;
use ninebit_scene::write::{self, WriteOptions};
use ninebit_scene::{ProgramLanguage, load_program_with};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The log, in any of the forms that emulators, hardware tracers and recompilers print; `-` is standard input. Or the folder of a hardware
    /// tracer: its log and its dumps of textures and surfaces
    #[arg(value_name = "LOG", required_unless_present = "push_buffer")]
    log: Option<PathBuf>,
    /// The folder that is made, with a scene of each frame and what it names
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print what each draw does, and write nothing: surfaces, equations, what is missing
    #[arg(long)]
    explain: bool,
    /// An image of the console's memory from address 0 on: textures, palettes, vertices
    #[arg(long, value_name = "RAM.bin")]
    memory: Option<PathBuf>,
    /// The memory was recorded before the log: surfaces begin with what it holds
    #[arg(long, requires = "memory")]
    surfaces_in_memory: bool,
    /// Words of a push buffer in the memory, from one address to another, in place of a log
    #[arg(long, value_name = "FIRST..END", requires = "memory", conflicts_with = "log", value_parser = addresses)]
    push_buffer: Option<(u64, u64)>,
    /// The 3D class of words, names and lines that say none: `0x97` (NV2A, NV20), `0x56` (NV10), ...
    #[arg(long, value_name = "CLASS", default_value = "0x97", value_parser = class_number)]
    class: u32,
    /// A scene of each draw, in place of each frame. With the dumps of a hardware tracer each begins as the chip's surface was
    #[arg(long, conflicts_with_all = ["frame", "draw"])]
    each_draw: bool,
    /// State before the first line: another log, whose draws are left out; or the 8 KiB of PGRAPH's registers
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// State that you know and no log has: a method's name and its word a line, `SET_COLOR_MASK 0x01010101`
    #[arg(long, value_name = "FILE")]
    assume: Option<PathBuf>,
    /// Only this frame, numbered from 0
    #[arg(long, value_name = "N", conflicts_with = "draw")]
    frame: Option<u64>,
    /// Only this draw, numbered from 0 through the whole log
    #[arg(long, value_name = "N")]
    draw: Option<u64>,
}

/// Reads `0x03f90000..0x03fc0000`.
fn addresses(text: &str) -> Result<(u64, u64), String> {
    let number = |text: &str| {
        let text = text.trim();
        match text.strip_prefix("0x") {
            Some(digits) => u64::from_str_radix(digits, 16).ok(),
            None => text.parse().ok(),
        }
    };
    let pair = text.split_once("..").and_then(|(first, end)| Some((number(first)?, number(end)?)));
    match pair {
        Some((first, end)) if first < end && first % 4 == 0 && end % 4 == 0 => Ok((first, end)),
        _ => Err("two addresses of words are needed, the first the lower one: 0x03f90000..0x03fc0000".to_owned()),
    }
}

fn class_number(text: &str) -> Result<u32, String> {
    let number = u32::from_str_radix(text.trim_start_matches("0x"), 16).ok();
    number.filter(|class| Family::from_class(*class).is_some()).ok_or_else(|| {
        let known = class::CLASSES.iter().map(|(class, _)| format!("0x{class:x}")).collect::<Vec<_>>();
        format!("a class that is followed is needed: {}", known.join(", "))
    })
}

/// Imports a log.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let (log, dumps) = match &arguments.log {
        Some(folder) if folder.is_dir() => {
            let unreadable = |error: std::io::Error| unreadable(folder, error.into());
            (Some(folder.join(LOG_FILE)), Dumps::open(folder).map_err(unreadable)?)
        }
        log => (log.clone(), Dumps::default()),
    };
    let memory = match &arguments.memory {
        Some(path) => {
            Memory::new(read::bytes(path, Kind::Regular, MEMORY_IMAGE).map_err(|error| unreadable(path, error))?)
        }
        None => Memory::default(),
    };
    let mut state = State::default();
    for path in [&arguments.state, &arguments.assume].into_iter().flatten() {
        let bytes = read::bytes(path, Kind::Stream, LOG).map_err(|error| unreadable(path, error))?;
        if bytes.len() == pgraph::DUMP_BYTES && bytes.contains(&0) {
            pgraph::methods(&bytes).into_iter().for_each(|(method, word)| state.assume(KELVIN, method, word));
            continue;
        }
        assume(&mut state, arguments.class, &String::from_utf8_lossy(&bytes)).map_err(|error| {
            let message =
                format!("`{}`, line {}: `{}` sets no state", shown::path(path), error.line, shown::name(&error.text));
            Failure::invalid(
                "NB1601",
                message,
                "write a method and its word, `SET_COLOR_MASK 0x01010101`, or a line of a log",
            )
        })?;
    }
    let part = match (arguments.frame, arguments.draw) {
        (Some(frame), _) => Part::Frame(frame),
        (None, Some(draw)) => Part::Draw(draw),
        (None, None) if arguments.each_draw => Part::EachDraw,
        (None, None) => Part::All,
    };
    let options = Options { part, surfaces_in_memory: arguments.surfaces_in_memory };
    let folder = arguments.output.as_ref().map(|path| PendingFolder::create(path)).transpose()?;
    let mut out = Out {
        folder: folder.as_ref(),
        explanation: arguments.explain.then(String::new),
        kind: if part == Part::EachDraw { "draw" } else { "frame" },
        failure: None,
        written: Vec::new(),
        compared: Vec::new(),
    };
    let mut each = |frame: Frame| out.take(&frame);
    let sources = Sources { memory, dumps };
    let (summary, left) = follow((arguments, log.as_deref()), state, sources, options, &mut each)?;
    let Out { mut explanation, failure, written, compared, .. } = out;
    if let Some(failure) = failure {
        return Err(failure);
    }
    if let (Part::Frame(wanted) | Part::Draw(wanted), true) = (part, written.is_empty() && summary.stated == 0) {
        let (what, count) =
            if arguments.frame.is_some() { ("frame", summary.flips + 1) } else { ("draw", summary.draws) };
        let message = format!("the log has no {what} {wanted} that draws anything");
        return Err(Failure::usage(message, format!("it has {count}, numbered from 0")));
    }
    if let (Some(out), 0) = (&mut explanation, summary.draws) {
        explain_state(out, &left);
    }
    if let Some(explanation) = explanation {
        write_text(&explanation)?;
    }
    if let Some(folder) = folder {
        let text = summary_text(&summary, &written, &compared);
        write_below(&folder.path().join("import.txt"), text.as_bytes())?;
        folder.commit()?;
        if !arguments.explain {
            write_text(&text)?;
        }
    } else {
        write_text(&summary_text(&summary, &[], &compared))?;
    }
    warn(&summary, context);
    Ok(())
}

fn unreadable(path: &Path, error: ReadError) -> Failure {
    let name = shown::path(path);
    match error {
        ReadError::Missing => Failure {
            exit: Exit::Missing,
            ..Failure::invalid("NB1602", format!("there is no file `{name}`"), "check the path")
        },
        ReadError::TooLarge(limit) => Failure {
            exit: Exit::Limit,
            ..Failure::invalid(
                "NB1603",
                format!("`{name}` is larger than {limit}"),
                "cut the log, or record fewer frames",
            )
        },
        error => Failure {
            exit: Exit::Missing,
            ..Failure::invalid("NB1602", format!("`{name}` cannot be read: {error}"), "name a file that may be read")
        },
    }
}

/// Follows the log or the push buffer to its end.
fn follow(
    (arguments, log): (&Arguments, Option<&Path>),
    state: State,
    sources: Sources,
    options: Options,
    each: &mut dyn FnMut(Frame),
) -> Result<(Summary, State), Failure> {
    let memory = sources.memory.clone();
    let mut importer = Importer::new(state, sources, options, each);
    if let Some((first, end)) = arguments.push_buffer {
        let stop = pushbuffer::follow(&memory, (first, end), arguments.class, &mut |entry| importer.take(&entry));
        stop.map_err(|stop| {
            let (message, help) = match stop {
                Stop::Outside(at) => (
                    format!("the push buffer leads to 0x{at:08x}, outside of the memory that was given"),
                    "give all of the console's memory, and addresses without the bits of its mapping",
                ),
                Stop::Circle(at) => (
                    format!("the push buffer does not reach 0x{end:08x}: it goes on around 0x{at:08x}"),
                    "give the addresses GET and PUT of one moment",
                ),
                Stop::Calls(at) => {
                    (format!("calls without a return at 0x{at:08x}"), "give an address where a command begins")
                }
            };
            Failure::invalid("NB1604", message, help)
        })?;
        let state = importer.state().clone();
        return Ok((importer.finish(None), state));
    }
    let Some(path) = log else { return Ok((importer.finish(None), State::default())) };
    let mut reader = Reader::of_class(arguments.class);
    let mut take = |part: &[u8]| reader.feed(part, &mut |entry| importer.take(&entry));
    if path == Path::new("-") {
        let bytes = read::all(std::io::stdin(), LOG).map_err(|error| unreadable(path, error))?;
        take(&bytes);
    } else {
        read::parts(path, Kind::Stream, LOG, take).map_err(|error| unreadable(path, error))?;
    }
    reader.finish(&mut |entry| importer.take(&entry));
    let state = importer.state().clone();
    let summary = importer.finish(Some(&reader));
    if summary.methods.is_empty() && (summary.unknown_lines.0 > 0 || summary.fault_count == 0) {
        let first = match &summary.unknown_lines.1 {
            Some((line, text)) => format!("line {line} is `{}`", shown::name(text)),
            None => "it is empty".to_owned(),
        };
        let message = format!("`{}` has no method that is known; {first}", shown::path(path));
        return Err(Failure::invalid("NB1605", message, "docs/import.md has an example of each form that is read"));
    }
    Ok((summary, state))
}

/// Where frames go.
struct Out<'a> {
    folder: Option<&'a PendingFolder>,
    explanation: Option<String>,
    /// What a scene is: `frame` or `draw`.
    kind: &'static str,
    failure: Option<Failure>,
    /// Names of the scenes, and whether they are complete.
    written: Vec<(String, bool)>,
    /// What the comparisons with the chip's surfaces say, and whether they are exact.
    compared: Vec<(String, bool)>,
}

impl Out<'_> {
    fn take(&mut self, frame: &Frame) {
        if let Some(text) = &mut self.explanation {
            explain_frame(text, self.kind, frame);
        }
        let comparisons = chip::compare(frame, &format!("{} {}", self.kind, frame.number));
        self.compared.extend(comparisons.iter().map(|comparison| (comparison.to_string(), comparison.is_exact())));
        if self.failure.is_none()
            && let Err(failure) = self.write(frame, comparisons.first())
        {
            self.failure = Some(failure);
        }
    }

    fn write(&mut self, frame: &Frame, chip: Option<&Comparison>) -> Result<(), Failure> {
        let Some(output) = self.folder else { return Ok(()) };
        if frame.scene.targets.is_empty() {
            return Ok(());
        }
        let stem = format!("{}-{:04}", self.kind, frame.number);
        let mut comments = vec![Vec::new(); frame.scene.draws.len()];
        let mut head = vec![format!("Imported from a log of methods: {} {}.", self.kind, frame.number)];
        for drawn in &frame.drawn {
            let gaps = drawn.gaps.iter().map(|gap| format!("incomplete: {gap}"));
            match drawn.draw {
                Some(draw) => comments[draw].extend(gaps),
                None if drawn.gaps.is_empty() => {}
                None => head.extend(gaps.map(|gap| format!("{}: {gap}", drawn.name))),
            }
        }
        let folder = stem.clone();
        let options = WriteOptions { head, comments, folder, register_words: true, ..WriteOptions::default() };
        let files = write::scene(&frame.scene, &options).map_err(|error| {
            let help = "import one of its draws with `--draw`";
            Failure {
                exit: Exit::Limit,
                ..Failure::invalid("NB1606", format!("{} {}: {error}", self.kind, frame.number), help)
            }
        })?;
        write_scene(output.path(), &stem, &files)?;
        if let Some(chip) = chip {
            let picture = format!("{stem}/chip.png");
            write_below(&output.path().join(&picture), &chip.picture()?)?;
            let text = chip.expectation(picture).to_text();
            write_below(&output.path().join(format!("{stem}.expect.ron")), text.as_bytes())?;
        }
        self.written.push((format!("{stem}.ron"), frame.is_complete()));
        Ok(())
    }
}

/// Prints the state that a log without draws leaves, and what its combiners compute if it has all of their words.
fn explain_state(out: &mut String, state: &State) {
    let settings = settings(state);
    out.push_str("no draw: the state that the log leaves\n\n");
    settings.iter().for_each(|setting| _ = writeln!(out, "{setting}"));
    let words = register_words(state);
    if words.is_empty() {
        return;
    }
    out.push_str("\ncombiners\n");
    combiners(state).iter().for_each(|word| registers::line(out, word));
    let mut bundle = Bundle::default();
    bundle.files.insert("words".to_owned(), words.into_bytes());
    let (language, chip) = (ProgramLanguage::Registers, state.family().profile());
    match load_program_with(Path::new("words"), language, chip, &Limits::default(), &bundle) {
        Ok((scene, plan)) => out.push_str(&explanation_text(&plan, &explain(&scene, &plan), None)),
        Err(error) => {
            let findings = error.diagnostics.iter().map(|finding| finding.message.as_str());
            let _ = writeln!(out, "  no equations: {}", findings.collect::<Vec<_>>().join("; "));
        }
    }
}

/// Prints what each draw of a frame does.
fn explain_frame(out: &mut String, kind: &str, frame: &Frame) {
    let plan = Plan::compile(&frame.scene, &PlanOptions::default()).ok();
    let explained = plan.as_ref().map(|plan| (plan, explain(&frame.scene, plan)));
    // Writing to a string cannot fail.
    let _ = writeln!(out, "{kind} {}", frame.number);
    for drawn in &frame.drawn {
        let _ = writeln!(out, "\n{}", drawn.name);
        for gap in &drawn.gaps {
            let _ = writeln!(out, "  incomplete: {gap}");
        }
        let (Some(index), Some((plan, draws))) = (drawn.draw, &explained) else { continue };
        let text = explanation_text(plan, &draws[index..=index], None);
        for line in text.lines().skip_while(|line| !line.starts_with("draw")).skip(1) {
            let _ = writeln!(out, "{line}");
        }
    }
    out.push('\n');
}

/// Writes the counts of an import.
fn summary_text(summary: &Summary, written: &[(String, bool)], compared: &[(String, bool)]) -> String {
    let mut out = String::new();
    for (name, complete) in written {
        let _ = writeln!(out, "{name}{}", if *complete { "" } else { "  incomplete" });
    }
    let _ = writeln!(
        out,
        "frames {}, draws {}; of {} that were asked for {} are complete",
        summary.frames, summary.draws, summary.stated, summary.complete
    );
    if !compared.is_empty() {
        let exact = compared.iter().filter(|(_, is_exact)| *is_exact).count();
        let _ = writeln!(out, "surfaces compared with the chip's: {}, exact {exact}", compared.len());
        compared.iter().filter(|(_, is_exact)| !is_exact).for_each(|(text, _)| _ = writeln!(out, "  {text}"));
    }
    for (kind, count) in &summary.gaps {
        let _ = writeln!(out, "  {count:>6}  {kind}");
    }
    let mut classes: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for ((class_number, method), used) in &summary.methods {
        let family = Family::from_class(*class_number);
        let place = family.and_then(|family| family.find(*method));
        let (kind, name, note) = match place {
            Some(place) => (place.method.treatment.summary(), place.method.name.to_owned(), place.method.note),
            None if family.is_some() => ("not modelled", "unknown method".to_owned(), ""),
            None => ("of other classes", format!("class 0x{class_number:x}"), ""),
        };
        let note = if note.is_empty() || place.is_some_and(|place| place.method.treatment == Treatment::State) {
            String::new()
        } else {
            format!("  ({note})")
        };
        classes
            .entry(kind)
            .or_default()
            .push(format!("  0x{method:04x}  {name:<40}{:>9} from line {}{note}", used.count, used.line));
    }
    for (kind, lines) in classes {
        let _ = writeln!(out, "\nmethods {kind}: {}", lines.len());
        if kind != "modelled" {
            for line in lines {
                let _ = writeln!(out, "{line}");
            }
        }
    }
    out
}

/// Warns of what could not be read.
fn warn(summary: &Summary, context: Context) {
    let say = |text: String, help: &str| {
        terminal::print(Level::Warning, &Report::message(Some("NB1607"), &text, help), context.color);
    };
    if let (count, Some((line, text))) = &summary.unknown_lines
        && *count > 0
    {
        say(
            format!("{count} lines of no known form were left out; the first, line {line}, is `{text}`"),
            "docs/import.md lists the forms",
        );
    }
    if let Some((at, fault)) = summary.faults.first() {
        let what = match fault {
            Fault::Header(word) => format!("0x{word:08x} is no header of a command"),
            Fault::Branch(word) => format!("0x{word:08x} leads elsewhere, which needs the memory"),
            Fault::End(left) => format!("the words end, and {left} are missing"),
        };
        let place = if summary.unknown_lines.1.is_none() && summary.methods.is_empty() {
            String::new()
        } else {
            format!(" at {at}")
        };
        say(
            format!("{} words of the push buffer make no sense; the first{place}: {what}", summary.fault_count),
            "`--push-buffer` follows words in memory",
        );
    }
}
