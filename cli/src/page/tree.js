"use strict";
// The tree: the arrays of the page, and the order in which fragments are painted. All decisions equal the
// library's, bit for bit: planes go through three points of the tree's grid, eyes are rounded to that grid,
// and integers decide where floats cannot.

const ARRAYS = {
  u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, f32: Float32Array, f64: Float64Array,
};

/** An array of the page: little-endian, as every processor is that runs a browser. */
function unpacked({ kind, bytes, base64 }) {
  const numbers = new ARRAYS[kind](bytes / ARRAYS[kind].BYTES_PER_ELEMENT);
  const text = atob(base64);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < packed.length; i++) packed[i] = text.charCodeAt(i);
  const planes = inflated(packed, bytes);
  // The first bytes of all numbers come first.
  const places = new Uint8Array(numbers.buffer);
  for (let place = 0, from = 0; from < bytes; place++) {
    for (let i = place; i < bytes; i += numbers.BYTES_PER_ELEMENT) places[i] = planes[from++];
  }
  return numbers;
}

/** The beginning of each run in a list of runs, given the lengths of runs; and the end of the last run. */
function starts(lengths) {
  const sums = new Uint32Array(lengths.length + 1);
  for (let i = 0; i < lengths.length; i++) sums[i + 1] = sums[i] + lengths[i];
  return sums;
}

/** The tree of a page, from the page's data. */
function treeOf(data) {
  const arrays = Object.fromEntries(
    Object.entries(data.arrays).map(([name, array]) => [name, unpacked(array)]));
  const { steps, nodePlaneCount } = data;
  const tree = { ...arrays, steps, nodePlaneCount, cornerStarts: starts(arrays.cornerCounts) };
  tree.polygons = Uint32Array.from(arrays.fragmentFaces, face => arrays.faces[2 * face]);
  tree.fragmentPlanes = Uint32Array.from(arrays.fragmentFaces, face => arrays.faces[2 * face + 1]);
  // Corners are counted back from the first vertex that no earlier corner has.
  let vertices = 0;
  tree.corners = Uint32Array.from(arrays.corners, back => (back ? vertices - back : vertices++));
  tree.fragments = arrays.cornerCounts.length;
  tree.nodes = arrays.nodePlanes.length;
  addPlanes(tree);
  addSizes(tree);
  addRoom(tree);
  return tree;
}

/** Three points of the grid on a plane, counter-clockwise seen from the plane's front. */
function pointsOf({ points, planePoints }, plane) {
  const [p, q, r] = planePoints.subarray(3 * plane, 3 * plane + 3);
  const point = i => points.subarray(3 * i, 3 * i + 3);
  if (p !== q) return [point(p), point(q), point(r)];
  // Perpendicular to axis r.
  const next = axis => point(p).map((c, i) => (i === axis % 3 ? c + 1 : c));
  return [point(p), next(r + 1), next(r + 2)];
}

/**
 * The planes in floats: a normal, the normal's length, the product of the normal and a point on the plane,
 * and the error bound of the eye's distance, which is `bounds` times the eye's largest coordinate plus
 * `offsetBounds`.
 *
 * With u = 2^-53: coordinates and their differences are exact. A component of the normal is off by 2u of
 * its two products |a| + |b|. Products with a point, and sums, are off by 4u more: 6u of (|a| + |b|) times
 * the coordinate, summed over the axes. The bound uses 10u.
 */
function addPlanes(tree) {
  const count = tree.planePoints.length / 3;
  const columns = ["nx", "ny", "nz", "lengths", "offsets", "bounds", "offsetBounds"];
  for (const name of columns) tree[name] = new Float64Array(count);
  tree.exactPlanes = new Array(count);
  tree.planes = count;
  const normal = [0, 0, 0];
  for (let k = 0; k < count; k++) {
    const [p, q, r] = pointsOf(tree, k);
    for (let i = 0; i < 3; i++) {
      const j = (i + 1) % 3, l = (i + 2) % 3;
      const a = (q[j] - p[j]) * (r[l] - p[l]), b = (q[l] - p[l]) * (r[j] - p[j]);
      const bound = 5 * Number.EPSILON * (Math.abs(a) + Math.abs(b));
      normal[i] = a - b;
      tree.offsets[k] += normal[i] * p[i];
      tree.bounds[k] += bound;
      tree.offsetBounds[k] += bound * Math.abs(p[i]);
    }
    [tree.nx[k], tree.ny[k], tree.nz[k]] = normal;
    tree.lengths[k] = Math.hypot(...normal);
  }
}

