// The page's data: cells with their routes, outlines and layer scores, unpacked when asked for.

/** Routes kept unpacked: those of two panes, and the two before them. */
const ROUTES_KEPT = 4;

class Experiment {
  constructor(data) {
    Object.assign(this, data);
    this.shortNames = shortNames(this.models);
    this.routes = new Map();
    this.outlines = new Map();
    this.scores = new Map();
  }

  /** All cells of a contender on a model under a setting: one a seed. */
  cellsOf(setting, model, contender) {
    return this.cells.filter(
      (cell) =>
        cell.setting === setting && cell.model === model && cell.contender === contender,
    );
  }

  cellOf(setting, model, contender, seed) {
    const found = this.cellsOf(setting, model, contender);
    return found.find((cell) => cell.seed === seed) || found[0] || null;
  }

  heightOf(setting) {
    return Number(this.settings[setting].task.layer_height_mm) || DEFAULT_HEIGHT_MM;
  }

  outlinesOf(cell) {
    if (!cell.outline) return Promise.resolve(null);
    return remembered(this.outlines, cell.outline, ROUTES_KEPT, async () =>
      readOutlines(await unpackedBlock(cell.outline), this.quantum_mm),
    );
  }

  layerScoresOf(cell) {
    if (!cell.layers) return Promise.resolve(null);
    return remembered(this.scores, cell.layers, 64, async () =>
      readScores(await unpackedBlock(cell.layers), this.quantum_mm),
    );
  }

  /** Null where no layer's route was kept. */
  routeOf(cell) {
    if (!cell.route) return Promise.resolve(null);
    return remembered(this.routes, cell.route, ROUTES_KEPT, async () => {
      const setting = this.settings[cell.setting];
      return readRoute(await unpackedBlock(cell.route), {
        name: this.contenders[cell.contender].name,
        quantumMm: this.quantum_mm,
        printer: setting.printer,
        joinMm: Number(setting.task.join_mm) || 0.01,
        heightMm: this.heightOf(cell.setting),
        outlines: await this.outlinesOf(cell),
      });
    });
  }
}

/** Files without their folders, where that leaves no two alike. */
function shortNames(names) {
  const short = names.map((name) => name.replace(/^[^?]*\/(?=[^/?]+(\?|$))/, ""));
  const isOnly = (name) => short.indexOf(name) === short.lastIndexOf(name);
  return names.map((name, i) => (isOnly(short[i]) ? short[i] : name));
}

/** What `make` promises, kept by its key; beyond `most` the oldest is forgotten. */
function remembered(map, key, most, make) {
  if (!map.has(key)) {
    map.set(key, make());
    if (map.size > most) map.delete(map.keys().next().value);
  }
  return map.get(key);
}

/** Layer scores of a route that no judge has seen: what can be counted in it. */
function countedScores(route, metrics) {
  const tallies = route.layers.map((_, place) => route.tally(place));
  const known = {
    extrude_mm: (t) => t.extrudeMm,
    travel_mm: (t) => t.travelMm,
    travels: (t) => t.travels,
    retractions: (t) => t.retractions,
  };
  return {
    indices: route.layers.map((layer) => layer.index),
    zMm: route.layers.map((layer) => layer.zMm),
    columns: metrics.map(({ name }) =>
      Float32Array.from(tallies, (tally) => (known[name] ? known[name](tally) : NaN)),
    ),
  };
}

/** Layers by badness under a metric: [{row, index, value}], the worst first. */
function worstLayers(scores, column, better) {
  const sign = better === "higher" ? 1 : -1;
  const found = [];
  scores.columns[column].forEach((value, row) => {
    if (!Number.isNaN(value)) found.push({ row, index: scores.indices[row], value });
  });
  return found.sort((one, other) => sign * (one.value - other.value) || one.row - other.row);
}
