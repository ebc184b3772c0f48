//! Public types are `Send` and `Sync`: above all trees, with everything that they return.

use binspace::choose::{PieceSet, SplitPlane};
use binspace::drawing::{Paint, Path, Region, Stroke, VectorPicture};
use binspace::internals::{
    EdgeLine, Eye, Lattice, PlaneKind, PreparedPlane, Side, StoredVertex, Vertex, VertexId,
    VertexKind,
};
use binspace::layers::{Layer, LayerPiece, LayerVertex, Layers};
use binspace::mesh::{FragmentArrays, Mesh, Triangles};
use binspace::occlusion::CoverageMask;
use binspace::overlay::{Marker, Overlaid, Overlay, OverlayOrder, Segment, Shape};
use binspace::raster::{Comparison, DepthImage, Image};
use binspace::scene::{Material, ObjReport};
use binspace::verify::Verification;
use binspace::view::Projection;
use binspace::{
    Child, Culling, Error, Fragment, Frustum, Grid, Hit, Location, Node, Order, Ordered, Part,
    Preparation, Progress, Ray, Stats,
};
use testkit::prelude::*;

/// Compiles only if the types are `Send` and `Sync`. A type that contains a cell or a raw pointer is not.
macro_rules! assert_shared {
    ($($type:ty),* $(,)?) => {
        const _: () = {
            const fn is_shared<T: Send + Sync>() {}
            $(is_shared::<$type>();)*
        };
    };
}

// Trees, and the types that they return; building, and errors.
assert_shared!(Layer, LayerPiece<'_>, LayerVertex, Layers, FrameBuilder);
assert_shared!(Child<'_>, CoverageMask<'_>, Culling, Frustum, Order<'_>, Part<'_>);
assert_shared!(
    FragmentArrays<f32>,
    BspTree,
    Fragment<'_>,
    Ordered<'_>,
    Mesh,
    Node<'_>,
    Stats,
    Triangles,
    Viewpoint
);
assert_shared!(Overlay, Overlaid<'_>, OverlayOrder<'_>, Shape<'_>, Segment<'_>, Marker);
assert_shared!(Grid, Hit<'_>, Location<'_>, Ray);
assert_shared!(PieceSet<'_>, SplitPlane);
assert_shared!(BuildOptions, Heuristic, Progress, Error);
// Iterators without a nameable type.
#[expect(dead_code, reason = "compiling it is the test")]
fn iterators_are_shared(tree: &BspTree) {
    const fn is_shared(_: &(impl Send + Sync)) {}
    is_shared(&tree.fragments());
    is_shared(&tree.nodes());
    is_shared(&tree.hits(Ray::new([0.0; 3], [1.0; 3])));
    is_shared(&tree.fragments_in(&Frustum::EVERYWHERE));
}
// Geometry.
assert_shared!(Faces, Preparation, Lattice, PreparedPlane, StoredVertex, Vertex, Eye, EdgeLine);
assert_shared!(PlaneId, PlaneKind, Side, VertexId, VertexKind);
// Scenes, cameras, pictures.
assert_shared!(Scene, Material, Builtin, Camera, Projection, Image, DepthImage, Comparison);
assert_shared!(Verification, ObjReport);
assert_shared!(
    VisibilityMap<'_>,
    ViewOptions<'_>,
    Drawing,
    Path<'_>,
    Region,
    VectorPicture,
    Paint,
    Stroke
);

#[test]
fn a_tree_is_ordered_by_several_threads_at_once() {
    let tree = BspTree::build(binspace::scene::random_triangles(200, 1).polygons()).unwrap();
    let order = || {
        let mut order = Vec::new();
        tree.back_to_front_into(Viewpoint::eye([3.0, 1.0, 2.0]), &mut order);
        order
    };
    let expected = order();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(order)).collect();
        assert!(threads.into_iter().all(|thread| thread.join().unwrap() == expected));
    });
}
