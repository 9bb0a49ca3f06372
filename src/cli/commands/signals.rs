//! Signal handling: removes temporary files when the program is terminated.

/// Installs a handler that removes temporary files before a signal ends the program.
#[cfg(unix)]
pub(crate) fn install() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    // Signals that the parent process ignores, as `nohup` does, are left alone. Signal 1 is the lowest bit of the mask; the mask is 0 if the system
    // does not report it.
    let status = ninebit_files::read::page(std::path::Path::new("/proc/self/status")).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    let wanted = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    // The program also works without the handler.
    let Ok(mut signals) = Signals::new(wanted) else { return };
    let wait = move || {
        if let Some(signal) = signals.forever().next() {
            ninebit_files::pending::abandon();
            // The exit status tells which signal it was.
            let _ = emulate_default_handler(signal);
        }
    };
    let _ = std::thread::Builder::new().name("signals".to_owned()).spawn(wait);
}

/// On other systems temporary files of a terminated program stay; nothing reads them.
#[cfg(not(unix))]
pub(crate) fn install() {}
