//! What the evidence is made of, judged: methods, measures, shadows, portals.

mod accuracy;
mod antialias;
mod measures;
mod portals;
mod shadow_pieces;
mod shadows;
