//! The checks of the fuzz targets on their bytes. The library's tests replay crash inputs with the same code.

/// Cuts a face of a scene repeatedly, and compares the parts with exact rationals.
pub fn split(data: &[u8]) {
    testkit::targets::split::run(data);
}

/// Builds a tree and judges it; rays judge its orders.
pub fn tree(data: &[u8]) {
    testkit::targets::tree::run(data);
}

/// Builds a scene as cells and judges all cells together, or reads partitions, either forged or with any
/// bytes.
pub fn cells(data: &[u8]) {
    testkit::targets::cells::run(data);
}

/// Reads an OBJ file whose content is known, or any bytes.
pub fn obj(data: &[u8]) {
    testkit::targets::obj::run(data);
}

/// Builds trees of some hundred or thousand faces, with budgets, with cancellation, and by several threads.
pub fn large(data: &[u8]) {
    testkit::targets::large::run(data);
}

/// Reads files of trees, either forged or with any bytes, and uses the result.
pub fn saved(data: &[u8]) {
    testkit::targets::saved::run(data);
}

/// Prepares polygons of up to some thousand corners.
pub fn faces(data: &[u8]) {
    testkit::targets::faces::run(data);
}

/// Finds hits of rays and positions of points, and compares them with exact rationals.
pub fn query(data: &[u8]) {
    testkit::targets::query::run(data);
}

/// Draws views of small scenes, and compares them with the tree's pictures.
pub fn drawing(data: &[u8]) {
    testkit::targets::drawing::run(data);
}
