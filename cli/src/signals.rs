//! Delays signals that end the program, during work that must not be left half done.

/// Runs a function. A signal that would end the program meanwhile ends the program afterwards.
#[cfg(not(unix))]
pub(crate) fn hold_back<T>(act: impl FnOnce() -> T) -> T {
    act()
}

#[cfg(unix)]
pub(crate) use unix::hold_back;

#[cfg(unix)]
mod unix {
    use std::sync::Once;
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

    pub(super) use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::flag::{register_conditional_default, register_usize};
    use signal_hook::low_level::emulate_default_handler;

    /// Whether signals end the program at once.
    static AT_ONCE: AtomicBool = AtomicBool::new(true);
    /// The last signal that was held back.
    static HELD: AtomicUsize = AtomicUsize::new(0);

    pub(crate) fn hold_back<T>(act: impl FnOnce() -> T) -> T {
        static ONCE: Once = Once::new();
        ONCE.call_once(handle);
        AT_ONCE.store(false, Ordering::SeqCst);
        let result = act();
        AT_ONCE.store(true, Ordering::SeqCst);
        match HELD.load(Ordering::SeqCst) {
            0 => {}
            // Ends the program; there is nothing to do if it does not.
            signal => drop(emulate_default_handler(signal as i32)),
        }
        result
    }

    fn handle() {
        for signal in [SIGHUP, SIGINT, SIGTERM] {
            if !is_ignored(signal) {
                // Without a handler a file may be left behind, but only under its temporary name.
                let _ = register_conditional_default(signal, &AT_ONCE);
                let _ = register_usize(signal, &HELD, signal as usize);
            }
        }
    }

    /// Whether the program was started with a signal ignored, as `nohup` does. On systems where
    /// that cannot be found out, SIGHUP is assumed to be ignored.
    pub(super) fn is_ignored(signal: i32) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        mask.map_or(signal == SIGHUP, |mask| mask >> (signal - 1) & 1 == 1)
    }
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use std::os::unix::process::ExitStatusExt;
    use std::process::Command;

    use super::unix::*;

    /// The signal ends a copy of the test program.
    #[test]
    fn a_signal_ends_the_program_after_what_it_was_held_back_for() {
        const MARK: &str = "BINSPACE_TEST_SIGNAL";
        if let Some(signal) = std::env::var(MARK).ok().and_then(|text| text.parse().ok()) {
            let done = hold_back(|| {
                signal_hook::low_level::raise(signal).unwrap();
                write_done()
            });
            unreachable!("{done:?}");
        }
        // The program keeps ignoring the signals that its starter, such as `nohup`, had ignored.
        let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|&signal| !is_ignored(signal));
        let heard: Vec<i32> = heard.collect();
        assert!(!heard.is_empty());
        for signal in heard {
            let mut command = Command::new(std::env::current_exe().unwrap());
            command.env(MARK, signal.to_string()).args(["--exact", "--nocapture"]);
            let name = "a_signal_ends_the_program_after_what_it_was_held_back_for";
            let output = command.arg(format!("signals::tests::{name}")).output().unwrap();
            assert_eq!(output.status.signal(), Some(signal), "{output:?}");
            assert!(String::from_utf8_lossy(&output.stdout).contains("done"), "{output:?}");
        }
    }

    fn write_done() -> std::io::Result<()> {
        use std::io::Write;

        let mut out = std::io::stdout().lock();
        out.write_all(b"done\n").and_then(|()| out.flush())
    }
}
