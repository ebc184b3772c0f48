//! Scenes built as several cells, held against rays, areas and trees of the whole.

mod borders;
mod cover;
mod order;
mod partition;
mod polygons;
mod saved;
