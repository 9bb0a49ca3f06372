//! What tests of printed text are told, and the random things that they begin with.

use ninebit::random::Random;
use ninebit::state::{POLICIES, Policies};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// The number that a variable of the environment holds.
pub fn setting(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|text| text.parse().unwrap_or_else(|_| panic!("{name} is no number: {text}")))
}

/// Any policies: each of its alternatives as often as the others.
pub fn any_policies(random: &mut Random) -> Policies {
    let mut policies = Policies::DEFAULT;
    for policy in POLICIES {
        let (value, _) = random.pick(policy.values).unwrap();
        policies.set(&format!("{}={value}", policy.rule)).unwrap();
    }
    policies
}

/// What random programs and scenes are drawn with; the same ones for the same seed.
pub fn runner(seed: u64) -> TestRunner {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[seed as u8; 32]);
    TestRunner::new_with_rng(Config::default(), rng)
}

/// Whether a command succeeds.
pub fn works(program: &str, arguments: &[&str]) -> bool {
    std::process::Command::new(program).args(arguments).output().is_ok_and(|output| output.status.success())
}

/// The Python that has `moderngl`, `wgpu` and `numpy`.
pub fn python() -> String {
    std::env::var("NINEBIT_LOWER_PYTHON").unwrap_or_else(|_| "python3".to_string())
}

/// The compiler of C.
pub fn compiler() -> String {
    std::env::var("CC").unwrap_or_else(|_| "cc".to_string())
}
