// The controls of the page: they turn, move and zoom the view, and choose what is painted.

const DATA = JSON.parse(document.getElementById("data").textContent);
const TREE = treeOf(DATA);
const $ = id => document.getElementById(id);
const CANVAS = $("picture");
/** The angle of a key press, in radians; the zoom factor of a key press or of a notch of the wheel. */
const [TURN, ZOOM] = [Math.PI / 36, 1.12];
/** The time from the last change to a picture with smooth edges, in milliseconds. */
const REST = 150;
/** Pictures of more pixels are not drawn with smooth edges, which take four times as many pixels. */
const MOST_SMOOTH = 4e6;
/** The time to play the whole order, in milliseconds. */
const PLAY = 8000;

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const cross = (a, b) => [0, 1, 2].map(i => {
  const j = (i + 1) % 3, k = (i + 2) % 3;
  return a[j] * b[k] - a[k] * b[j];
});
const unit = a => a.map(c => c / Math.hypot(...a));

/** The camera with which the page begins. */
function firstCamera({ forward, right, up, target, distance, slope }) {
  const level = unit(cross(up, right));
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return {
    base: [level, cross(up, level), up],
    yaw: 0,
    pitch: Math.atan2(dot(forward, up), dot(forward, level)),
    target, distance, slope,
    isParallel: false,
  };
}

let camera = firstCamera(DATA.view);
const style = {
  isShaded: true,
  opacities: Float64Array.from({ length: TREE.fragments }, (_, i) => materialOf(i).opacity),
};
let coarse = null, fine = null;
let graphics = graphicsOf(TREE);
const state = { count: TREE.fragments, isPlaying: false, isDirty: false, restTimer: 0, filled: 0 };

/** A colour of the style sheet. */
function named(name) {
  const sheet = getComputedStyle(document.documentElement);
  return sheet.getPropertyValue(name).trim().split(" ").map(Number);
}

/** Reads the settings of the controls. */
function readControls() {
  style.background = named("--paper");
  style.edges = $("edges").checked ? named("--edge") : null;
  style.cuts = $("cuts").checked ? named("--cut") : null;
  style.cullsBacks = $("culling").checked;
  camera.isParallel = $("parallel").checked;
  colour();
  showLegend();
  readPlace();
}

/** Reads how many fragments of the order are painted. */
function readPlace() {
  state.count = Number($("place").value);
  style.last = state.count < TREE.fragments ? named("--cut") : null;
  change();
}

// Drawing.

/** Draws one picture, with `fineness` x `fineness` pixels for each pixel of the page. */
function draw(fineness) {
  const { clientWidth, clientHeight } = CANVAS;
  const size = [clientWidth, clientHeight].map(side => Math.max(1, side * fineness));
  if ($("colours").value === "facing") {
    compare(TREE, viewpointOf(TREE, camera));
    colour();
  }
  if (graphics) {
    const picture = { width: size[0], height: size[1], lineWidth: fineness };
    state.filled = graphics.paint(camera, picture, style, state.count);
    // A card may be taken away.
    if (graphics.isLost()) graphics = null;
    else {
      CANVAS.getContext("2d", { alpha: false }).drawImage(graphics.canvas, 0, 0, CANVAS.width, CANVAS.height);
      return;
    }
  }
  const isOf = picture => picture?.width === size[0] && picture.height === size[1];
  let picture = fineness > 1 ? fine : coarse;
  if (!isOf(picture)) picture = { ...pictureOf(...size), lineWidth: fineness };
  if (fineness > 1) fine = picture;
  else coarse = picture;
  state.filled = paint(TREE, camera, picture, style, state.count);
  show(picture);
}

/** Puts a picture on the canvas, scaled to the size of the canvas. */
function show(picture) {
  const context = CANVAS.getContext("2d", { alpha: false });
  if (picture.width === CANVAS.width && picture.height === CANVAS.height) {
    context.putImageData(picture.image, 0, 0);
    return;
  }
  picture.canvas ??= Object.assign(
    document.createElement("canvas"), { width: picture.width, height: picture.height });
  picture.canvas.getContext("2d", { alpha: false }).putImageData(picture.image, 0, 0);
  context.drawImage(picture.canvas, 0, 0, CANVAS.width, CANVAS.height);
}

/** Draws a picture soon, and a smooth picture when nothing has changed for a while. */
function change() {
  smoothSoon();
  if (state.isDirty) return;
  state.isDirty = true;
  requestAnimationFrame(() => {
    state.isDirty = false;
    draw(1);
  });
}

/** Draws a smooth picture when nothing has changed for a while. */
function smoothSoon() {
  clearTimeout(state.restTimer);
  state.restTimer = setTimeout(() => {
    draw(CANVAS.clientWidth * CANVAS.clientHeight < MOST_SMOOTH ? 2 : 1);
    describe();
  }, REST);
}

/** Writes a text that says what is painted. */
function describe() {
  const last = TREE.order[state.count - 1];
  const parts = [`${state.count} of ${TREE.fragments} fragments`];
  if (state.count > 0 && state.count < TREE.fragments) {
    parts.push(`polygon ${TREE.polygons[last]}, depth ${TREE.depths[last]}`);
  }
  if (state.filled < state.count) parts.push(`${state.filled} drawn`);
  $("painted").textContent = parts.join(" · ");
}

