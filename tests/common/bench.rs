//! Runs the program in a temporary folder.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, reason = "each test uses a part; a test fails by panicking")]

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A scene of one triangle, textured by `stone.png`, which differs from its ideal by one step.
pub const SCENE: &str = r#"(version: 1, profile: Nv10, targets: [(name: "frame", width: 8, height: 8)],
    textures: { "stone": (source: File("stone.png")) },
    draws: [(
        vertices: Window([(position: (0, 0)), (position: (8, 0)), (position: (0, 8))]), textures: ["stone"],
        program: Combiners(stages: [(rgb: (a: ExpandNormal(Texture0), b: PrimaryColor, ab: Spare0))], final_combiner: (d: Spare0)),
    )])"#;

/// A temporary folder for runs of the program.
pub struct Bench(tempfile::TempDir);

impl Bench {
    pub fn new() -> Self {
        Bench(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> &Self {
        fs::write(self.path(name), contents).unwrap();
        self
    }

    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ninebit"));
        command.args(arguments.split_whitespace()).current_dir(self.0.path()).stdin(Stdio::null());
        for name in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "COLUMNS"] {
            command.env_remove(name);
        }
        command
    }

    pub fn run(&self, arguments: &str) -> Run {
        Run { arguments: arguments.to_owned(), ..Run::from_output(self.command(arguments).output().unwrap()) }
    }

    /// Runs the program with a closed pipe for its output, and checks that it ends without an error.
    pub fn unread(&self, arguments: &str) {
        let mut child = self.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let run = Run::from_output(child.wait_with_output().unwrap());
        assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    }
}

/// Exit status and output of a run.
#[derive(Debug)]
pub struct Run {
    /// For messages.
    pub arguments: String,
    pub status: i32,
    pub stdout: Vec<u8>,
    pub stderr: String,
}

impl Run {
    pub fn from_output(output: Output) -> Self {
        Run {
            arguments: String::new(),
            status: output.status.code().unwrap(),
            stdout: output.stdout,
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Returns stdout, after checking that the run succeeded and that stderr is empty.
    pub fn data(self) -> Vec<u8> {
        let shown = String::from_utf8_lossy(&self.stdout);
        assert_eq!((self.status, self.stderr.as_str()), (0, ""), "ninebit {}\n{shown}", self.arguments);
        self.stdout
    }

    pub fn text(self) -> String {
        String::from_utf8(self.data()).unwrap()
    }

    /// Checks that the run failed with the given status, that stderr contains the message without colours, and that stdout is empty.
    pub fn failed(self, status: i32, message: &str) {
        assert_eq!(self.status, status, "ninebit {}\n{}", self.arguments, self.stderr);
        assert!(self.stderr.contains(message), "`{message}` is not in: {}", self.stderr);
        assert!(!self.stderr.contains('\x1b'), "colour without a terminal: {:?}", self.stderr);
        assert_eq!(self.stdout, b"", "diagnostics belong to stderr");
    }
}
