// The outline of a layer, and how much of a straight way lies outside of it.

/** What the judge allows a travel to be outside without calling it a crossing, plus rounding. */
const CROSSING_MM = 0.0005;

/** A layer's edges in rows by y, so that a way only meets those near it. */
class Outline {
  constructor(rings) {
    let edges = 0;
    for (const ring of rings) edges += ring.length / 2;
    this.edges = new Float64Array(4 * edges);
    let low = Infinity;
    let high = -Infinity;
    let at = 0;
    for (const ring of rings) {
      for (let i = 0, j = ring.length - 2; i < ring.length; j = i, i += 2) {
        this.edges.set([ring[j], ring[j + 1], ring[i], ring[i + 1]], at);
        at += 4;
        low = Math.min(low, ring[i + 1]);
        high = Math.max(high, ring[i + 1]);
      }
    }
    this.low = low;
    this.high = high;
    this.rows = Math.max(1, Math.min(4096, Math.ceil(2 * Math.sqrt(edges))));
    this.perMm = high > low ? this.rows / (high - low) : 0;
    this.seen = new Int32Array(edges).fill(-1);
    this.query = 0;
    this.fillRows(edges);
  }

  /** Lengths of the way from a to b that lie outside. */
  outsideMm(ax, ay, bx, by) {
    const cuts = this.cuts(ax, ay, bx, by);
    const length = Math.hypot(bx - ax, by - ay);
    let outside = 0;
    for (let i = 1; i < cuts.length; i++) {
      const middle = (cuts[i - 1] + cuts[i]) / 2;
      if (!this.contains(ax + middle * (bx - ax), ay + middle * (by - ay)))
        outside += (cuts[i] - cuts[i - 1]) * length;
    }
    return outside;
  }

  contains(x, y) {
    if (!(y >= this.low && y <= this.high)) return false;
    const row = this.rowOf(y);
    let inside = false;
    for (let k = this.rowStart[row]; k < this.rowStart[row + 1]; k++) {
      const e = 4 * this.rowEdges[k];
      const y0 = this.edges[e + 1];
      const y1 = this.edges[e + 3];
      if (y0 > y === y1 > y) continue;
      const x0 = this.edges[e];
      if (x < x0 + ((this.edges[e + 2] - x0) * (y - y0)) / (y1 - y0)) inside = !inside;
    }
    return inside;
  }

  /** Where the way meets the outline, as shares of it, with both ends, in order. */
  cuts(ax, ay, bx, by) {
    const found = [0, 1];
    const dx = bx - ax;
    const dy = by - ay;
    this.query++;
    const first = this.rowOf(Math.min(ay, by));
    const last = this.rowOf(Math.max(ay, by));
    for (let k = this.rowStart[first]; k < this.rowStart[last + 1]; k++) {
      const edge = this.rowEdges[k];
      if (this.seen[edge] === this.query) continue;
      this.seen[edge] = this.query;
      const e = 4 * edge;
      const ex = this.edges[e + 2] - this.edges[e];
      const ey = this.edges[e + 3] - this.edges[e + 1];
      const cross = dx * ey - dy * ex;
      if (cross === 0) continue;
      const ox = this.edges[e] - ax;
      const oy = this.edges[e + 1] - ay;
      const onWay = (ox * ey - oy * ex) / cross;
      const onEdge = (ox * dy - oy * dx) / cross;
      if (onWay > 0 && onWay < 1 && onEdge >= 0 && onEdge <= 1) found.push(onWay);
    }
    return found.sort((one, other) => one - other);
  }

  rowOf(y) {
    return Math.max(0, Math.min(this.rows - 1, Math.floor((y - this.low) * this.perMm) || 0));
  }

  fillRows(edges) {
    const rowsOf = (edge) => {
      const y0 = this.edges[4 * edge + 1];
      const y1 = this.edges[4 * edge + 3];
      return [this.rowOf(Math.min(y0, y1)), this.rowOf(Math.max(y0, y1))];
    };
    this.rowStart = new Int32Array(this.rows + 1);
    for (let edge = 0; edge < edges; edge++) {
      const [first, last] = rowsOf(edge);
      for (let row = first; row <= last; row++) this.rowStart[row + 1]++;
    }
    for (let row = 0; row < this.rows; row++) this.rowStart[row + 1] += this.rowStart[row];
    const next = this.rowStart.slice();
    this.rowEdges = new Int32Array(this.rowStart[this.rows]);
    for (let edge = 0; edge < edges; edge++) {
      const [first, last] = rowsOf(edge);
      for (let row = first; row <= last; row++) this.rowEdges[next[row]++] = edge;
    }
  }
}
