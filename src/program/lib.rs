//! Reads and prints programs in several languages. Pixel programs of all of them become [`Combiners`](ninebit::state::Combiners).
//!
//! * [`text`]: general stages and final combiner as statements (`docs/languages/combiner-language.md`).
//! * [`combiner_calls`]: the calls of OpenGL that set register combiners (`docs/languages/programs.md`).
//! * [`registers`]: the words of the chips' registers, read and written (`docs/languages/registers.md`).
//! * [`texture_stages`]: Direct3D texture stage states; [`texture_environment`]: the OpenGL texture environment
//!   (`docs/languages/programs.md`). Both write each of their stages as equations over arguments, which `cascade` turns into
//!   general stages.
//! * [`pixel_shader`]: Direct3D pixel shaders, version 1.1 (`docs/languages/pixel-shader.md`).
//! * [`vertex_shader`]: vertex programs in the assembler language vs.1.1 (`docs/languages/vertex-shader.md`).
//! * [`legality`](ninebit::legality): what the chip allows (CMB-12), which is the same for every language. A language adds the places of a
//!   program's parts ([`Places`]) and its own words for them ([`Notation`](ninebit::legality::Notation)).
//!
//! This crate knows neither scenes nor files.

pub mod c_source;
mod calls;
pub(crate) mod cascade;
pub mod combiner_calls;
mod cursor;
mod finding;
mod lexer;
pub mod pixel_shader;
pub mod registers;
pub mod text;
pub mod texture_environment;
pub mod texture_stages;
pub mod vertex_shader;

pub use calls::{Aside, PastedProgram};
pub use finding::{Spanned, finding, warning};
pub mod spelling;
pub use ninebit::place::{Part, Place, Places, Span};
