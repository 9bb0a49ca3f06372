//! Reproduces captured frames of a real NV2A, pixel by pixel.
//!
//! The captures are not part of the repository; `vectors/silicon/frames` has their expectations. If `NINEBIT_CAPTURES` is set to a folder
//! that contains them (`frames/SUITE/NAME.png`), they are compared directly, and `BLESS=1` rewrites the expectations.

use crate::cases::{self, Case};
use crate::picture::{Expectation, Values, digest};
use ninebit::engine::{RenderOptions, render, trace};
use ninebit::frame::Surface;
use ninebit::plan::{Plan, PlanOptions};
use ninebit_report::trace_text;
use std::path::{Path, PathBuf};

/// A case and its rendered frame.
struct Drawing {
    case: Case,
    plan: Plan,
    surface: Surface,
}

impl Drawing {
    fn new(case: Case) -> Drawing {
        let plan = Plan::compile(&case.scene, &PlanOptions::default()).unwrap();
        let surface = render(&plan, &RenderOptions::default()).surfaces.remove(0);
        Drawing { case, plan, surface }
    }

    fn index(&self, (x, y): (u32, u32)) -> usize {
        (y * self.surface.width + x) as usize
    }

    fn color(&self, at: (u32, u32)) -> u32 {
        self.surface.words[self.index(at)] & 0xff_ffff
    }

    fn depth(&self, at: (u32, u32)) -> u32 {
        self.surface.depth[self.index(at)]
    }

    fn covered(&self, at: (u32, u32)) -> bool {
        self.surface.words[self.index(at)] >> 24 == 255
    }

    /// Fails with the trace of a pixel.
    fn fail(&self, at: (u32, u32), message: &str) -> ! {
        let trace = trace(&self.plan, 0, at, None).unwrap();
        panic!("{}: pixel {},{}: {message}\n{}", self.case.name, at.0, at.1, trace_text(&self.plan, &trace));
    }

    /// Compares the rendered values with the committed expectation `name`. `ours` returns the value at a pixel.
    fn check(&self, name: &str, capture: &str, differing: usize, ours: impl Fn((u32, u32)) -> u32) {
        let path = Expectation::path(name);
        let expected = Expectation::parse(&std::fs::read_to_string(&path).unwrap());
        assert_eq!((expected.case.as_str(), expected.capture.as_str()), (name, capture));
        assert_eq!(expected.positions().count(), expected.pixels, "{name}: the mask");
        assert_eq!(expected.differing.len(), differing, "{name}: pixels known to differ");
        for (x, y, captured, value) in &expected.differing {
            let now = ours((*x, *y));
            if now != *value {
                self.fail((*x, *y), &format!("captured {captured:06x}, was {value:06x}, is {now:06x}"));
            }
        }
        let known = |at: (u32, u32)| expected.differing.iter().any(|(x, y, ..)| (*x, *y) == at);
        let values: Values = expected.positions().filter(|at| !known(*at)).map(|at| (at, ours(at))).collect();
        // A digest does not show which pixel differs, so the trace is that of the first pixel.
        if digest(&values) != expected.sha256 {
            let count = values.len();
            self.fail(
                values[0].0,
                &format!("some of {count} pixels differ from {}; set NINEBIT_CAPTURES to see which", path.display()),
            );
        }
    }

    /// Compares with a capture, and the committed expectation with both.
    fn compare(&self, name: &str, capture: &str, captured: &Values, ours: &Values, differing: usize) {
        let different: Vec<usize> = (0..captured.len()).filter(|n| captured[*n].1 != ours[*n].1).collect();
        println!("{name}: {} of {} pixels differ", different.len(), captured.len());
        if different.len() != differing {
            let n = *different.first().unwrap_or(&0);
            let (at, value, now) = (captured[n].0, captured[n].1, ours[n].1);
            let (count, of) = (different.len(), captured.len());
            self.fail(at, &format!("captured {value:06x}, ours {now:06x}; {count} of {of} differ, not {differing}"));
        }
        let text = Expectation::text(name, capture, captured, ours);
        let path = Expectation::path(name);
        if crate::settings::bless() {
            std::fs::write(&path, &text).unwrap();
        }
        assert!(std::fs::read_to_string(&path).unwrap() == text, "{} is not what the capture gives", path.display());
    }
}

