//! Runs every command that reads files on corrupted ones: scenes, expectations, programs, images, meshes, packs, results, leaves, trees,
//! waivers, tables.
//!
//! `cargo test --test campaign -- --runs 200000 --seed 1` runs a campaign. `--only N` runs only run N and keeps its files. Without `--runs`
//! the number is small enough for the test suite.
//!
//! A run is a finding if it panics (NB0801), if a signal or a failed allocation ends it, if it needs more than 1 GB, or if it takes more
//! than ten seconds of processors in addition to 500 ns for each pixel that it shades. Workers run commands in their own process, one after the other,
//! which allows thousands of runs a minute. One run in a hundred has a process of its own. A worker that dies is replaced, and its run is a
//! finding.
#![allow(
    clippy::unwrap_used,
    clippy::float_arithmetic,
    missing_docs,
    unreachable_pub,
    reason = "a driver fails by panicking, and prints times"
)]

mod cases;
mod mutate;
#[path = "../../tests/common/repository.rs"]
mod repository;

use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use cases::{Case, Corpus};
use ninebit::engine::fragments;
use ninebit::limits::Limits;
use ninebit::random::Random;

/// Number of runs in the test suite.
const RUNS: u64 = 300;
/// Largest memory of a run, in KiB.
const MAX_MEMORY: u64 = 1_000_000;
/// Largest time of a run, besides the time for its pixels.
const MAX_TIME: Duration = Duration::from_secs(10);
/// Time after which a worker that is still in the same run is killed.
const LAST_TIME: Duration = Duration::from_secs(120);
/// Time that a run may take for each shaded pixel.
const PIXEL: Duration = Duration::from_nanos(500);
/// One in this many runs of a worker has a process of its own.
const PROCESSES: u64 = 100;
/// Resident memory, in KiB, above which a worker is replaced. Memory that the allocator keeps must not count against the next run.
const STALE: u64 = 300_000;
/// Exit status of a worker that asks to be replaced.
const REPLACE: i32 = 17;

#[derive(Clone, Copy, Debug)]
struct Options {
    runs: u64,
    seed: u64,
    workers: u64,
    only: Option<u64>,
    /// For a worker: the first run, and the worker's index.
    worker: Option<(u64, u64)>,
}

fn options() -> Option<Options> {
    let mut options = Options { runs: RUNS, seed: 1, workers: 2, only: None, worker: None };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || arguments.next().and_then(|text| text.parse().ok()).expect("a number after the option");
        match argument.as_str() {
            "--runs" => options.runs = number(),
            "--seed" => options.seed = number(),
            "--workers" => options.workers = number(),
            "--only" => options.only = Some(number()),
            "--worker" => options.worker = Some((number(), number())),
            // Like other test binaries, this one does nothing if the filter does not match its name.
            filter if !filter.starts_with('-') && !"campaign".contains(filter) => return None,
            "--list" => return None,
            _ => {}
        }
    }
    Some(options)
}

fn main() -> ExitCode {
    let Some(options) = options() else { return ExitCode::SUCCESS };
    match (options.only, options.worker) {
        (Some(run), _) => only(run, &options),
        (None, Some((from, place))) => work(from, place, &options),
        (None, None) => campaign(&options),
    }
}

/// Returns the path of a folder, in memory if the system has `/dev/shm`.
fn place(name: &str) -> PathBuf {
    let base = if Path::new("/dev/shm").is_dir() { PathBuf::from("/dev/shm") } else { std::env::temp_dir() };
    base.join(format!("ninebit-campaign-{name}"))
}

/// The result of a run.
#[derive(Debug)]
struct Outcome {
    exit: Option<u8>,
    /// Message of the first panic, even if the panic was caught.
    panic: Option<String>,
    time: Duration,
    /// Peak of resident memory in KiB, 0 if it is not known.
    peak: u64,
}

static PANIC: Mutex<Option<String>> = Mutex::new(None);

fn status(field: &str) -> u64 {
    let text = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(field));
    line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse().ok()).unwrap_or(0)
}

/// A clock of the work of this process and of those that it waited for; of real time where the system does not tell. A busy machine does not make it
/// run faster.
struct Clock {
    begin: Instant,
    worked: Option<Duration>,
}

impl Clock {
    fn start() -> Clock {
        Clock { begin: Instant::now(), worked: worked() }
    }

    fn elapsed(&self) -> Duration {
        let worked = worked().zip(self.worked).map(|(now, then)| now.saturating_sub(then));
        worked.unwrap_or_else(|| self.begin.elapsed())
    }
}

/// Returns the time of processors that Linux counts for this process and its children, in steps of 10 ms.
fn worked() -> Option<Duration> {
    let text = fs::read_to_string("/proc/self/stat").ok()?;
    // The name stands in parentheses, and may hold spaces.
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks: u64 = fields.get(11..15)?.iter().map(|field| field.parse::<u64>().unwrap_or(0)).sum();
    Some(Duration::from_millis(10 * ticks))
}

