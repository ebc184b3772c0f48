//! Tests of the evidence: methods, measures, shadows, portals.

mod accuracy;
mod antialias;
mod measures;
mod portals;
mod shadow_pieces;
mod shadows;
