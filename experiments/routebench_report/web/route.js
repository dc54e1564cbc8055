// A route as typed arrays: what is laid (segments) and the moves between (travels), layer by layer
// in the order of printing. No object is made for a move.

const CROSSING = 1;
const RETRACTED = 2;
const ENTRY = 4; // from where the layer below ended
const CONTINUED = 8; // goes on where the travel before it ended: counted once

/** Numbers of a segment or travel: x and y of both ends, height, width. */
const STRIDE = 6;

/** Grows typed arrays while the length is not known. */
class GrowingArray {
  constructor(type, capacity) {
    this.values = new type(Math.max(16, capacity));
    this.length = 0;
  }

  room(more) {
    if (this.length + more <= this.values.length) return;
    const grown = new this.values.constructor(Math.max(2 * this.values.length, this.length + more));
    grown.set(this.values);
    this.values = grown;
  }

  push(value) {
    if (this.length === this.values.length) this.room(1);
    this.values[this.length++] = value;
  }

  taken() {
    return this.values.subarray(0, this.length);
  }
}

/** Puts a route together, move by move. */
class RouteBuilder {
  constructor(name, kinds, expected = 1024) {
    this.name = name;
    this.kinds = kinds;
    this.segments = new GrowingArray(Float32Array, STRIDE * expected);
    this.segmentKind = new GrowingArray(Uint8Array, expected);
    this.segmentSpeed = null;
    this.travels = new GrowingArray(Float32Array, 1024);
    this.travelFlags = new GrowingArray(Uint8Array, 256);
    this.travelSpeed = null;
    this.segmentsBefore = new GrowingArray(Uint32Array, 256);
    this.layers = [];
  }

  /** Speeds are told move by move. */
  recordSpeeds() {
    this.segmentSpeed = new GrowingArray(Float32Array, 1024);
    this.travelSpeed = new GrowingArray(Float32Array, 256);
  }

  /** Begins a layer: its number, the height that is shown, and the top of its beads. */
  beginLayer(index, zMm, topMm) {
    this.layers.push({
      index,
      zMm,
      topMm,
      firstSegment: this.segmentKind.length,
      firstTravel: this.travelFlags.length,
    });
  }

  segment(x0, y0, x1, y1, z, width, kind) {
    RouteBuilder.put(this.segments, x0, y0, x1, y1, z, width);
    this.segmentKind.push(kind);
  }

  travel(x0, y0, x1, y1, z, flags) {
    RouteBuilder.put(this.travels, x0, y0, x1, y1, z, 0);
    this.travelFlags.push(flags);
    this.segmentsBefore.push(this.segmentKind.length);
  }

  /** Whether nothing has been laid or crossed since the last beginLayer. */
  layerIsEmpty() {
    const layer = this.layers[this.layers.length - 1];
    return layer.firstSegment === this.segmentKind.length;
  }

  finish() {
    return new Route(this);
  }

  static put(array, x0, y0, x1, y1, z, width) {
    array.room(STRIDE);
    const { values } = array;
    let at = array.length;
    values[at++] = x0;
    values[at++] = y0;
    values[at++] = x1;
    values[at++] = y1;
    values[at++] = z;
    values[at++] = width;
    array.length = at;
  }
}

/** A finished route. Layers are numbered from 0 in the order of printing: their place. */
class Route {
  constructor(builder) {
    this.name = builder.name;
    this.kinds = builder.kinds;
    this.segments = builder.segments.taken();
    this.segmentKind = builder.segmentKind.taken();
    this.segmentSpeed = builder.segmentSpeed && builder.segmentSpeed.taken();
    this.travels = builder.travels.taken();
    this.travelFlags = builder.travelFlags.taken();
    this.travelSpeed = builder.travelSpeed && builder.travelSpeed.taken();
    this.segmentsBefore = builder.segmentsBefore.taken();
    this.layers = builder.layers;
    this.knowsCrossings = false;
    this.note = "";
  }

  get segmentCount() {
    return this.segmentKind.length;
  }

  get travelCount() {
    return this.travelFlags.length;
  }

  /** First segment and travel of the layer at a place; one past the last gives the ends. */
  start(place) {
    const layer = this.layers[place];
    return layer
      ? { segment: layer.firstSegment, travel: layer.firstTravel }
      : { segment: this.segmentCount, travel: this.travelCount };
  }

  /** Segments and travels of a layer together. */
  movesOf(place) {
    const start = this.start(place);
    const end = this.start(place + 1);
    return end.segment - start.segment + end.travel - start.travel;
  }

  /** Segments and travels that are done after so many moves of a layer. */
  after(place, moves) {
    const start = this.start(place);
    const end = this.start(place + 1);
    const done = Math.min(moves, this.movesOf(place));
    // Travel t is move number (segments before it) + (travels before it).
    let low = start.travel;
    let high = end.travel;
    while (low < high) {
      const middle = (low + high) >> 1;
      const number = this.segmentsBefore[middle] - start.segment + middle - start.travel;
      if (number < done) low = middle + 1;
      else high = middle;
    }
    return { segment: start.segment + done - (low - start.travel), travel: low };
  }

  /** Where the nozzle is after so many moves of a layer; null at the very beginning. */
  nozzle(place, moves) {
    const start = this.start(place);
    const now = this.after(place, moves);
    const segments = now.segment - start.segment;
    const travels = now.travel - start.travel;
    if (segments + travels === 0) return null;
    const lastIsTravel = travels > 0 && this.segmentsBefore[now.travel - 1] === now.segment;
    const [array, at] = lastIsTravel
      ? [this.travels, STRIDE * (now.travel - 1)]
      : [this.segments, STRIDE * (now.segment - 1)];
    return { x: array[at + 2], y: array[at + 3], z: array[at + 4], travelling: lastIsTravel };
  }

