//! The program `ninebit`: runs the command line and exits with its status.

fn main() -> std::process::ExitCode {
    ninebit::main()
}
