# The scripts of this repository under one roof: `just` lists them (https://just.systems). Each runs without `just`, too.

_list:
    @just --list --unsorted

# Formatting, lints, tests, replay, readers of vectors, documentation: what a change has to pass
gate:
    .ci/run

# All tests, or those whose names contain a word
test *NAME:
    cargo test {{ NAME }}

# Write generated parts of documents, messages of broken scenes and figures of techniques; look at the differences afterwards
bless:
    BLESS=1 cargo test

# Write digests of scenes
bless-digests:
    cargo run --release -- replay --bless vectors/scenes

# Make the module of `ninebit inspect` anew from HEAD; `just module --check` compares
module *OPTIONS:
    src/web/build {{ OPTIONS }}

# Make the charts and their page anew
charts:
    cargo run --release -- chart

# Licences, advisories and versions of crates
dependencies:
    .ci/check-dependencies

# Pack what is published and build each package by itself; nothing is uploaded
packages:
    .ci/check-packages

# What a release has and Linux can build, and its check
dist OUT:
    dist/build {{ OUT }}
    dist/check {{ OUT }}

# The site: documents, gallery, libraries; needs mdBook
site SITE *OPTIONS:
    dist/site {{ SITE }} {{ OPTIONS }}

# Run each fuzz target for some seconds, with a corpus if one is named
fuzz SECONDS *CORPUS:
    fuzz/run {{ SECONDS }} {{ CORPUS }}

# What readers of vectors in other languages need, then the readers
readers:
    vectors/harness/install
    vectors/harness/check

# The package for Python: its wheel, and its tests
python *OPTIONS:
    src/python/check {{ OPTIONS }}

# The drawer for GPUs, a workspace of its own: lints, and its tests by the adapter of this machine
gpu:
    src/gpu/check

# The workloads beside llvmpipe
peers *OPTIONS:
    benches/peers/compare.sh {{ OPTIONS }}
