//! Visibility maps and drawings, against pictures whose every pixel is decided by integers of another
//! hand, and against rays.

mod areas;
mod bent;
mod between;
mod borders;
mod coincidences;
mod crossings;
mod extremes;
mod grid_crossings;
mod hidden;
mod hidden_crossings;
mod in_front;
mod lines;
mod meetings;
mod mixed;
mod overlay;
mod pen;
mod progress;
mod same;
mod scenes;
mod seams;
mod sheets;
mod sightlines;
mod silhouettes;
mod translucent;