function resize() {
  const ratio = window.devicePixelRatio || 1;
  CANVAS.width = Math.max(1, Math.round(CANVAS.clientWidth * ratio));
  CANVAS.height = Math.max(1, Math.round(CANVAS.clientHeight * ratio));
  // A new size empties the canvas, and the canvas is shown before the next chance to draw.
  draw(1);
  smoothSoon();
}

// Moving.

/** Turns the near side to the right and down, by angles. */
function turn(right, down) {
  camera.yaw -= right;
  camera.pitch = clamp(camera.pitch - down, -Math.PI / 2, Math.PI / 2);
  change();
}

/** Moves the view by a number of pixels: the point at the target follows the pointer. */
function pan(x, y) {
  const { right, up } = axesOf(camera);
  const scale = scaleOf(camera, { width: CANVAS.clientWidth, height: CANVAS.clientHeight });
  const step = camera.isParallel ? 1 / scale : camera.distance / scale;
  camera.target = camera.target.map((c, i) => clamp(c - step * (x * right[i] - y * up[i]), -8, 8));
  change();
}

/** Moves the eye nearer by a factor, or further away. Very near, the target moves ahead of the eye. */
function zoom(factor) {
  const least = DATA.view.distance / 50;
  const distance = camera.distance / factor;
  if (distance < least && !camera.isParallel) {
    const { forward } = axesOf(camera);
    camera.target = camera.target.map((c, i) => clamp(c + (least - distance) * forward[i], -8, 8));
  }
  camera.distance = clamp(distance, camera.isParallel ? 1e-6 : least, 100);
  change();
}

function reset() {
  camera = { ...firstCamera(DATA.view), isParallel: camera.isParallel };
  change();
}

// The paint order, played.

function setPlaying(isPlaying) {
  state.isPlaying = isPlaying;
  $("play").textContent = isPlaying ? "Pause" : "Play";
  // Nobody wants to hear every step.
  $("painted").ariaLive = isPlaying ? "off" : "polite";
  if (!isPlaying) return;
  let begin = null;
  const first = state.count < TREE.fragments ? state.count : 0;
  requestAnimationFrame(function step(time) {
    if (!state.isPlaying) return;
    begin ??= time;
    const count = Math.min(TREE.fragments, first + Math.ceil(TREE.fragments * (time - begin) / PLAY));
    $("place").value = count;
    readPlace();
    describe();
    if (count < TREE.fragments) requestAnimationFrame(step);
    else setPlaying(false);
  });
}

const KEYS = {
  ArrowLeft: shift => (shift ? pan(40, 0) : turn(-TURN, 0)),
  ArrowRight: shift => (shift ? pan(-40, 0) : turn(TURN, 0)),
  ArrowUp: shift => (shift ? pan(0, 40) : turn(0, -TURN)),
  ArrowDown: shift => (shift ? pan(0, -40) : turn(0, TURN)),
  "+": () => zoom(ZOOM),
  "=": () => zoom(ZOOM),
  "-": () => zoom(1 / ZOOM),
  " ": () => setPlaying(!state.isPlaying),
  0: () => reset(),
};

/** Fingers, or the mouse, that are down on the canvas. */
const pointers = new Map();

function movePointer(event) {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const now = [event.clientX, event.clientY];
  pointers.set(event.pointerId, now);
  const [x, y] = [now[0] - before[0], now[1] - before[1]];
  if (pointers.size === 2) {
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const apart = point => Math.hypot(point[0] - other[0], point[1] - other[1]);
    pan(x / 2, y / 2);
    zoom(apart(now) / Math.max(1, apart(before)));
  } else if (event.shiftKey || event.buttons & 6) pan(x, y);
  else turn(x / 200, y / 200);
}

function listen() {
  CANVAS.addEventListener("pointerdown", event => {
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    // A pointer that a program made cannot be captured.
    if (event.isTrusted) CANVAS.setPointerCapture(event.pointerId);
  });
  CANVAS.addEventListener("pointermove", movePointer);
  for (const end of ["pointerup", "pointercancel"]) {
    CANVAS.addEventListener(end, event => pointers.delete(event.pointerId));
  }
  CANVAS.addEventListener("contextmenu", event => event.preventDefault());
  CANVAS.addEventListener("wheel", event => {
    event.preventDefault();
    zoom(ZOOM ** clamp(-event.deltaY / (event.deltaMode ? 3 : 100), -3, 3));
  }, { passive: false });
  CANVAS.addEventListener("keydown", event => {
    if (event.ctrlKey || event.altKey || event.metaKey || !Object.hasOwn(KEYS, event.key)) return;
    event.preventDefault();
    KEYS[event.key](event.shiftKey);
  });
  for (const id of ["colours", "edges", "cuts", "culling", "parallel"]) {
    $(id).addEventListener("change", readControls);
  }
  $("place").addEventListener("input", () => {
    setPlaying(false);
    readPlace();
    describe();
  });
  $("play").addEventListener("click", () => setPlaying(!state.isPlaying));
  $("reset").addEventListener("click", reset);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", readControls);
  new ResizeObserver(resize).observe(CANVAS);
}

for (const [name, value] of DATA.figures) {
  const [term, figure] = ["dt", "dd"].map(tag => document.createElement(tag));
  [term.textContent, figure.textContent] = [name, value];
  $("figures").append(term, figure);
}
$("place").max = TREE.fragments;
$("place").value = TREE.fragments;
listen();
readControls();
resize();
describe();
