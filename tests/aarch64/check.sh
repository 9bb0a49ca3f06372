#!/usr/bin/env bash
# Builds the tests for aarch64 Linux and runs those that need no other program under emulation: both engines on random scenes and on every scene of the
# repository, the independent oracle, textures, vertex programs, other people's test values.
#
#     tests/aarch64/check.sh [SCENES]
#
# Debian: `apt-get install gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user`; and `rustup target add aarch64-unknown-linux-gnu`. Not part of the test run: it
# builds for some minutes. SCENES (default 2000) is how many random scenes are drawn; the digest that is printed must be that of any other machine.
set -euo pipefail
cd "$(dirname "$0")/../.."

export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu"
export NINEBIT_ENGINE_SCENES=${1:-2000}
cargo test --release --locked --target aarch64-unknown-linux-gnu --test suite -- --nocapture \
    engines:: oracle:: textures:: texture_properties:: compressed:: dds_files:: third_party truth:: vertex_scenes:: vertex_programs:: combiner_language::
cargo test --release --locked --target aarch64-unknown-linux-gnu --package ninebit-oracle
