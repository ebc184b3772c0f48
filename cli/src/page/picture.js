// The picture: fragments are filled pixel by pixel, one after the other, each over the earlier ones. If two
// fragments share an edge, a pixel belongs to the fragment that contains the pixel's centre. So there is no
// seam, unlike on a canvas that smooths the edges of each fragment.

/** The distance of the near plane from the eye, in units of the page. Nothing nearer is drawn. */
const NEAR = 1e-5;

/** The pixels of a picture, each in four bytes: red, green, blue, opacity. */
function pictureOf(width, height) {
  const image = new ImageData(width, height);
  return {
    width, height, image,
    pixels: new Uint32Array(image.data.buffer),
    lineWidth: 1,
    // For each row, the columns of the edge that crosses it downwards and of the edge that does so upwards.
    downwards: new Int32Array(height),
    upwards: new Int32Array(height),
  };
}

const packed = ([r, g, b]) => (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;

/** Directions to the right, up and forward of a camera, and the position of the camera's eye. */
function axesOf({ base: [a, b, up], yaw, pitch, target, distance }) {
  const across = [0, 1, 2].map(i => Math.cos(yaw) * a[i] + Math.sin(yaw) * b[i]);
  const right = [0, 1, 2].map(i => Math.sin(yaw) * a[i] - Math.cos(yaw) * b[i]);
  const forward = across.map((c, i) => Math.cos(pitch) * c + Math.sin(pitch) * up[i]);
  const upwards = across.map((c, i) => Math.cos(pitch) * up[i] - Math.sin(pitch) * c);
  const eye = target.map((c, i) => c - distance * forward[i]);
  return { right, up: upwards, forward, eye };
}

/** The camera's viewpoint, for orders. */
function viewpointOf(tree, camera) {
  const { eye, forward } = axesOf(camera);
  return camera.isParallel ? eyeTowards(forward) : eyeAt(tree, eye);
}

/** Pixels per unit of slope or, in a parallel view, per unit of length. */
function scaleOf(camera, { width, height }) {
  // A picture of any other shape shows everything that a 16:9 picture shows.
  const slope = camera.slope * Math.max(1, (16 / 9) * height / width);
  return height / 2 / (camera.isParallel ? slope * camera.distance : slope);
}

/**
 * All vertices as the camera sees them: `xs` and `ys` in pixels from the middle times the depth `zs`, which
 * is 1 in a parallel view; `columns` and `rows` in pixels; and by the bits of `outside` the sides of the
 * picture that the vertex is beyond.
 */
function project(tree, camera, { width, height }) {
  const { right, up, forward, eye } = axesOf(camera);
  const scale = scaleOf(camera, { width, height });
  const { vertices, xs, ys, zs, columns, rows, outside } = tree;
  const cx = width / 2, cy = height / 2;
  const [rx, ry, rz] = right.map(c => c * scale);
  const [ux, uy, uz] = up.map(c => -c * scale);
  const [fx, fy, fz] = camera.isParallel ? [0, 0, 0] : forward;
  const depth = camera.isParallel ? 1 : 0;
  const [ex, ey, ez] = eye;
  for (let i = 0; i < zs.length; i++) {
    const x = vertices[3 * i] - ex, y = vertices[3 * i + 1] - ey, z = vertices[3 * i + 2] - ez;
    const px = rx * x + ry * y + rz * z, py = ux * x + uy * y + uz * z;
    const pz = fx * x + fy * y + fz * z + depth;
    xs[i] = px;
    ys[i] = py;
    zs[i] = pz;
    columns[i] = cx + px / pz;
    rows[i] = cy + py / pz;
    const w = cx * pz, h = cy * pz;
    outside[i] = (px < -w) | ((px > w) << 1) | ((py < -h) << 2) | ((py > h) << 3) | ((pz < NEAR) << 4);
  }
}

/**
 * Brightness of planes: lit over the camera's left shoulder, so that walls, floor and back of a room differ,
 * and faintly from everywhere. All fragments in a plane are equally bright: cuts and triangles do not show.
 */
function shade({ nx, ny, nz, lengths, shades }, { right, up, forward }) {
  const [x, y, z] = forward.map((c, i) => 0.8 * c + 0.33 * right[i] - 0.5 * up[i]);
  for (let k = 0; k < shades.length; k++) {
    shades[k] = 0.55 + 0.45 * Math.abs(nx[k] * x + ny[k] * y + nz[k] * z) / lengths[k];
  }
}

/**
 * Paints the first `count` fragments, back to front. `style` has the colour of each fragment as three
 * numbers of `colours`, and whether colours are shaded; `opacities`; the background; the colours of lines
 * (`edges`, `cuts`, and of the `last` fragment), each drawn only if given; and whether backs are
 * left out. Returns the number of fragments filled.
 */
function paint(tree, camera, picture, style, count) {
  const order = backToFront(tree, viewpointOf(tree, camera));
  project(tree, camera, picture);
  shade(tree, axesOf(camera));
  picture.pixels.fill(packed(style.background));
  const lines = [style.edges, style.cuts].map(line => line && packed(line));
  const last = style.last && packed(style.last);
  let filled = 0;
  for (let i = 0; i < count; i++) {
    const fragment = order[i];
    const plane = tree.fragmentPlanes[fragment];
    if (style.cullsBacks && tree.distances[plane] <= 0) continue;
    const outline = outlineOf(tree, fragment, picture);
    if (!outline) continue;
    filled++;
    const share = style.isShaded ? tree.shades[plane] : 1;
    fill(picture, outline, colourOf(style.colours, fragment, share), style.opacities[fragment]);
    if (lines[0] || lines[1]) drawEdges(picture, outline, lines);
    if (last && i === count - 1) drawEdges(picture, outline, [last, last, last]);
  }
  return filled;
}

function colourOf(colours, fragment, share) {
  const i = 3 * fragment;
  const r = colours[i] * share + 0.5, g = colours[i + 1] * share + 0.5, b = colours[i + 2] * share + 0.5;
  return (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
}

// The outline that is being drawn: corners in pixels, and the kind of the edge from each corner to the next.
const OUTLINE = { x: [0.5], y: [0.5], kinds: [0], length: 0 };
const INNER = 2;

function addCorner(x, y, kind) {
  const i = OUTLINE.length++;
  OUTLINE.x[i] = x;
  OUTLINE.y[i] = y;
  OUTLINE.kinds[i] = kind;
}

/** The outline of a fragment in pixels, cut off near the eye; `null` if the fragment is out of view. */
function outlineOf(tree, fragment, picture) {
  const { columns, rows, outside, corners, edgeKinds } = tree;
  const first = tree.cornerStarts[fragment], end = tree.cornerStarts[fragment + 1];
  let all = 31, any = 0;
  for (let i = first; i < end; i++) {
    const sides = outside[corners[i]];
    all &= sides;
    any |= sides;
  }
  if (all) return null;
  OUTLINE.length = 0;
  if (any & 16) {
    clipNear(tree, picture, first, end);
    return OUTLINE.length < 3 ? null : OUTLINE;
  }
  for (let i = first; i < end; i++) addCorner(columns[corners[i]], rows[corners[i]], edgeKinds[i]);
  return OUTLINE;
}

/** Adds the part of an outline that is not too near to the eye. */
function clipNear({ xs, ys, zs, corners, edgeKinds }, { width, height }, first, end) {
  const add = (x, y, z, kind) => addCorner(width / 2 + x / z, height / 2 + y / z, kind);
  for (let i = first; i < end; i++) {
    const a = corners[i], b = corners[i + 1 < end ? i + 1 : first];
    const isNear = zs[a] < NEAR;
    if (!isNear) add(xs[a], ys[a], zs[a], edgeKinds[i]);
    if (isNear === zs[b] < NEAR) continue;
    const t = (NEAR - zs[a]) / (zs[b] - zs[a]);
    // The edge goes on from here, or along the near plane.
    const kind = isNear ? edgeKinds[i] : INNER;
    add(xs[a] + t * (xs[b] - xs[a]), ys[a] + t * (ys[b] - ys[a]), NEAR, kind);
  }
}

/** Fills a convex outline: the pixels whose centres are inside. */
function fill({ width, height, pixels, downwards, upwards }, { x, y, length }, colour, opacity) {
  let top = height, bottom = 0;
  for (let i = 0; i < length; i++) {
    const j = i + 1 < length ? i + 1 : 0;
    const isDown = y[i] < y[j];
    // Starts at the upper end, so that the two fragments beside an edge find the same pixels.
    const a = isDown ? i : j, b = isDown ? j : i;
    const ax = x[a], ay = y[a] - 0.5, by = y[b] - 0.5;
    const first = Math.max(0, Math.ceil(ay)), end = Math.min(height, Math.ceil(by));
    if (first >= end) continue;
    if (first < top) top = first;
    if (end > bottom) bottom = end;
    const ends = isDown ? downwards : upwards;
    const slope = (x[b] - ax) / (by - ay);
    for (let row = first; row < end; row++) {
      const at = Math.ceil(ax + (row - ay) * slope - 0.5);
      ends[row] = at < 0 ? 0 : at > width ? width : at;
    }
  }
  for (let row = top; row < bottom; row++) {
    const one = downwards[row], other = upwards[row];
    const from = row * width + (one < other ? one : other);
    const to = row * width + (one < other ? other : one);
    if (opacity < 1) blend(pixels, from, to, colour, opacity);
    else if (to - from > 24) pixels.fill(colour, from, to);
    else for (let i = from; i < to; i++) pixels[i] = colour;
  }
}

/** Mixes a colour into pixels. */
function blend(pixels, from, to, colour, opacity) {
  const r = colour & 255, g = (colour >> 8) & 255, b = (colour >> 16) & 255;
  const mixed = (old, channel) => (old + (channel - old) * opacity + 0.5) | 0;
  for (let i = from; i < to; i++) {
    const below = pixels[i];
    const red = mixed(below & 255, r);
    const green = mixed((below >> 8) & 255, g);
    const blue = mixed((below >> 16) & 255, b);
    pixels[i] = (0xff000000 | (blue << 16) | (green << 8) | red) >>> 0;
  }
}

/** Draws the edges of the kinds that have a colour. */
function drawEdges(picture, { x, y, kinds, length }, colours) {
  for (let i = 0; i < length; i++) {
    const colour = colours[kinds[i]];
    if (!colour) continue;
    const j = i + 1 < length ? i + 1 : 0;
    drawLine(picture, x[i], y[i], x[j], y[j], colour);
  }
}

/** Draws a line, one pixel wide, or wider in a picture that is reduced afterwards. */
function drawLine({ width, height, pixels, lineWidth }, ax, ay, bx, by, colour) {
  const isSteep = Math.abs(by - ay) > Math.abs(bx - ax);
  // A pixel in each step of the longer way, whose ends are m, with the other coordinate n.
  const isReversed = isSteep ? by < ay : bx < ax;
  const fromX = isReversed ? bx : ax, fromY = isReversed ? by : ay;
  const toX = isReversed ? ax : bx, toY = isReversed ? ay : by;
  const begin = isSteep ? fromY : fromX, end = isSteep ? toY : toX;
  const at = isSteep ? fromX : fromY;
  const slope = end > begin ? ((isSteep ? toX : toY) - at) / (end - begin) : 0;
  const across = isSteep ? width : height;
  const alongStep = isSteep ? width : 1, acrossStep = isSteep ? 1 : width;
  const first = Math.max(0, Math.floor(begin));
  const last = Math.min((isSteep ? height : width) - 1, Math.floor(end));
  let place = at + (first + 0.5 - begin) * slope - lineWidth / 2 + 0.5;
  for (let m = first; m <= last; m++, place += slope) {
    const low = Math.floor(place);
    for (let n = low; n < low + lineWidth; n++) {
      if (n >= 0 && n < across) pixels[m * alongStep + n * acrossStep] = colour;
    }
  }
}
