//! The `ninebit` command.

fn main() -> std::process::ExitCode {
    ninebit_cli::main()
}
