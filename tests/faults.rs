//! Runs every command that writes, once for each of its reads, writes and starts of a thread, and makes that one fail.
//!
//! Whatever fails, no output is torn: each is as before or as without the fault, and nothing temporary is left. A read or write that fails is
//! said with a stable code; a thread that cannot be started is done without. The commands run in processes of this binary, in which `faults`
//! plants the fault.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test fails by panicking")]

#[path = "common/bench.rs"]
mod bench;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

use bench::SCENE;
use libtest_mimic::{Arguments, Failed, Trial};
use ninebit::faults::{self, Operation};

/// First argument of a process that runs a command; the operation and its number follow, then the command line.
const AS_PROGRAM: &str = "--as-program";

/// Last line of such a process's stderr if the fault has come.
const CAME: &str = "the planted fault has come";

const OPERATIONS: [(&str, Operation); 3] =
    [("read", Operation::Read), ("write", Operation::Write), ("start", Operation::Start)];

/// A square of one colour with a truth, for charts.
const TONE: &str = "(version: 1, profile: Nv10, targets: [(width: 16, height: 16)], truth: (hemisphere: (sky: (51, 51, 51), ground: (51, 51, 51))), \
    draws: [(vertices: Matrix(matrix: Identity, mesh: Grid(columns: 1, rows: 1), diffuse: (55, 51, 51)))])";

/// Commands: those that make their inputs, and the one that is tested, one a line.
const COMMANDS: &[(&str, &str)] = &[
    ("render", "render a.ron -o frame.png --threads 3"),
    ("render, over a picture", "render a.ron -o frame.png --policy CMB-8=each\nrender a.ron -o frame.png --threads 3"),
    ("to stdout", "render a.ron -o -"),
    ("compare", "compare a.ron --heatmap errors.png --threads 2 --format json"),
    ("diff", "diff stone.png other.png -o where.png"),
    ("measure", "measure techniques/flat/tone.ron --picture truth.png"),
    ("inspect", "inspect a.ron -o page.html"),
    ("lower", "lower --generic --to c99 -o vendor"),
    ("texture", "texture a.ron:stone --decode -o texture.png"),
    ("generate", "generate normal-map stone.png -o normal.png"),
    ("op", "op combiner --a tex0 --b zero:invert --inputs in.tsv -o out.tsv"),
    ("bless", "replay a.ron --bless"),
    (
        "replay",
        "replay a.ron --bless\nreplay a.ron --policy CMB-8=each --report json=r.json,junit=r.xml,html=r.html --pictures drawn --artifacts found --threads 2",
    ),
    ("export", "vectors export --unit product -o pack"),
    (
        "export, over a pack",
        "vectors export --unit sum --unit product -o pack\nvectors export --unit product --seed 2 -o pack",
    ),
    ("check of a pack", "vectors export --unit product -o pack\nvectors check pack"),
    ("adopt", "vectors export --unit product -o pack\nvectors adopt pack results -o adopted --device geforce-256"),
    ("sweep", "vectors sweep --unit input-mapping -o leaves --threads 2"),
    ("merge", "vectors sweep --unit input-mapping -o leaves\nvectors merge leaves -o tree.json"),
    (CHART, "chart techniques --quick --only stability"),
];

/// The command that takes so long that of its operations every seventh fails.
const CHART: &str = "chart";

/// Runs a command in this process, as the program does, with a planted fault.
fn run_as_program(arguments: &[OsString]) -> ExitCode {
    let text = |n: usize| arguments[n].to_str().unwrap();
    let (_, operation) = OPERATIONS.into_iter().find(|(name, _)| *name == text(0)).unwrap();
    let planted = text(1).parse().unwrap();
    ninebit_files::files::watch();
    faults::plant(operation, planted);
    // Panics are not caught here: one ends the process with a status of its own.
    let exit = ninebit::run(&arguments[1..]);
    if planted > 0 && !faults::is_due(operation) {
        eprintln!("{CAME}");
    }
    ExitCode::from(exit)
}

/// Status and output of a run.
struct Run {
    status: Option<i32>,
    text: String,
    came: bool,
}

fn run(folder: &Path, command: &str, (name, n): (&str, usize)) -> Run {
    let mut process = Command::new(std::env::current_exe().unwrap());
    process.args([AS_PROGRAM, name, &n.to_string()]).args(command.split_whitespace()).current_dir(folder);
    // Where `CI` is set nothing is blessed.
    let output = process.stdin(Stdio::null()).env_remove("CI").output().unwrap();
    let mut text = String::from_utf8_lossy(&output.stderr).into_owned();
    let came = text.ends_with(&format!("{CAME}\n"));
    text += &String::from_utf8_lossy(&output.stdout);
    Run { status: output.status.code(), text, came }
}

/// Returns the bytes of all files of a folder and below.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in
        walkdir::WalkDir::new(folder).into_iter().map(Result::unwrap).filter(|entry| entry.file_type().is_file())
    {
        let name = entry.path().strip_prefix(folder).unwrap().to_str().unwrap().to_owned();
        found.insert(name, fs::read(entry.path()).unwrap());
    }
    found
}

fn copy(files: &BTreeMap<String, Vec<u8>>, to: &Path) {
    for (name, bytes) in files {
        fs::create_dir_all(to.join(name).parent().unwrap()).unwrap();
        fs::write(to.join(name), bytes).unwrap();
    }
}

