//! Conformance vectors: the results of the chip's units, as tables against which other implementations are tested.
//!
//! A [`Unit`] is a function of the model between named columns of integers. [`cases`] selects rows, [`table`] writes tables and [`read`] reads them,
//! and [`pack`] exports the tables of many units to a folder with a manifest and opens such a folder.

pub mod cases;
pub mod column;
mod digest;
pub mod error;
pub mod exhaustive;
pub mod gpu;
pub mod handbook;
mod lanes;
pub mod pack;
pub mod part;
pub mod read;
pub mod results;
pub mod table;
pub mod tree;
pub mod unit;
pub mod units;
pub mod view;

pub use table::BEHAVIOUR;
pub use unit::Unit;

use cases::{Level, Origin};
use column::{Column, Domain, Kind};
use error::{VectorError, read_text};
use exhaustive::Exhaustive;
use part::Part;
use read::Table;
use table::{Contents, Row, Writer};
use unit::Conditions;
