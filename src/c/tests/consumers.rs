//! Uses the library from programs in other languages. Tests whose tools are not installed are ignored.
//!
//! `CC` names the C compiler, `NINEBIT_C_PYTHON` a Python with numpy, `CBINDGEN` the program that makes the header.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::{Arguments, Failed, Trial};

const HERE: &str = env!("CARGO_MANIFEST_DIR");

fn named(variable: &str, otherwise: &str) -> String {
    std::env::var(variable).unwrap_or_else(|_| otherwise.to_string())
}

/// Runs a command, which has to succeed. Returns what it prints.
fn run(command: &mut Command) -> Result<Vec<u8>, Failed> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    Err(format!("{command:?}:\n{text}").into())
}

fn works(program: &str, arguments: &[&str]) -> bool {
    Command::new(program).args(arguments).output().is_ok_and(|output| output.status.success())
}

/// Returns the folder with the libraries of this build.
fn built() -> PathBuf {
    // They are beside the test; those in the folder above may be from an earlier build.
    std::env::current_exe().unwrap().parent().unwrap().to_path_buf()
}

fn scene() -> PathBuf {
    Path::new(HERE).join("../../vectors/scenes/programs/lit-words-file.ron")
}

/// Runs the tests in C under the sanitizers of addresses and undefined behaviour; leaks are errors.
fn c(library: &str) -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let program = folder.path().join("tests");
    let mut compile = Command::new(named("CC", "cc"));
    compile.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-g", "-fsanitize=address,undefined"]);
    compile.args(["-fno-sanitize-recover=all", "-I"]).arg(Path::new(HERE).join("include"));
    compile.arg(Path::new(HERE).join("tests/c.c")).arg("-o").arg(&program);
    compile.arg(built().join(library)).args(["-lpthread", "-ldl", "-lm"]);
    run(&mut compile)?;
    let output = run(Command::new(&program).arg(scene()).env("LD_LIBRARY_PATH", built()))?;
    assert_eq!(String::from_utf8_lossy(&output), "all is well\n");
    Ok(())
}

/// Compiles a text with every warning as an error, in C99 and, by the compiler of C++, in C++11.
fn compiles(text: &str, include: &Path) -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let source = folder.path().join("program.c");
    std::fs::write(&source, text)?;
    for (name, compiler, language) in COMPILERS {
        let compiler = named(name, compiler);
        if !works(&compiler, &["--version"]) {
            continue;
        }
        let mut compile = Command::new(compiler);
        compile.args(language).args(["-Wall", "-Wextra", "-Werror", "-pedantic", "-O2", "-I"]).arg(include).arg("-c");
        run(compile.arg(&source).arg("-o").arg(folder.path().join("program.o")))?;
    }
    Ok(())
}

/// Compilers, the variables that name others, and the standards.
const COMPILERS: [(&str, &str, [&str; 3]); 4] = [
    ("CC", "cc", ["-x", "c", "-std=c99"]),
    ("CXX", "c++", ["-x", "c++", "-std=c++11"]),
    ("CLANG", "clang", ["-x", "c", "-std=c99"]),
    ("CLANGXX", "clang++", ["-x", "c++", "-std=c++11"]),
];

/// Checks that the example of the page and a program that needs next to nothing of a header compile without warnings.
fn warnings() -> Result<(), Failed> {
    let example = include_str!("../../../docs/c.md")
        .split("```c\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next())
        .ok_or("no example")?;
    compiles(example, &Path::new(HERE).join("include"))?;
    let reader = "#include \"ninebit_vectors.h\"\n\nint main(void)\n{\n    static ninebit_table table;\n    \
                  return !ninebit_open(&table, stdin);\n}\n";
    compiles(reader, &Path::new(HERE).join("../../vectors/harness/c"))
}

/// Checks that the header is what cbindgen generates from the library.
fn header() -> Result<(), Failed> {
    let config = Path::new(HERE).join("cbindgen.toml");
    let mut make = Command::new(named("CBINDGEN", "cbindgen"));
    let made = run(make.arg("--quiet").arg("--config").arg(config).arg(Path::new(HERE).join("lib.rs")))?;
    let committed = include_str!("../include/ninebit.h");
    let made = String::from_utf8(made)?;
    for (n, (ours, theirs)) in committed.lines().zip(made.lines()).enumerate() {
        assert_eq!(ours, theirs, "line {} of include/ninebit.h; src/c/cbindgen.toml says how it is made", n + 1);
    }
    assert_eq!(committed.len(), made.len());
    Ok(())
}

/// Checks that the example in C++ writes the picture that the library renders.
fn cpp() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let program = folder.path().join("picture");
    let mut compile = Command::new(named("CXX", "c++"));
    compile.args(["-std=c++17", "-Wall", "-Wextra", "-Werror", "-pedantic", "-I"]).arg(Path::new(HERE).join("include"));
    compile.arg(Path::new(HERE).join("examples/picture.cpp")).arg("-o").arg(&program);
    run(compile.arg(built().join("libninebit_c.so")))?;
    let picture = run(Command::new(&program).arg(scene()).env("LD_LIBRARY_PATH", built()))?;
    let loaded = ninebit_scene::load(&scene(), &ninebit::limits::Limits::default()).unwrap();
    let surface = &ninebit::engine::render(&loaded.plan, &Default::default()).surfaces[0];
    let mut expected = format!("P6 {} {} 255\n", surface.width, surface.height).into_bytes();
    surface.rgba8().iter().for_each(|pixel| expected.extend(&pixel[..3]));
    assert!(picture == expected, "{} bytes, not the {} expected ones", picture.len(), expected.len());
    Ok(())
}

/// Checks that the output of the example in Python is the expected one.
fn python() -> Result<(), Failed> {
    let mut command = Command::new(named("NINEBIT_C_PYTHON", "python3"));
    let output = run(command.arg(Path::new(HERE).join("examples/combine.py")).arg(built().join("libninebit_c.so")))?;
    let text = String::from_utf8(output)?;
    assert_eq!(text, EXPECTED);
    Ok(())
}

/// Output with TEXTURE0 n, n, n and a light along B: 2 (n - 128) times 254 / 255, with negative results shown as 0, and n in steps of 51.
const EXPECTED: &str =
    "[[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], [50, 50, 50, 0], [151, 151, 151, 0], [253, 253, 253, 0]]\n";

fn main() {
    let arguments = Arguments::from_args();
    let has_compiler = works(&named("CC", "cc"), &["--version"]);
    let trials = vec![
        Trial::test("c, shared", || c("libninebit_c.so")).with_ignored_flag(!has_compiler),
        Trial::test("c, static", || c("libninebit_c.a")).with_ignored_flag(!has_compiler),
        Trial::test("c and c++, without warnings", warnings).with_ignored_flag(!has_compiler),
        Trial::test("c++", cpp).with_ignored_flag(!works(&named("CXX", "c++"), &["--version"])),
        Trial::test("python", python)
            .with_ignored_flag(!works(&named("NINEBIT_C_PYTHON", "python3"), &["-c", "import numpy"])),
        Trial::test("header", header).with_ignored_flag(!works(&named("CBINDGEN", "cbindgen"), &["--version"])),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}
