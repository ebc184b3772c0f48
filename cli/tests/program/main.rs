//! The program as its users run it: the real binary, its files, its exit status.

mod bad_input;
mod help;
mod order;
mod output;
mod png_picture;
mod real_scenes;
mod render;
mod report;
mod run;
mod stats;
mod tour;
mod verify;
