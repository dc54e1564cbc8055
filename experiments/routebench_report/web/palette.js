// Colours, and the legend that says what they mean. Those of kinds and travels are the figures'.

const CROSSING_COLOUR = "#7B2CBF";
const RETRACTION_COLOUR = "#F0E442";
const MODES = ["kind", "order", "speed", "contender"];
const MODE_WORDS = {
  kind: "Kind of stroke",
  order: "Order in the layer",
  speed: "Speed",
  contender: "Contender",
};
const RAMP = [
  [68, 1, 84], [72, 40, 120], [62, 73, 137], [49, 104, 142], [38, 130, 142],
  [31, 158, 137], [53, 183, 121], [110, 206, 88], [181, 222, 43], [253, 231, 37],
];

function rgbOf(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

/** A colour between dark violet (0) and yellow (1), even to the eye. */
function ramp(share) {
  const place = Math.max(0, Math.min(1, share)) * (RAMP.length - 1);
  const low = Math.min(RAMP.length - 2, Math.floor(place));
  return RAMP[low].map((c, i) => Math.round(c + (place - low) * (RAMP[low + 1][i] - c)));
}

function rampCss() {
  return `linear-gradient(to right, ${RAMP.map((c) => `rgb(${c.join(",")})`).join(", ")})`;
}

class Palette {
  constructor(colours) {
    this.colours = colours;
  }

  ofKind(kind) {
    return this.colours.strokes[kind] || this.colours.other;
  }

  /** Red, green, blue and opacity of every segment. Equal for equal shares of the layer's order. */
  segmentTints(route, mode, { contenderColour, speeds, speedRange }) {
    const tints = new Uint8Array(4 * route.segmentCount).fill(255);
    const paint = (segment, [r, g, b]) => {
      const at = 4 * segment;
      tints[at] = r;
      tints[at + 1] = g;
      tints[at + 2] = b;
    };
    if (mode === "order" || mode === "speed") {
      const steps = Array.from({ length: 256 }, (_, i) => ramp(i / 255));
      const [low, high] = speedRange || [0, 1];
      route.layers.forEach((layer, place) => {
        const end = route.start(place + 1).segment;
        const count = Math.max(1, end - layer.firstSegment - 1);
        for (let s = layer.firstSegment; s < end; s++) {
          const share =
            mode === "order"
              ? (s - layer.firstSegment) / count
              : high > low ? (speeds[s] - low) / (high - low) : 1;
          paint(s, steps[Math.round(255 * Math.max(0, Math.min(1, share)))]);
        }
      });
      return tints;
    }
    const flat = mode === "contender" && rgbOf(contenderColour);
    const kinds = route.kinds.map((kind) => rgbOf(this.ofKind(kind)));
    for (let s = 0; s < route.segmentCount; s++) paint(s, flat || kinds[route.segmentKind[s]]);
    return tints;
  }

  /** Travels and crossings; what is switched off is transparent. */
  travelTints(route, shown) {
    const tints = new Uint8Array(4 * route.travelCount);
    // Opacity decides on the width, too; see BEAD_VERTEX.
    const plain = [...rgbOf(this.colours.travel), shown.travels ? 128 : 0];
    const crossing = [...rgbOf(CROSSING_COLOUR), shown.crossings ? 255 : 0];
    for (let t = 0; t < route.travelCount; t++)
      tints.set(shown.crossings && route.travelFlags[t] & CROSSING ? crossing : plain, 4 * t);
    return tints;
  }

  /** Entries of the legend: a colour or the ramp, a shape, and words. */
  legend(mode, routes, shown, { contenders, speedRange, speedsAreModelled }) {
    const entries = [];
    if (mode === "kind") {
      const used = new Set(routes.flatMap((route) => usedKinds(route)));
      const order = ["wall", "dense", "sparse"];
      const rank = (kind) => (order.indexOf(kind) + order.length + 1) % (order.length + 1);
      for (const kind of [...used].sort((a, b) => rank(a) - rank(b)))
        entries.push({ colour: this.ofKind(kind), shape: "bead", words: kind });
    } else if (mode === "contender") {
      for (const { name, colour } of contenders)
        entries.push({ colour, shape: "bead", words: name });
    } else if (mode === "order") {
      entries.push({ shape: "ramp", from: "first", to: "last of its layer" });
    } else if (speedRange) {
      const [low, high] = speedRange.map((v) => formatNumber(v));
      const how = speedsAreModelled ? "mean, by the printer’s limits" : "as commanded";
      const words = `${high} mm/s, ${how}`;
      if (low === high) entries.push({ colour: `rgb(${ramp(1)})`, shape: "bead", words });
      else entries.push({ shape: "ramp", from: low, to: words });
    }
    if (shown.travels)
      entries.push({ colour: this.colours.travel, shape: "line", words: "travel" });
    if (shown.crossings && routes.some((route) => route.knowsCrossings))
      entries.push({ colour: CROSSING_COLOUR, shape: "thick", words: "crossing: leaves the part" });
    if (shown.retractions)
      entries.push({ colour: RETRACTION_COLOUR, shape: "triangle", words: "retraction" });
    if (shown.outline && routes.some((route) => route.knowsCrossings))
      entries.push({ colour: "#8A8A8A", shape: "line", words: "outline" });
    return entries;
  }
}

function usedKinds(route) {
  const used = new Uint8Array(route.kinds.length);
  for (let s = 0; s < route.segmentCount; s++) used[route.segmentKind[s]] = 1;
  return route.kinds.filter((_, kind) => used[kind]);
}

/** Four significant digits; thousands apart. */
function formatNumber(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "n/a";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e9 || size < 1e-4) return value.toPrecision(3);
  if (size >= 1000 || Number.isInteger(value))
    return Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, "\u202f");
  return String(Number(value.toPrecision(4)));
}
