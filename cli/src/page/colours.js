// The colours of fragments, and the meaning of these colours.

/** Colours of the depth of nodes, from 1 to the deepest. */
const DEPTHS = [[112, 62, 168], [72, 108, 208], [32, 164, 172], [96, 200, 100], [244, 224, 60]];
/** Colours of sides, distinct for colour-blind eyes too. */
const [FRONT, BACK] = [[86, 180, 233], [230, 159, 0]];

function materialOf(fragment) {
  return DATA.materials[TREE.polygonMaterials[TREE.polygons[fragment]]];
}

/** A different colour for each polygon: steps of the golden ratio spread the hues. */
function ownColour(polygon) {
  const hue = 6 * ((polygon * 0.618033988749895) % 1);
  const [saturation, value] = [[0.55, 0.95], [0.75, 0.85], [0.4, 0.9]][polygon % 3];
  return [5, 3, 1].map(offset => {
    const k = (offset + hue) % 6;
    return 255 * value * (1 - saturation * clamp(Math.min(k, 4 - k), 0, 1));
  });
}

/** The colour of a share from 0 to 1 of the deepest node. */
function depthColour(share) {
  const at = share * (DEPTHS.length - 1);
  const i = Math.min(Math.floor(at), DEPTHS.length - 2);
  return [0, 1, 2].map(c => DEPTHS[i][c] + (at - i) * (DEPTHS[i + 1][c] - DEPTHS[i][c]));
}

const COLOURS = {
  material: fragment => materialOf(fragment).colour,
  polygon: fragment => ownColour(TREE.polygons[fragment]),
  depth: fragment => depthColour((TREE.depths[fragment] - 1) / Math.max(1, TREE.depth - 1)),
  facing: fragment => (TREE.distances[TREE.fragmentPlanes[fragment]] > 0 ? FRONT : BACK),
};

/** Sets the colour of every fragment. */
function colour() {
  const of = COLOURS[$("colours").value];
  style.colours ??= new Float32Array(3 * TREE.fragments);
  for (let i = 0; i < TREE.fragments; i++) style.colours.set(of(i), 3 * i);
}

function showLegend() {
  const kind = $("colours").value;
  const css = rgb => `rgb(${rgb})`;
  const swatch = background => {
    const span = document.createElement("span");
    span.className = "swatch";
    span.style.background = background;
    return span;
  };
  const parts = {
    depth: ["1 ", swatch(`linear-gradient(to right, ${DEPTHS.map(css)})`), ` ${TREE.depth}`],
    facing: [swatch(css(FRONT)), " front ", swatch(css(BACK)), " back"],
  }[kind];
  $("legend").replaceChildren(...(parts ?? []));
  $("legend").classList.toggle("wide", kind === "depth");
}
