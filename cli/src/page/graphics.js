"use strict";
// The pictures of picture.js, drawn by a graphics card (WebGL 2): triangles and lines in the order of the
// tree, each painted over the earlier ones, without a depth buffer. Without such a card, picture.js paints.

/** The card's vertices for a corner: one for the fragment, and four for the line to the next corner. */
const ROLES = 5;
/** The number of texels in a row of a texture. */
const ROW = 2048;

const VERTEX_SHADER = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
uniform sampler2D vertices, opacities;
uniform usampler2D colours;
// A vertex, the next vertex, the fragment, and the kind of the edge between the two vertices.
uniform usampler2D corners;
uniform vec3 right, up, forward, eye;
uniform float depth, lineWidth;
uniform vec2 middle;
uniform vec3 lines[3];
flat out vec4 colour;

ivec2 at(uint i) { return ivec2(i % ${ROW}u, i / ${ROW}u); }

// The position in pixels from the middle, times the depth; and the depth.
vec3 seen(uint vertex) {
  vec3 p = texelFetch(vertices, at(vertex), 0).xyz - eye;
  return vec3(dot(right, p), dot(up, p), dot(forward, p) + depth);
}

// An end of a line in pixels from the middle, cut off near the eye.
vec2 end(vec3 p, vec3 other) {
  vec3 visible = p.z < ${NEAR} ? mix(p, other, (${NEAR} - p.z) / (other.z - p.z)) : p;
  return visible.xy / visible.z;
}