/** The size of each subtree, the subtree's place in an order, and the depth of each fragment's node. */
function addSizes(tree) {
  const { nodes, own, frontLeaf, backLeaf, frontNode, backNode } = tree;
  tree.inFront = new Uint32Array(nodes);
  tree.behind = new Uint32Array(nodes);
  tree.begins = new Uint32Array(nodes);
  tree.firsts = new Uint32Array(nodes);
  tree.depths = new Uint32Array(tree.fragments);
  const all = i => tree.inFront[i] + own[i] + tree.behind[i];
  // Nodes are stored depth first: children come after parents.
  for (let i = nodes - 1; i >= 0; i--) {
    tree.inFront[i] = frontNode[i] ? all(frontNode[i]) : frontLeaf[i];
    tree.behind[i] = backNode[i] ? all(backNode[i]) : backLeaf[i];
  }
  const depths = new Uint32Array(nodes).fill(1);
  for (let i = 0, first = 0; i < nodes; i++) {
    tree.firsts[i] = first;
    const end = first + own[i] + frontLeaf[i] + backLeaf[i];
    tree.depths.fill(depths[i], first, end);
    first = end;
    for (const child of [frontNode[i], backNode[i]]) if (child) depths[child] = depths[i] + 1;
  }
  tree.depth = tree.depths.reduce((most, depth) => Math.max(most, depth), 1);
  tree.order = Uint32Array.from({ length: tree.fragments }, (_, i) => i);
}

/** Allocates the results for one eye: for each plane, and for each projected vertex. */
function addRoom(tree) {
  tree.signs = new Uint8Array(tree.planes);
  for (const name of ["distances", "shades"]) tree[name] = new Float64Array(tree.planes);
  const count = tree.vertices.length / 3;
  tree.outside = new Uint8Array(count);
  for (const name of ["xs", "ys", "zs", "columns", "rows"]) tree[name] = new Float64Array(count);
}

/** The nearest integer; of two nearest integers, the integer further from 0. */
function rounded(x) {
  const whole = Math.trunc(x);
  return Math.abs(x - whole) < 0.5 ? whole : whole + Math.sign(x);
}

/** An eye at a point, in units of the page, on the grid. The point may be up to 512 units away. */
function eyeAt(tree, point) {
  return { at: point.map(c => rounded(c * tree.steps)), w: 1 };
}

/** An eye infinitely far away, which looks in a direction. */
function eyeTowards(direction) {
  let scale = 1;
  const largest = Math.max(...direction.map(Math.abs));
  while (largest * scale < 2 ** 52) scale *= 2;
  while (largest * scale >= 2 ** 53) scale /= 2;
  return { at: direction.map(c => rounded(-c * scale)), w: 0 };
}

/**
 * Sets `distances`: for each plane the rounded distance of the eye, times the length of the plane's normal.
 * Sets `signs`: for each plane of a node whether the eye is in front, exactly.
 */
function compare(tree, { at, w }) {
  const { nx, ny, nz, offsets, bounds, offsetBounds, distances, signs } = tree;
  const [x, y, z] = at;
  const largest = Math.max(Math.abs(x), Math.abs(y), Math.abs(z));
  const integers = at.map(BigInt);
  for (let k = 0; k < tree.planes; k++) {
    const distance = nx[k] * x + ny[k] * y + nz[k] * z - w * offsets[k];
    distances[k] = distance;
    const isSure = Math.abs(distance) > bounds[k] * largest + w * offsetBounds[k];
    // Planes that belong only to fragments come after the planes of nodes, and decide no order.
    if (isSure || k >= tree.nodePlaneCount) signs[k] = distance > 0;
    else signs[k] = isInFront(tree, k, integers, w);
  }
}

/**
 * Whether the eye is in front of a plane, by integers. An eye on the plane counts as behind. For an eye at
 * infinity along the plane, the side of the grid's middle counts. The library has the same rule.
 */
function isInFront(tree, plane, [x, y, z], w) {
  const { n, offset } = (tree.exactPlanes[plane] ??= exactPlane(tree, plane));
  const along = n[0] * x + n[1] * y + n[2] * z;
  if (w) return along > offset;
  return along !== 0n ? along > 0n : offset < 0n;
}

function exactPlane(tree, plane) {
  const [p, q, r] = pointsOf(tree, plane).map(point => Array.from(point, BigInt));
  const n = [0, 1, 2].map(i => {
    const j = (i + 1) % 3, k = (i + 2) % 3;
    return (q[j] - p[j]) * (r[k] - p[k]) - (q[k] - p[k]) * (r[j] - p[j]);
  });
  return { n, offset: n[0] * p[0] + n[1] * p[1] + n[2] * p[2] };
}

/**
 * The fragments, back to front, in `tree.order`: no recursion and no stack. The sizes of subtrees are known,
 * so the places of a node's two sides in the order are known before these sides are walked.
 */
function backToFront(tree, eye) {
  compare(tree, eye);
  const { own, frontLeaf, backLeaf, frontNode, backNode, inFront, behind } = tree;
  const { begins, firsts, nodePlanes, signs, order } = tree;
  const put = (place, first, count) => {
    for (let i = 0; i < count; i++) order[place + i] = first + i;
  };
  for (let i = 0; i < tree.nodes; i++) {
    const isFront = signs[nodePlanes[i]];
    const begin = begins[i], first = firsts[i];
    const middle = begin + (isFront ? behind[i] : inFront[i]);
    const front = isFront ? middle + own[i] : begin;
    const back = isFront ? begin : middle + own[i];
    put(middle, first, own[i]);
    if (frontNode[i]) begins[frontNode[i]] = front;
    else put(front, first + own[i], frontLeaf[i]);
    if (backNode[i]) begins[backNode[i]] = back;
    else put(back, first + own[i] + frontLeaf[i], backLeaf[i]);
  }
  return order;
}
