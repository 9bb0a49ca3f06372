//! Tests `docs/lab/stability.md`, the page on the limits of sampling: computes every number, picture and chart of the page again and compares.
//!
//! `ninebit chart --only stability` writes the section on methods. `BLESS=1 cargo test --test suite stability::` writes everything else:
//! the tables of the page, the pictures under `docs/lab/pictures/stability` and the textures of `vectors/scenes/stability`. Look at them before
//! you commit. Each section has a file of its name.

mod blocks;
mod chart;
mod content;
mod page;
mod view;

mod compressed;
mod cube;
mod experiments;
mod far;
mod lengths;
mod level_of_detail;
mod minified;
mod near_eye;
mod one_texel;

#[test]
fn textures() {
    content::check();
}

macro_rules! sections {
    ($($section:ident),+) => { $(
        #[test]
        fn $section() {
            page::check(&super::$section::section());
        }
    )+ };
}

/// One test for each section of the page, which compares it with new measurements.
mod sections {
    use super::page;
    sections!(lengths, minified, cube, far, near_eye, compressed, one_texel, level_of_detail);
}

#[test]
fn page_shows_no_other_files() {
    page::check_files();
}

#[test]
fn methods_work_and_fail_where_they_did() {
    experiments::both_sides();
}

#[test]
fn the_section_on_methods_is_what_experiments_yield() {
    experiments::page();
}
