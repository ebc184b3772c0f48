//! The oracles and decoders of the library's own tests.

#[path = "../../../tests/support/decode.rs"]
pub(crate) mod decode;
#[path = "../../../tests/support/dice.rs"]
pub(crate) mod dice;
#[path = "../../../tests/support/homogeneous.rs"]
pub(crate) mod homogeneous;
#[path = "../../../tests/support/judge.rs"]
pub(crate) mod judge;
#[path = "../../../tests/support/model.rs"]
pub(crate) mod model;
#[path = "../../../tests/support/orders.rs"]
pub(crate) mod orders;
#[path = "../../../tests/support/rational.rs"]
pub(crate) mod rational;
#[path = "../../../tests/support/rays.rs"]
pub(crate) mod rays;
#[path = "../../../tests/support/saved.rs"]
pub(crate) mod saved;
#[path = "../../../tests/support/snapshot.rs"]
pub(crate) mod snapshot;
#[path = "../../../tests/support/targets/mod.rs"]
pub(crate) mod targets;
#[path = "../../../tests/support/views.rs"]
pub(crate) mod views;