void main() {
  uint role = uint(gl_VertexID) % ${ROLES}u;
  uvec4 corner = texelFetch(corners, at(uint(gl_VertexID) / ${ROLES}u), 0);
  vec3 a = seen(corner.x);
  if (role == 0u) {
    vec3 own = vec3(texelFetch(colours, at(corner.z), 0).xyz);
    colour = vec4(own / 255.0, texelFetch(opacities, at(corner.z), 0).x);
    gl_Position = vec4(a.xy / middle, 0.0, a.z);
    return;
  }
  colour = vec4(lines[corner.w] / 255.0, 1.0);
  vec3 b = seen(corner.y);
  if (a.z < ${NEAR} && b.z < ${NEAR}) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  vec2 from = end(a, b), to = end(b, a);
  // The width of a steep line is measured along rows of pixels, the width of other lines along columns.
  vec2 way = abs(to - from);
  vec2 side = 0.5 * lineWidth * (way.y > way.x ? vec2(1, 0) : vec2(0, 1));
  vec2 place = (role < 3u ? from : to) + (role % 2u == 0u ? side : -side);
  gl_Position = vec4(place / middle, 0.0, 1.0);
}`;

const PIXEL_SHADER = `#version 300 es
precision highp float;
flat in vec4 colour;
out vec4 pixel;
void main() { pixel = colour; }`;

/** A painter of a tree; `null` if the browser has no fast WebGL 2, or the tree is too large for WebGL 2. */
function graphicsOf(tree, isFast = true) {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false });
  if (!gl || isFast && isSlow(gl)) return null;
  const count = tree.corners.length;
  // No texture has more texels than corners.
  if (count > ROW * gl.getParameter(gl.MAX_TEXTURE_SIZE)) return null;
  const program = programOf(gl);
  if (!program) return null;
  const places = Object.fromEntries([
    "vertices", "opacities", "colours", "corners",
    "right", "up", "forward", "eye", "depth", "lineWidth", "middle", "lines",
  ].map(name => [name, gl.getUniformLocation(program, name)]));
  const textures = ["vertices", "opacities", "colours", "corners"];
  textures.forEach((name, unit) => gl.uniform1i(places[name], unit));
  const fill = (name, ...kind) => fillTexture(gl, textures.indexOf(name), ...kind);
  fill("vertices", gl.RGB32F, gl.RGB, gl.FLOAT, 3, inRows(tree.vertices, 3));
  fill("corners", gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, 4, inRows(cornersOf(tree), 4));
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  const colours = inRows(new Uint32Array(tree.fragments), 1);
  let opacities = null;
  const indices = new Uint32Array((3 + 6) * count);

  const drawElements = (end, lines) => {
    gl.uniform3fv(places.lines, lines.flatMap(line => line ?? [0, 0, 0]));
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices.subarray(0, end), gl.STREAM_DRAW);
    gl.drawElements(gl.TRIANGLES, end, gl.UNSIGNED_INT, 0);
  };

  /** Paints like `paint`. Fragments out of view count as filled. */
  const paint = (camera, { width, height, lineWidth }, style, count) => {
    const order = backToFront(tree, viewpointOf(tree, camera));
    const axes = axesOf(camera), scale = scaleOf(camera, { width, height });
    shade(tree, axes);
    [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(...style.background.map(c => c / 255), 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.uniform3fv(places.right, axes.right.map(c => c * scale));
    gl.uniform3fv(places.up, axes.up.map(c => c * scale));
    gl.uniform3fv(places.forward, camera.isParallel ? [0, 0, 0] : axes.forward);
    gl.uniform3fv(places.eye, axes.eye);
    gl.uniform1f(places.depth, camera.isParallel ? 1 : 0);
    gl.uniform1f(places.lineWidth, lineWidth);
    gl.uniform2f(places.middle, width / 2, height / 2);
    const lines = [style.edges, style.cuts, null];
    let filled = 0, end = 0;
    for (let i = 0; i < count; i++) {
      const fragment = order[i], plane = tree.fragmentPlanes[fragment];
      if (style.cullsBacks && tree.distances[plane] <= 0) continue;
      filled++;
      colours[fragment] = colourOf(style.colours, fragment, style.isShaded ? tree.shades[plane] : 1);
      end = addTriangles(tree, fragment, indices, end);
      if (lines[0] || lines[1]) end = addLines(tree, fragment, lines, indices, end);
    }
    const bytes = new Uint8Array(colours.buffer);
    fill("colours", gl.RGBA8UI, gl.RGBA_INTEGER, gl.UNSIGNED_BYTE, 4, bytes);
    if (opacities !== style.opacities) {
      opacities = style.opacities;
      fill("opacities", gl.R32F, gl.RED, gl.FLOAT, 1, inRows(Float32Array.from(opacities), 1));
    }
    drawElements(end, lines);
    const last = order[count - 1];
    if (style.last && !(style.cullsBacks && tree.distances[tree.fragmentPlanes[last]] <= 0)) {
      const all = [style.last, style.last, style.last];
      drawElements(addLines(tree, last, all, indices, 0), all);
    }
    return filled;
  };
  return { canvas, paint, isLost: () => gl.isContextLost() };
}

/** Whether the processor does the work of a card: then WebGL takes longer than picture.js. */
function isSlow(gl) {
  const unmasked = gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL;
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(gl.getParameter(unmasked ?? gl.RENDERER));
}

/** The two shaders; `null` if the card's driver refuses them. */
function programOf(gl) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX_SHADER], [gl.FRAGMENT_SHADER, PIXEL_SHADER]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
  gl.useProgram(program);
  return program;
}

/** Numbers, some for each texel, in whole rows of texels. */
function inRows(numbers, channels) {
  const row = ROW * channels;
  const rows = new numbers.constructor(row * Math.ceil(numbers.length / row));
  rows.set(numbers);
  return rows;
}

/** Fills a texture unit with rows of texels. */
function fillTexture(gl, unit, inner, format, type, channels, numbers) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  if (!gl.getParameter(gl.TEXTURE_BINDING_2D)) gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
    gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
  }
  gl.texImage2D(gl.TEXTURE_2D, 0, inner, ROW, numbers.length / channels / ROW, 0, format, type, numbers);
}

/** The shader's data of all corners. */
function cornersOf({ corners, cornerStarts, edgeKinds, fragments }) {
  const all = new Uint32Array(4 * corners.length);
  for (let fragment = 0; fragment < fragments; fragment++) {
    const first = cornerStarts[fragment], end = cornerStarts[fragment + 1];
    for (let i = first; i < end; i++) {
      all.set([corners[i], corners[i + 1 < end ? i + 1 : first], fragment, edgeKinds[i]], 4 * i);
    }
  }
  return all;
}

/** Adds the triangles of a fragment, a fan, and returns the end of the added triangles. */
function addTriangles({ cornerStarts }, fragment, indices, end) {
  const first = cornerStarts[fragment], last = cornerStarts[fragment + 1] - 1;
  for (let i = first + 1; i < last; i++) {
    indices[end++] = ROLES * first;
    indices[end++] = ROLES * i;
    indices[end++] = ROLES * (i + 1);
  }
  return end;
}

/** Adds the lines along a fragment's edges of the kinds that have a colour, two triangles each. */
function addLines({ cornerStarts, edgeKinds }, fragment, lines, indices, end) {
  for (let i = cornerStarts[fragment]; i < cornerStarts[fragment + 1]; i++) {
    if (!lines[edgeKinds[i]]) continue;
    for (const role of [1, 2, 3, 2, 3, 4]) indices[end++] = ROLES * i + role;
  }
  return end;
}
