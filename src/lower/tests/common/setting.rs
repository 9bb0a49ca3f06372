//! Settings of the tests of printed code, and the parts that their random cases share.

use std::path::Path;
use std::process::Command;

use ninebit::random::Random;
use ninebit::state::{POLICIES, Policies, Register};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Returns the number in an environment variable, if it is set.
pub fn setting(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|text| text.parse().unwrap_or_else(|_| panic!("{name} is no number: {text}")))
}

/// The registers that hold interpolated or sampled values when a program begins.
pub const GIVEN: [Register; 7] = [
    Register::PrimaryColor,
    Register::SecondaryColor,
    Register::Fog,
    Register::Texture0,
    Register::Texture1,
    Register::Texture2,
    Register::Texture3,
];

/// Returns random policies, with each alternative equally likely.
pub fn any_policies(random: &mut Random) -> Policies {
    let mut policies = Policies::DEFAULT;
    for policy in POLICIES {
        let (value, _) = random.pick(policy.values).unwrap();
        policies.set(&format!("{}={value}", policy.rule)).unwrap();
    }
    policies
}

/// Returns a value that a register can hold: colours are bytes, textures may be signed. The ends of ranges are more frequent.
pub fn any_value(register: Register, random: &mut Random) -> [i32; 4] {
    let low = if register as usize >= Register::Texture0 as usize { -256 } else { 0 };
    std::array::from_fn(|_| match random.below(8) {
        0 => 255,
        1 => low,
        // Both sides of the threshold of muxes.
        2 => 127 + random.below(2) as i32,
        _ => low + random.below((256 - low) as u128) as i32,
    })
}

/// Returns a runner that draws random programs and scenes, the same ones for the same seed.
pub fn runner(seed: u64) -> TestRunner {
    TestRunner::new_with_rng(Config::default(), TestRng::from_seed(RngAlgorithm::ChaCha, &[seed as u8; 32]))
}

/// Returns whether a command succeeds.
pub fn works(program: &str, arguments: &[&str]) -> bool {
    Command::new(program).args(arguments).output().is_ok_and(|output| output.status.success())
}

/// Runs a command, which has to succeed, in a folder.
///
/// # Errors
/// The command and its output.
pub fn run(command: &mut Command, folder: &Path) -> Result<(), String> {
    let output = command.current_dir(folder).output().map_err(|error| format!("{command:?}: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    Err(format!("{command:?}:\n{}", text.chars().take(4000).collect::<String>()))
}

/// Returns the bytes of words in a file.
pub fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Returns a command that runs one of the tests' Python scripts with software rendering.
pub fn drawing(script: &str) -> Command {
    let mut command = Command::new(python());
    command.env("LIBGL_ALWAYS_SOFTWARE", "1").env("GALLIUM_DRIVER", "llvmpipe").env("WGPU_BACKEND_TYPE", "Vulkan");
    // Programs that draw every draw are compiled once.
    command.env("MESA_SHADER_CACHE_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("shaders"));
    command.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tools").join(script));
    command
}

/// Returns the name of the Python that has `moderngl`, `wgpu` and `numpy`.
pub fn python() -> String {
    std::env::var("NINEBIT_LOWER_PYTHON").unwrap_or_else(|_| "python3".to_string())
}

/// The reference compiler of GLSL.
pub const GLSL_COMPILER: &str = "glslangValidator";

/// Returns the name of the C compiler.
pub fn compiler() -> String {
    std::env::var("CC").unwrap_or_else(|_| "cc".to_string())
}
