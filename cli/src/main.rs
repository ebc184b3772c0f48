//! The program `binspace`.

fn main() {}
