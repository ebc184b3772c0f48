//! Scenes built as several cells, compared with rays, areas and trees of the whole.

mod borders;
mod cover;
mod forged;
mod order;
mod partition;
mod polygons;
mod samples;
mod saved;
