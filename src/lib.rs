//! Ninebit: a deterministic, bit-accurate fixed-point model of GeForce-256-class texture units and register combiners.
//!
//! A scene (vertices, state, textures) goes in; stored bytes come out, and for any pixel a trace of every integer on the way. The
//! model counts values, not cycles.
//!
//! # The way of a scene
//!
//! ```text
//! text -> scene -> state -> plan -> engine -> frames, traces
//!                                     |
//!              number . raster . texture . combiner . rop
//! ```
//!
//! * [`scene`] reads and checks RON text; [`limits`] says how much it accepts.
//! * [`state`] is what remains: plain data in the chip's own terms. It can also be built directly, as below.
//! * [`plan`] keeps what can reach a frame. Whatever can fail has failed when a [`plan::Plan`] exists.
//! * [`engine`] walks triangles in 2x2 quads and runs the blocks for each pixel: [`raster`], [`texture`], [`combiner`], [`rop`].
//! * [`number`] holds the lanes: the integers of the definition, the real numbers of the ideal, and both side by side. Each rule is one
//!   text, generic over the lane.
//! * [`trace`] is how the blocks report what they do; [`report`] prints it.
//! * [`diff`] holds two pictures against each other, [`replay`] scenes against what is expected of them.
//!
//! Every rule has an id (`CMB-3`), a grade that says how well it is known, a source and a test: `docs/numerics.md`.
//!
//! # Example
//!
//! One pixel: a white triangle, its colour halved by the final combiner (128 of 255, times 255, rounded to the nearest 255th).
//!
//! ```
//! use ninebit::engine::{RenderOptions, render};
//! use ninebit::plan::{Plan, PlanOptions};
//! use ninebit::state::*;
//!
//! let mut inputs = [FinalInput::zero(Component::Rgb); 6];
//! inputs[0].register = FinalRegister::ConstantColor0; // A
//! inputs[1].register = FinalRegister::PrimaryColor; // B
//! let final_combiner = FinalCombiner {
//!     inputs,
//!     g: FinalInput { register: FinalRegister::Zero, component: Component::Alpha, invert: true },
//!     color_sum_clamp: false,
//!     invert_spare0: false,
//!     invert_secondary: false,
//!     constants: [[128, 128, 128, 0], [0; 4]],
//! };
//! let idle = GeneralStage {
//!     rgb: Portion::idle(Component::Rgb),
//!     alpha: Portion::idle(Component::Alpha),
//!     constants: [[128, 128, 128, 0], [0; 4]],
//! };
//! let corner = |x: f32, y: f32| Vertex { position: [x, y, 0.0, 1.0], ..Vertex::default() };
//! let draw = Draw {
//!     name: "triangle".into(),
//!     target: 0,
//!     positions: Positions::Window,
//!     vertices: vec![corner(0.0, 0.0), corner(2.0, 0.0), corner(0.0, 2.0)].into(),
//!     indices: [0, 1, 2].into(),
//!     topology: Topology::Triangles,
//!     shade_model: ShadeModel::Smooth,
//!     provoking_vertex: ProvokingVertex::First,
//!     perspective: true,
//!     cull: Cull::None,
//!     front_face: FrontFace::CounterClockwise,
//!     scissor: None,
//!     fog: Fog { enabled: false, color: [0; 3], function: None },
//!     textures: [None; TEXTURE_UNITS],
//!     texture_shader: [0, 1, 2, 3].map(|unit| ShaderStage::conventional(unit, false)),
//!     combiners: Combiners { stages: vec![idle], mux_select: MuxSelect::Msb, final_combiner },
//!     program_origin: vec![],
//!     vertex_program: None,
//!     alpha_test: None,
//!     depth_test: None,
//!     blend: None,
//!     blend_constant: [0; 4],
//!     color_mask: [true; 4],
//! };
//! let target = Target {
//!     name: "frame".into(),
//!     width: 1,
//!     height: 1,
//!     format: SurfaceFormat::A8R8G8B8,
//!     clear_color: [0; 4],
//!     depth: None,
//! };
//! let scene =
//!     Scene { profile: Profile::Nv10, targets: vec![target], textures: vec![], palettes: vec![], draws: vec![draw] };
//! let plan = Plan::compile(&scene, &PlanOptions::default()).expect("within the limits");
//! let frames = render(&plan, &RenderOptions::default());
//! assert_eq!(frames.surfaces[0].words, [0xff80_8080]);
//! ```

pub mod accuracy;
pub mod chart;
pub mod combiner;
pub mod compare;
pub mod diagnostic;
pub mod diff;
pub mod engine;
pub mod expectation;
pub mod explain;
pub mod frame;
pub mod generate;
mod guard;
pub mod limits;
pub mod number;
pub mod output;
pub mod picture;
pub mod plan;
pub mod program;
pub mod random;
pub mod raster;
pub mod replay;
pub mod report;
pub mod rop;
pub mod scene;
pub mod shard;
mod spelling;
pub mod state;
pub mod sweep;
pub mod texture;
pub mod threads;
pub mod trace;
pub mod truth;
mod vector;
pub mod vectors;
pub mod vertex;
