mod int;
mod lattice;
pub use int::Int;
pub use lattice::Lattice;
