//! Trees and scenes that are written and read back, and files that are not right.

mod damage;
mod forged;
mod refused;
mod same;
mod scenes;
mod threads;
mod values;