/// Returns the folder of captures, if there is one.
fn captures() -> Option<PathBuf> {
    crate::settings::captures().map(|folder| folder.join("frames"))
}

fn load(path: &Path) -> image::RgbaImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgba8()
}

/// Overlaid text is white with alpha 0.
const TEXT: [u8; 4] = [255, 255, 255, 0];

fn color([r, g, b, _]: [u8; 4]) -> u32 {
    u32::from(r) << 16 | u32::from(g) << 8 | u32::from(b)
}

/// Compares the colours of a case. The covered pixels must be the same as in the capture, and only the known number of colours may differ.
fn colors(rendered: &Drawing, keep: impl Fn((u32, u32)) -> bool) {
    let case = &rendered.case;
    if let Some(folder) = captures() {
        let capture = load(&folder.join(case.capture));
        let (mut captured, mut ours, mut covered) = (Values::new(), Values::new(), 0);
        for (x, y, pixel) in capture.enumerate_pixels() {
            if !(case.region)(x, y) || pixel.0 == TEXT || !keep((x, y)) {
                continue;
            }
            let inside = rendered.covered((x, y));
            if inside == (pixel.0[..3] == case.background) {
                rendered.fail((x, y), &format!("captured {:06x}, covered by us: {inside}", color(pixel.0)));
            }
            covered += usize::from(inside);
            captured.push(((x, y), color(pixel.0)));
            ours.push(((x, y), rendered.color((x, y))));
        }
        assert_eq!(covered, case.covered, "{}: covered pixels", case.name);
        rendered.compare(case.name, case.capture, &captured, &ours, case.differing);
    }
    rendered.check(case.name, case.capture, case.differing, |at| rendered.color(at));
}

fn whole(case: Case) {
    colors(&Drawing::new(case), |_| true);
}

#[test]
fn r1_coverage_of_slivers() {
    whole(cases::r1());
}

#[test]
fn r2_ties_of_ramps() {
    whole(cases::r2());
}

#[test]
fn r4_smooth_triangles() {
    whole(cases::r4());
}

#[test]
fn r5_smooth_quads() {
    whole(cases::r5());
}

#[test]
fn r6_vertices_off_screen() {
    whole(cases::r6());
}

#[test]
fn r7_float_colors() {
    whole(cases::r7());
}

/// All colours and depths are exact.
#[test]
fn r3_three_colors_and_depth() {
    const DIFFERING: usize = 0;
    const ZB: &str = "Depth_buffer/DepthFmt_z24_Cn_FZn_Mffffff_ZB.png";
    let rendered = Drawing::new(cases::r3());
    let buffer = captures().map(|folder| load(&folder.join(ZB)));
    let stored = |(x, y): (u32, u32)| {
        let [r, g, _, a] = buffer.as_ref().unwrap().get_pixel(x, y).0;
        u32::from(a) << 16 | u32::from(r) << 8 | u32::from(g)
    };
    // Small quads lie on top of the large one. Pixels of the large one are recognised by their depth.
    let ours = |(x, y): (u32, u32)| {
        let plane = 11_184_809.0 + (f64::from(y) - 39.5) * 13_981.012_5;
        (f64::from(stored((x, y))) - plane).abs() <= 50.0
    };
    colors(&rendered, ours);
    if buffer.is_some() {
        let expectation = Expectation::parse(&std::fs::read_to_string(Expectation::path("R3")).unwrap());
        let captured: Values = expectation.positions().map(|at| (at, stored(at))).collect();
        let depths: Values = expectation.positions().map(|at| (at, rendered.depth(at))).collect();
        rendered.compare("R3-depth", ZB, &captured, &depths, DIFFERING);
    }
    rendered.check("R3-depth", ZB, DIFFERING, |at| rendered.depth(at));
}
