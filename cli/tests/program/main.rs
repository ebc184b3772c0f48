//! The program as its users run it: the real binary, its files, its exit status.

mod bad_input;
mod cells;
mod cull;
mod demo;
mod draw;
mod draw_dxf;
mod draw_ink;
mod draw_lines;
mod draw_pdf;
mod draw_png;
mod draw_refused;
mod draw_seams;
mod draw_tex;
mod draw_translucent;
mod export;
mod formats;
mod help;
mod in_browser;
#[cfg(unix)]
mod not_regular;
mod notes;
mod order;
mod output;
mod page;
mod paper;
mod pipes;
mod png_picture;
mod real_scenes;
mod render;
mod run;
mod samples;
mod saved;
mod stats;
mod svg_picture;
mod verify;

/// The program that [`run`] runs.
const PROGRAM: &str = env!("CARGO_BIN_EXE_binspace");