/// Runs a command in this process.
fn inside(arguments: &[String]) -> Outcome {
    let arguments: Vec<OsString> =
        ["ninebit"].into_iter().chain(arguments.iter().map(String::as_str)).map(OsString::from).collect();
    *PANIC.lock().unwrap() = None;
    // Resets the peak of resident memory, on systems that can.
    let _ = fs::write("/proc/self/clear_refs", "5");
    let clock = Clock::start();
    let exit = catch_unwind(AssertUnwindSafe(|| ninebit::run(&arguments))).ok();
    Outcome { exit, panic: PANIC.lock().unwrap().take(), time: clock.elapsed(), peak: status("VmHWM:") }
}

/// Runs a command in a process of its own, whose address space is limited to 2 GB.
fn outside(folder: &Path, arguments: &[String]) -> Outcome {
    let clock = Clock::start();
    let output = Command::new("sh")
        .args(["-c", "ulimit -v 2000000; exec timeout -s KILL 120 \"$@\"", "sh", env!("CARGO_BIN_EXE_ninebit")])
        .args(arguments)
        .current_dir(folder)
        .env("RAYON_NUM_THREADS", "2")
        .stdin(Stdio::null())
        .output()
        .expect("sh starts");
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    let exit = output.status.code().and_then(|code| u8::try_from(code).ok());
    let ended = exit.is_none_or(|code| code > 7 || code == 6);
    Outcome { exit: exit.filter(|code| *code <= 7), panic: ended.then_some(stderr), time: clock.elapsed(), peak: 0 }
}

/// Returns the time that the shaded pixels of a scene account for.
fn explained(folder: &Path, case: &Case) -> Duration {
    let Some(scene) = &case.scene else { return Duration::ZERO };
    let Ok(loaded) = ninebit_scene::load(&folder.join(scene), &Limits::default()) else { return Duration::ZERO };
    let pixels: u64 = loaded.plan.draws().iter().map(|draw| fragments(&loaded.plan, draw)).sum();
    PIXEL.saturating_mul(u32::try_from(pixels).unwrap_or(u32::MAX))
}

/// Returns why a run is a finding, or `None` if it is not.
fn finding(outcome: &Outcome, folder: &Path, case: &Case) -> Option<String> {
    if let Some(panic) = &outcome.panic {
        return Some(format!("panic: {panic}"));
    }
    match outcome.exit {
        None => return Some("ended by a panic or a signal".to_owned()),
        Some(6) => return Some("exit status 6".to_owned()),
        Some(_) => {}
    }
    if outcome.peak > MAX_MEMORY {
        return Some(format!("{} MB", outcome.peak / 1000));
    }
    let slow = outcome.time > MAX_TIME && outcome.time > explained(folder, case);
    slow.then(|| format!("{:.1} s", outcome.time.as_secs_f64()))
}

fn random(options: &Options, run: u64) -> Random {
    Random::new(options.seed, &format!("run {run}"))
}

fn prepared(folder: &Path) -> Corpus {
    let repository = repository::at("");
    let _ = fs::remove_dir_all(folder);
    fs::create_dir_all(folder).unwrap();
    std::env::set_current_dir(folder).unwrap();
    Corpus::new(&repository, folder, &|arguments| {
        let outcome = inside(arguments);
        assert_eq!(outcome.exit, Some(0), "{arguments:?}: {:?}", outcome.panic);
    })
}

/// Installs a hook that records the first panic and prints nothing. Panics that the program expects from decoders do not reach the hook,
/// because `catch_panic` silences them.
fn note_panics() {
    std::panic::set_hook(Box::new(|info| {
        PANIC.lock().unwrap_or_else(std::sync::PoisonError::into_inner).get_or_insert_with(|| info.to_string());
    }));
}

/// Runs the share of one worker, beginning with run `from`. Each line of the log has the run, the exit status, microseconds and KiB, and
/// then the finding, if there is one.
fn work(from: u64, place_of: u64, options: &Options) -> ExitCode {
    note_panics();
    let folder = place(&format!("{}-{place_of}", options.seed));
    let corpus = prepared(&folder);
    let mut log = fs::OpenOptions::new().append(true).create(true).open(folder.with_extension("log")).unwrap();
    for run in (from..options.runs).filter(|run| run % options.workers == place_of) {
        let case = corpus.case(&mut random(options, run));
        fs::write(folder.with_extension("run"), format!("{run} {}", case.arguments.join(" "))).unwrap();
        let alone = (run / options.workers).is_multiple_of(PROCESSES);
        let outcome = if alone { outside(&folder, &case.arguments) } else { inside(&case.arguments) };
        let found =
            finding(&outcome, &folder, &case).map_or(String::new(), |found| format!(" {}", found.replace('\n', " ")));
        let exit = outcome.exit.map_or("-".to_owned(), |exit| exit.to_string());
        writeln!(log, "{run} {exit} {} {}{found}", outcome.time.as_micros(), outcome.peak).unwrap();
        corpus.restore(&case);
        if status("VmRSS:") > STALE {
            std::process::exit(REPLACE);
        }
    }
    ExitCode::SUCCESS
}