  /** What a layer's route adds up to, up to a number of moves. */
  tally(place, moves = Infinity) {
    const start = this.start(place);
    const end = this.after(place, moves);
    const sum = { extrudeMm: 0, travelMm: 0, travels: 0, retractions: 0, crossings: 0 };
    for (let s = start.segment; s < end.segment; s++) sum.extrudeMm += lengthOf(this.segments, s);
    for (let t = start.travel; t < end.travel; t++) {
      const flags = this.travelFlags[t];
      sum.travelMm += lengthOf(this.travels, t);
      if (flags & CONTINUED) continue;
      sum.travels++;
      if (flags & RETRACTED) sum.retractions++;
      if (flags & CROSSING) sum.crossings++;
    }
    return sum;
  }

  /** Box around the part: what is laid but skirts, supports and the like, where they are told. */
  partBounds() {
    const known = this.kinds.map((kind) => ["wall", "dense", "sparse"].includes(kind));
    return this.bounds((segment) => known[this.segmentKind[segment]]) || this.bounds();
  }

  /** Box around all that is laid, or those segments of it that `counts` says. */
  bounds(counts = () => true) {
    const box = { low: [Infinity, Infinity, 0], high: [-Infinity, -Infinity, 0] };
    for (let i = 0; i < this.segments.length; i += STRIDE) {
      if (!counts(i / STRIDE)) continue;
      for (const [x, y] of [
        [this.segments[i], this.segments[i + 1]],
        [this.segments[i + 2], this.segments[i + 3]],
      ]) {
        if (x < box.low[0]) box.low[0] = x;
        if (x > box.high[0]) box.high[0] = x;
        if (y < box.low[1]) box.low[1] = y;
        if (y > box.high[1]) box.high[1] = y;
      }
      if (this.segments[i + 4] > box.high[2]) box.high[2] = this.segments[i + 4];
    }
    return box.low[0] <= box.high[0] ? box : null;
  }

  /** The place of the layer whose height is nearest, if it is nearer than `withinMm`. */
  placeAt(zMm, withinMm) {
    let best = -1;
    let distance = withinMm;
    this.layers.forEach((layer, place) => {
      if (Math.abs(layer.zMm - zMm) <= distance) {
        best = place;
        distance = Math.abs(layer.zMm - zMm);
      }
    });
    return best;
  }
}

function lengthOf(array, number) {
  const at = STRIDE * number;
  return Math.hypot(array[at + 2] - array[at], array[at + 3] - array[at + 1]);
}

/** Whether the printer retracts on a travel: the judge's rules. */
function retracts(printer, dx, dy, crossing) {
  const limit = Number(printer.retract_over_mm);
  if (printer.retract_policy === "manhattan") return Math.abs(dx) + Math.abs(dy) >= limit;
  const far = Math.hypot(dx, dy) >= limit;
  return printer.retract_policy === "length_and_crossing" ? far && crossing : far;
}

/** The kept routes of a cell, with travels judged by the printer and the outlines of the layers. */
function readRoute(buffer, { name, quantumMm, printer, joinMm, heightMm, outlines }) {
  const reader = new BlockReader(buffer);
  const [layers, strokes, points, nameBytes] = reader.integers(4);
  const indices = reader.integers(layers);
  const heights = reader.integers(layers);
  const strokeCounts = reader.integers(layers);
  const pointCounts = reader.integers(strokes);
  const widths = reader.integers(strokes);
  const kinds = reader.integers(strokes);
  const xs = reader.coordinates(points);
  const ys = reader.coordinates(points);
  const builder = new RouteBuilder(name, JSON.parse(reader.text(nameBytes)), points);

  let stroke = 0;
  let point = 0;
  let end = null; // where the nozzle is; null where that is not known
  for (let layer = 0; layer < layers; layer++) {
    const z = heights[layer] * quantumMm;
    const top = z + heightMm / 2; // layers are cut at half their height
    builder.beginLayer(indices[layer], z, top);
    if (layer > 0 && indices[layer] !== indices[layer - 1] + 1) end = null;
    const shape = outlines && outlines.get(indices[layer]);
    const outline = shape ? new Outline(shape.rings) : null;
    let entering = true;
    for (let i = 0; i < strokeCounts[layer]; i++, stroke++) {
      const width = widths[stroke] * quantumMm;
      let x0 = xs[point] * quantumMm;
      let y0 = ys[point] * quantumMm;
      if (end && Math.hypot(x0 - end.x, y0 - end.y) > joinMm) {
        const crossing = outline ? outline.outsideMm(end.x, end.y, x0, y0) > CROSSING_MM : false;
        const retracted = retracts(printer, x0 - end.x, y0 - end.y, crossing);
        const flags =
          (crossing ? CROSSING : 0) | (retracted ? RETRACTED : 0) | (entering ? ENTRY : 0);
        builder.travel(end.x, end.y, x0, y0, top, flags);
      }
      entering = false;
      for (let p = 1; p < pointCounts[stroke]; p++) {
        const x1 = xs[point + p] * quantumMm;
        const y1 = ys[point + p] * quantumMm;
        if (x1 === x0 && y1 === y0) continue;
        builder.segment(x0, y0, x1, y1, top, width, kinds[stroke]);
        x0 = x1;
        y0 = y1;
      }
      point += pointCounts[stroke];
      end = { x: x0, y: y0 };
    }
  }
  const route = builder.finish();
  route.knowsCrossings = Boolean(outlines);
  return route;
}
