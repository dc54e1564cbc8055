// A metric over the layers, above the layer slider: where a contender loses.

class LayerChart {
  constructor(canvas, onPick) {
    this.canvas = canvas;
    this.series = [];
    this.kept = [];
    this.top = 1;
    this.layers = 0;
    this.cursor = null;
    this.from = null;
    canvas.addEventListener("click", (event) => {
      const box = canvas.getBoundingClientRect();
      const share = (event.clientX - box.left) / box.width;
      onPick(share * this.top);
    });
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** Series of {colour, zMm, values}; `cursor`, `from` and `kept` are heights, mm. */
  show(series, { cursor, from, kept }) {
    this.series = series;
    this.cursor = cursor;
    this.from = from;
    this.kept = kept;
    const tops = [...series.map((s) => s.zMm), kept].map((heights) => heights[heights.length - 1]);
    this.top = Math.max(1e-3, ...tops.filter((z) => z !== undefined));
    this.layers = Math.max(0, ...series.map((s) => s.zMm.length));
    this.draw();
  }

  draw() {
    const { canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    if (width === 0) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    pen.clearRect(0, 0, width, height);
    const x = (z) => (z / this.top) * (width - 2) + 1;
    let high = 0;
    let low = 0;
    for (const { values } of this.series)
      for (const value of values) {
        if (value > high) high = value;
        if (value < low) low = value;
      }
    const y = (value) => height - 3 - ((value - low) / (high - low || 1)) * (height - 8);
    if (this.cursor !== null && this.from !== null) {
      pen.fillStyle = "#e3e9ee";
      pen.fillRect(x(this.from) - 1, 0, x(this.cursor) - x(this.from) + 2, height);
    }
    // Dots where a route was kept, if it was not everywhere.
    if (this.kept.length < this.layers) {
      pen.fillStyle = "#444";
      for (const z of this.kept) pen.fillRect(x(z) - 1, height - 3, 2, 3);
    }
    this.series.forEach(({ colour, zMm, values }, number) => {
      pen.beginPath();
      let down = true;
      zMm.forEach((z, row) => {
        const value = values[row];
        if (Number.isNaN(value)) {
          down = true;
          return;
        }
        if (down) pen.moveTo(x(z), y(value));
        else pen.lineTo(x(z), y(value));
        down = false;
      });
      pen.strokeStyle = colour;
      pen.lineWidth = 1.6;
      pen.setLineDash(number === 0 ? [] : [4, 2]);
      pen.stroke();
    });
    pen.setLineDash([]);
    if (this.cursor !== null) {
      pen.fillStyle = "#111";
      pen.fillRect(x(this.cursor) - 0.75, 0, 1.5, height);
    }
  }
}
