//! What happens when the program is told to end: no temporary file stays.

/// From now on a signal that ends the program removes temporary files first.
#[cfg(unix)]
pub(crate) fn install() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    // Whoever starts the program may have it ignore some, as `nohup` does: these are left alone. The first stands in the
    // lowest bit; none where the system does not tell.
    let status = ninebit_files::read::page(std::path::Path::new("/proc/self/status")).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    let wanted = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    // Without them the program works as well.
    let Ok(mut signals) = Signals::new(wanted) else { return };
    let wait = move || {
        if let Some(signal) = signals.forever().next() {
            ninebit_files::output::abandon();
            // The status says which signal it was.
            let _ = emulate_default_handler(signal);
        }
    };
    let _ = std::thread::Builder::new().name("signals".to_owned()).spawn(wait);
}

/// Elsewhere temporary files of a program that is told to end stay: nobody reads them.
#[cfg(not(unix))]
pub(crate) fn install() {}
