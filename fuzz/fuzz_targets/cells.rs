#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| binspace_fuzz::cells(data));
