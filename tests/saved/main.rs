//! Trees and scenes that are written and read back, and files that are not right.

#[path = "../support/mod.rs"]
mod support;

mod damage;
mod forged;
mod refused;
mod same;
mod scenes;
mod threads;
mod values;