/// Writes the answers that a card without a fault gives to the rows of a table with one result.
fn answer(folder: &Path) {
    let manifest: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("pack/MANIFEST.json")).unwrap()).unwrap();
    let table = fs::read_to_string(folder.join("pack/units/product.tsv")).unwrap();
    let mut text = String::from(
        "# ninebit-results 1\n# unit product\n# profile Nv2a\n# level L0\n# seed 1\n# behaviour BEHAVIOUR\nid\tout.ab\tstatus\n",
    );
    let behaviour = table.lines().find_map(|line| line.strip_prefix("# behaviour ")).unwrap();
    text = text.replace("BEHAVIOUR", behaviour);
    let rows: Vec<&str> = table.lines().filter(|line| !line.starts_with('#')).skip(1).collect();
    for row in &rows {
        let fields: Vec<&str> = row.split('\t').collect();
        text += &format!("{}\t{}\tok\n", fields[0], fields[4]);
    }
    text += "# unsupported 0\n";
    text += &format!("# end {} {:08x}\n", rows.len(), crc32fast::hash(text.as_bytes()));
    let device = serde_json::json!({
        "format": "ninebit-device-1", "pack": manifest["root"], "vendor": "NVIDIA Corporation", "renderer": "GeForce 256/AGP/SSE", "version": "1.2",
        "surface": "GLX window", "surface_format": "R8 G8 B8 A8, 0 sample buffers", "extensions": "GL_NV_register_combiners",
    });
    fs::create_dir_all(folder.join("results")).unwrap();
    fs::write(folder.join("results/device.json"), device.to_string()).unwrap();
    fs::write(folder.join("results/product.tsv"), text).unwrap();
}

/// Returns the files from which a command starts.
fn begin(before: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let picture = |shade: u8| {
        let pixels: Vec<[u8; 4]> = (0..64).map(|n| [shade, 3 * n, 255 - n, 255]).collect();
        ninebit_files::output::encode_png(8, 8, &pixels, ninebit_files::output::Compression::Small).unwrap()
    };
    fs::create_dir_all(at("techniques/flat")).unwrap();
    fs::write(at("techniques/flat/tone.ron"), TONE).unwrap();
    fs::write(at("a.ron"), SCENE).unwrap();
    fs::write(at("stone.png"), picture(200)).unwrap();
    fs::write(at("other.png"), picture(100)).unwrap();
    fs::write(at("in.tsv"), "tex0.r\ttex0.g\ttex0.b\n10\t20\t0\n-256\t255\t1\n").unwrap();
    for command in before {
        let run = run(folder.path(), command, ("start", 0));
        assert_eq!(run.status, Some(0), "{command}: {}", run.text);
    }
    if at("pack/units/product.tsv").exists() {
        answer(folder.path());
    }
    files(folder.path())
}

/// Returns whether a report, which tells of the fault, is whole.
fn is_whole_report(name: &str, bytes: &[u8]) -> bool {
    match name {
        "r.json" => serde_json::from_slice::<serde_json::Value>(bytes).is_ok(),
        "r.xml" => bytes.trim_ascii_end().ends_with(b"</testsuites>"),
        "r.html" => bytes.trim_ascii_end().ends_with(b"</html>"),
        _ => false,
    }
}

/// Runs a command with the n-th operation made to fail, for n from 1 until nothing fails.
fn hold(commands: &str, stride: usize, operation: &'static str) -> Result<(), Failed> {
    let mut commands: Vec<&str> = commands.lines().collect();
    let command = commands.pop().unwrap();
    let before = begin(&commands);
    let undisturbed = |n: usize| {
        let folder = tempfile::tempdir().unwrap();
        copy(&before, folder.path());
        let run = run(folder.path(), command, (operation, n));
        (run, files(folder.path()))
    };
    let (whole, after) = undisturbed(0);
    let mut faults = 0;
    for n in (1..).step_by(stride) {
        let (run, found) = undisturbed(n);
        let fail =
            |why: &str| Err(Failed::from(format!("{command}, {operation} {n}: {why}: {:?}, {}", run.status, run.text)));
        if !run.came {
            assert_eq!((run.status, found == after), (whole.status, true), "{command}: {}", run.text);
            break;
        }
        faults += 1;
        for (name, bytes) in &found {
            let is_whole = before.get(name) == Some(bytes) || after.get(name) == Some(bytes);
            if !is_whole && !is_whole_report(name, bytes) {
                return fail(&format!("`{name}` is torn or left over"));
            }
        }
        if let Some(name) = before.keys().find(|name| after.contains_key(*name) && !found.contains_key(*name)) {
            return fail(&format!("`{name}` is gone"));
        }
        if run.status == whole.status && found == after {
            // What failed was not needed: helpers of a render, or a link where a copy does.
            continue;
        }
        let wanted: &[i32] = if operation == "write" { &[7] } else { &[3, 4] };
        if operation == "start" || run.status.is_none_or(|status| !wanted.contains(&status)) {
            return fail("the status is another one");
        }
        if run.text.contains(".ninebit-") {
            return fail("a temporary name is said, which the user does not know");
        }
        let code = if operation == "write" { "NB07" } else { "NB" };
        if !run.text.contains(code) {
            return fail("no code is said");
        }
    }
    if faults == 0 && operation == "write" {
        return Err(format!("{command} writes nothing").into());
    }
    println!("{command}: {faults} of {operation}");
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    if arguments.first().is_some_and(|first| first == AS_PROGRAM) {
        return run_as_program(&arguments[1..]);
    }
    let trials = COMMANDS.iter().flat_map(|(name, commands)| {
        let stride = if *name == CHART { 7 } else { 1 };
        OPERATIONS.map(|(operation, _)| {
            Trial::test(format!("{name}: {operation}"), move || hold(commands, stride, operation))
        })
    });
    libtest_mimic::run(&Arguments::from_args(), trials.collect()).exit_code()
}
