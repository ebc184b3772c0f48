//! The machine and the commit that the figures were measured on.

use std::fs;
use std::thread;

/// The processor, its threads, and the operating system.
pub(super) fn describe() -> String {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    let cpu = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| model(&text));
    let cpu = cpu.unwrap_or_else(|| "unknown processor".to_owned());
    format!("{cpu}, {threads} threads, {os} {arch}")
}

/// The commit that the program was built from, or its version.
pub(super) fn commit() -> &'static str {
    option_env!("BINSPACE_COMMIT").unwrap_or(concat!("version ", env!("CARGO_PKG_VERSION")))
}

fn model(cpuinfo: &str) -> Option<String> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_model_is_read_from_its_line() {
        let text = "processor\t: 0\nmodel name\t: A Processor @ 2 GHz\nflags: x\n";
        assert_eq!(super::model(text), Some("A Processor @ 2 GHz".to_owned()));
        assert_eq!(super::model(""), None);
    }
}
