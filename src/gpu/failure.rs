//! Reasons why a command stops, as the program `ninebit` reports them.

use ninebit::plan::PlanError;
use ninebit::raster::assemble::ScalarPart;
use ninebit::shown;
use ninebit_captures::verdict::WrongPicture;
use ninebit_files::catch_panic::Panic;
use ninebit_files::output::OutputError;
use ninebit_scene::SceneError;
use ninebit_scene::image::ImageError;

/// Reason why a command stops.
#[derive(Debug)]
pub enum Failure {
    /// What was found is printed; the exit status is left.
    Printed(u8),
    /// A scene is refused.
    Scene(Box<SceneError>),
    /// An output is not written.
    Output(OutputError),
    /// Anything else.
    Message {
        /// Error code, unless the command line is wrong.
        code: Option<&'static str>,
        /// Exit status.
        exit: u8,
        /// The message.
        message: String,
        /// Advice in one line.
        help: String,
    },
}

impl Failure {
    /// Returns the failure for a wrong command line.
    pub fn usage(message: impl Into<String>, help: impl Into<String>) -> Failure {
        Failure::Message { code: None, exit: 2, message: message.into(), help: help.into() }
    }

    /// Returns the failure for a machine without a suitable adapter.
    pub(crate) fn no_adapter(message: String) -> Failure {
        let help = "install a Vulkan driver: Debian's `mesa-vulkan-drivers` has one that runs on the CPU".to_string();
        Failure::Message { code: Some("NB1701"), exit: 4, message, help }
    }

    /// Returns the failure for a limit of the adapter.
    pub(crate) fn limit(message: String) -> Failure {
        let help = "draw it with `ninebit render`, or choose another adapter".to_string();
        Failure::Message { code: Some("NB1702"), exit: 5, message, help }
    }

    /// Returns whether a draw is not printed, since the scalar engine alone draws it.
    pub fn is_unprinted(&self) -> bool {
        matches!(self, Failure::Message { code: Some("NB0402"), .. })
    }

    /// Returns the failure for a draw that the scalar engine alone draws.
    pub(crate) fn scalar(draw: usize, part: ScalarPart) -> Failure {
        let [part, help] = part.words();
        let message = format!("the {part} of draw {draw} are not printed");
        let help = format!("{help}, or draw it with `ninebit render`");
        Failure::Message { code: Some("NB0402"), exit: 3, message, help }
    }

    /// Returns the failure for what the driver says.
    pub(crate) fn driver(message: String) -> Failure {
        let help = "update the driver, or choose another adapter; report a refused shader".to_string();
        Failure::Message { code: Some("NB1703"), exit: 6, message, help }
    }

    /// Returns the failure for a fault of this program.
    pub fn fault(message: impl Into<String>) -> Failure {
        let help = "please report it, with the command line".to_string();
        Failure::Message { code: Some("NB0801"), exit: 6, message: message.into(), help }
    }

    /// Returns the exit status.
    pub fn exit(&self) -> u8 {
        match self {
            Failure::Printed(exit) => *exit,
            Failure::Scene(error) => error.exit_code(),
            Failure::Output(error) if error.is_broken_pipe() => 0,
            Failure::Output(error) if error.is_refused() => 2,
            Failure::Output(_) => 7,
            Failure::Message { exit, .. } => *exit,
        }
    }

    /// Returns the text for stderr.
    pub fn text(&self) -> String {
        let text = |code: Option<&str>, message: &str, help: &str| {
            let code = code.map_or(String::new(), |code| format!("[{code}]"));
            format!("error{code}: {}\n  help: {}\n", shown::lines(message), shown::name(help))
        };
        match self {
            Failure::Printed(_) => String::new(),
            Failure::Scene(error) => error.render(false).trim_end().to_string() + "\n",
            Failure::Output(error) if error.is_broken_pipe() => String::new(),
            Failure::Output(error) => text(Some(error.code()), &error.to_string(), error.help()),
            Failure::Message { code, message, help, .. } => text(*code, message, help),
        }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Failure {
        Failure::Scene(Box::new(error))
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Failure {
        Failure::Output(error)
    }
}

/// Captured frames are planned without an error.
impl From<Vec<PlanError>> for Failure {
    fn from(errors: Vec<PlanError>) -> Failure {
        Failure::fault(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    }
}

impl From<WrongPicture> for Failure {
    fn from(WrongPicture(message): WrongPicture) -> Failure {
        Failure::Message { code: Some(WrongPicture::CODE), exit: 3, message, help: WrongPicture::HELP.to_string() }
    }
}

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Failure {
        let exit = match () {
            () if error.is_limit() => 5,
            () if error.is_missing() => 4,
            () => 3,
        };
        let (message, help) = (error.to_string(), error.help().to_string());
        Failure::Message { code: Some(error.code()), exit, message, help }
    }
}

impl From<Panic> for Failure {
    fn from(panic: Panic) -> Failure {
        let (message, help) = (panic.to_string(), Panic::HELP.to_string());
        Failure::Message { code: Some(Panic::CODE), exit: 6, message, help }
    }
}
