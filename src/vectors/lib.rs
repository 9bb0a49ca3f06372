//! Conformance vectors: what the units of the chip yield, as tables that other implementations are held to.
//!
//! A [`Unit`] is a function of the model between named columns of integers. [`cases`] chooses rows, [`table`] writes and reads them,
//! [`pack`] puts the tables of many units into a folder with a manifest and checks one.

pub mod captures;
pub mod cases;
pub mod column;
mod digest;
pub mod error;
pub mod exhaustive;
pub mod gpu;
pub mod handbook;
pub mod lanes;
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
