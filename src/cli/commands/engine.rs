//! Options for drawing: threads, engine, instruction set.

use clap::Args;
use clap::builder::PossibleValuesParser;
use ninebit::engine::{Engine, Isa, RenderOptions};
use ninebit::state::Named;
use ninebit::threads;

use super::{Failure, up_to};

/// Options for drawing. The picture does not depend on them.
#[derive(Clone, Debug, Args)]
pub(crate) struct EngineArguments {
    /// Threads; 0 takes all cores. The picture does not depend on it
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = up_to::<{ threads::MAXIMUM }>)]
    pub(crate) threads: usize,
    /// What draws: one pixel at a time by the definition, or blocks of pixels. The picture does not depend on it
    #[arg(long, value_name = "ENGINE", default_value = "fast", value_parser = PossibleValuesParser::new(Engine::NAMES))]
    engine: String,
    /// The instruction set of the fast engine [default: the widest that the machine has]
    #[arg(long, value_name = "ISA", value_parser = PossibleValuesParser::new(Isa::NAMES))]
    isa: Option<String>,
}

impl EngineArguments {
    /// Converts the arguments to render options.
    pub(crate) fn options(&self) -> Result<RenderOptions, Failure> {
        let isa = self.isa.as_deref().and_then(Isa::from_name);
        if let Some(isa) = isa.filter(|isa| !isa.is_available()) {
            let help = format!("the widest that it has is {}", Isa::best().name());
            return Err(Failure::usage(format!("this machine does not have {}", isa.name()), help));
        }
        let engine = Engine::from_name(&self.engine).unwrap_or(Engine::Fast);
        Ok(RenderOptions { threads: self.threads, engine, isa, band: None })
    }
}