/// Runs a single run and keeps its files.
fn only(run: u64, options: &Options) -> ExitCode {
    note_panics();
    let folder = place(&format!("{}-only", options.seed));
    let corpus = prepared(&folder);
    let case = corpus.case(&mut random(options, run));
    eprintln!("cd {}; ninebit {}", folder.display(), case.arguments.join(" "));
    let outcome = outside(&folder, &case.arguments);
    let found = finding(&outcome, &folder, &case);
    eprintln!("{outcome:?}\n{}", found.as_deref().unwrap_or("no finding"));
    if found.is_none() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// A worker process, with the run that it was last seen at.
struct Worker {
    place: u64,
    child: Child,
    since: Instant,
    run: Option<u64>,
}

impl Worker {
    fn start(place_of: u64, from: u64, options: &Options) -> Worker {
        let numbers = [("--runs", options.runs), ("--seed", options.seed), ("--workers", options.workers)];
        let mut command = Command::new(std::env::current_exe().unwrap());
        for (name, number) in numbers {
            command.args([name.to_owned(), number.to_string()]);
        }
        command.args(["--worker".to_owned(), from.to_string(), place_of.to_string()]);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        Worker { place: place_of, child: command.spawn().unwrap(), since: Instant::now(), run: None }
    }

    fn folder(&self, options: &Options) -> PathBuf {
        place(&format!("{}-{}", options.seed, self.place))
    }

    /// Returns the current run and its command.
    fn at(&self, options: &Options) -> (Option<u64>, String) {
        let text = fs::read_to_string(self.folder(options).with_extension("run")).unwrap_or_default();
        let (run, command) = text.split_once(' ').unwrap_or_default();
        (run.parse().ok(), command.to_owned())
    }
}

/// Distributes all runs over workers, and prints the findings.
fn campaign(options: &Options) -> ExitCode {
    let begin = Instant::now();
    let mut findings = Vec::new();
    let mut workers: Vec<Worker> = Vec::new();
    for place_of in 0..options.workers {
        let folder = place(&format!("{}-{place_of}", options.seed));
        let _ = (fs::remove_file(folder.with_extension("log")), fs::remove_file(folder.with_extension("run")));
        workers.push(Worker::start(place_of, 0, options));
    }
    let mut folders = Vec::new();
    while !workers.is_empty() {
        std::thread::sleep(Duration::from_millis(100));
        let mut going = Vec::new();
        for mut worker in workers {
            let (run, command) = worker.at(options);
            if run != worker.run {
                (worker.run, worker.since) = (run, Instant::now());
            }
            let ended = worker.child.try_wait().unwrap();
            let late = ended.is_none() && worker.since.elapsed() > LAST_TIME;
            if late {
                let _ = (worker.child.kill(), worker.child.wait());
            }
            match ended {
                Some(status) if status.success() => folders.push(worker.folder(options)),
                None if !late => going.push(worker),
                _ => {
                    let replaced = ended.and_then(|status| status.code()) == Some(REPLACE);
                    let at = run.unwrap_or(0);
                    if !replaced {
                        let how =
                            ended.map_or("does not end".to_owned(), |status| format!("the worker ended: {status}"));
                        findings.push(format!("run {at}: {how}: ninebit {command}"));
                    }
                    assert!(run.is_some() && findings.len() < 100, "the workers do not work: {findings:#?}");
                    going.push(Worker::start(worker.place, at + 1, options));
                }
            }
        }
        workers = going;
    }
    let mut exits = std::collections::BTreeMap::<String, u64>::new();
    let (mut runs, mut peak, mut longest) = (0_u64, 0_u64, 0_u64);
    for folder in folders {
        let log = fs::read_to_string(folder.with_extension("log")).unwrap_or_default();
        for line in log.lines() {
            let mut words = line.splitn(5, ' ');
            let [run, exit, time, memory] = [(); 4].map(|()| words.next().unwrap_or_default());
            runs += 1;
            *exits.entry(exit.to_owned()).or_default() += 1;
            peak = peak.max(memory.parse().unwrap_or(0));
            longest = longest.max(time.parse().unwrap_or(0));
            findings.extend(words.next().map(|found| format!("run {run}: {found}")));
        }
        let _ = (
            fs::remove_dir_all(&folder),
            fs::remove_file(folder.with_extension("log")),
            fs::remove_file(folder.with_extension("run")),
        );
    }
    println!(
        "{runs} runs of seed {} in {:.0} s; exit statuses {exits:?}; at most {} MB and {:.1} s; {} findings",
        options.seed,
        begin.elapsed().as_secs_f64(),
        peak / 1000,
        longest as f64 / 1e6,
        findings.len()
    );
    for found in &findings {
        println!("{found:.2000}\n    again: cargo test --test campaign -- --seed {} --only N", options.seed);
    }
    if findings.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
