// What the viewer shows and how it gets there. The elements of the page are wired in controls.js.

const SAME_LAYER_SHARE = 0.4; // layers of two routes are one if their tops are nearer, in heights
const THICKEST_MM = 1; // a layer of G-code; what is farther apart has a gap between
const TOGGLES = ["strokes", "travels", "crossings", "retractions", "outline", "fade"];

class Viewer {
  constructor(experiment, stage, onChange) {
    this.experiment = experiment;
    this.stage = stage;
    this.onChange = onChange;
    this.files = []; // routes read from G-code
    this.sides = [];
    this.levels = [];
    this.state = {
      model: 0, setting: 0, seed: null, a: "", b: "",
      level: 0, from: 0, single: false, move: null,
      colour: "kind", metric: 0,
      shown: Object.fromEntries(TOGGLES.map((name) => [name, true])),
    };
    this.message = "";
    this.turn = 0; // later loads overtake earlier ones
    this.visits = { key: "", next: 0 };
  }

  /** What can stand on a side: contenders and files, by key. */
  sources() {
    return [
      ...this.experiment.contenders.map(({ name, colour }, i) => ({ key: `c${i}`, name, colour })),
      ...this.files.map(({ name }, i) => ({
        key: `f${i}`, name: `${name} (file)`, colour: i % 2 ? "#8C510A" : "#4D4D4D",
      })),
    ];
  }

  addFile(route) {
    const same = this.files.findIndex((file) => file.name === route.name);
    if (same >= 0) this.files[same] = route;
    else this.files.push(route);
    const key = `f${same >= 0 ? same : this.files.length - 1}`;
    const { state } = this;
    if (state.a === "" || state.a === key) state.a = key;
    else state.b = key;
    return key;
  }

  /** Chooses what to show, loads it if it is not there yet, and draws it. */
  async choose(change, { keepCamera = true } = {}) {
    const turn = ++this.turn;
    const topMm = this.levels[this.state.level] && this.levels[this.state.level].topMm;
    const wasSingle = this.state.single;
    const model = this.state.model;
    Object.assign(this.state, change);
    const sides = await this.load();
    if (turn !== this.turn) return;
    this.sides = sides;
    this.findLevels();
    this.alignFiles();
    const { state } = this;
    const sameModel = model === state.model && topMm !== undefined;
    state.level = sameModel ? this.levelNear(topMm) : this.levels.length - 1;
    state.from = wasSingle ? state.level : Math.min(state.from, state.level);
    if (!sameModel && !wasSingle) state.from = 0;
    state.move = null;
    this.stage.setPanes(sides.filter((side) => side.pane).map((side) => side.pane));
    if (!keepCamera || !sameModel) this.look(this.levels.length > 1 ? "iso" : "top");
    this.paint();
    this.update();
  }

  /** The left side and, if there is one, the right: route, scores, and why there is no route. */
  load() {
    const { state, experiment } = this;
    const keys = [state.a, state.b].filter((key) => key !== "");
    return Promise.all(
      keys.map(async (key) => {
        const source = this.sources().find((s) => s.key === key);
        const number = Number(key.slice(1));
        if (key[0] === "f") {
          const route = this.files[number];
          const pane = new Pane(route, DEFAULT_HEIGHT_MM, null);
          return { key, source, route, pane, scores: countedScores(route, experiment.metrics) };
        }
        const cell = experiment.cellOf(state.setting, state.model, number, state.seed);
        if (!cell) return { key, source, cell, why: "not run" };
        const scores = await experiment.layerScoresOf(cell);
        const route = await experiment.routeOf(cell);
        if (!route) {
          const why =
            cell.outcome === "valid" || cell.outcome === "off_task"
              ? "no route was kept: run with keep_layers = \"all\""
              : `${cell.outcome_words}: ${cell.reason}`;
          return { key, source, cell, scores, why };
        }
        const pane = new Pane(route, this.heightMm(), await experiment.outlinesOf(cell));
        return { key, source, cell, scores, route, pane };
      }),
    );
  }

  /** The layers of all sides, lowest first, those of equal height together. */
  findLevels() {
    const near = SAME_LAYER_SHARE * this.heightMm();
    const all = [];
    this.sides.forEach((side, number) => {
      if (!side.route) return;
      side.route.layers.forEach((layer, place) => all.push({ layer, place, number }));
    });
    all.sort((one, other) => one.layer.topMm - other.layer.topMm);
    this.levels = [];
    for (const { layer, place, number } of all) {
      let level = this.levels[this.levels.length - 1];
      if (!level || layer.topMm - level.topMm > near || level.places[number] >= 0) {
        level = { topMm: layer.topMm, zMm: layer.zMm, index: layer.index, places: [-1, -1] };
        this.levels.push(level);
      }
      level.places[number] = place;
    }
    this.sides.forEach((side, number) => {
      if (side.route) this.findThicker(side, number);
    });
  }

  heightMm() {
    return this.experiment.settings.length
      ? this.experiment.heightOf(this.state.setting)
      : DEFAULT_HEIGHT_MM;
  }

  /** Where layers are of unequal height, a level shows the layer that it runs through. */
  findThicker(side, number) {
    const { layers } = side.route;
    let place = 0;
    for (const level of this.levels) {
      while (place < layers.length && layers[place].topMm < level.topMm - 1e-6) place++;
      if (place === layers.length) break;
      if (level.places[number] >= 0) continue;
      const below = place > 0 ? layers[place - 1].topMm : 0;
      const most = side.cell ? side.pane.heightMm : THICKEST_MM;
      const thickness = Math.min(most, layers[place].topMm - below);
      if (layers[place].topMm - thickness < level.topMm - 1e-6) level.places[number] = place;
    }
  }

  /** A file made for another place on the bed is shown where the other side is. */
  alignFiles() {
    const [one, other] = this.sides;
    if (!one || !other || !one.route || !other.route) return;
    const [file, fixed] = other.key[0] === "f" ? [other, one] : [one, other];
    if (file.key[0] !== "f") return;
    file.moved = file.pane.moveOnto(fixed.route);
  }

  levelNear(topMm) {
    return this.nearest((level) => Math.abs(level.topMm - topMm));
  }

  levelOfIndex(index) {
    return this.nearest((level) => Math.abs(level.index - index));
  }

  nearest(distance) {
    let best = -1;
    this.levels.forEach((level, i) => {
      if (best < 0 || distance(level) < distance(this.levels[best])) best = i;
    });
    return best;
  }

  /** Goes to a level; -1 and beyond are taken as the ends. */
  setLevel(level, { from } = {}) {
    const { state } = this;
    state.level = Math.max(0, Math.min(this.levels.length - 1, level));
    if (state.single) state.from = state.level;
    else state.from = Math.min(from === undefined ? state.from : from, state.level);
    state.move = null;
    this.update();
  }

  setFrom(level) {
    this.state.from = Math.max(0, Math.min(level, this.state.level));
    this.state.single = this.state.from === this.state.level && this.state.single;
    this.update();
  }

  setSingle(single) {
    this.state.single = single;
    this.state.from = single ? this.state.level : 0;
    this.update();
  }

  /** Moves of the current layer on the side that the slider counts: the first that has it. */
  moveCount() {
    const level = this.levels[this.state.level];
    const side = level && this.sides.findIndex((_, number) => level.places[number] >= 0);
    return level && side >= 0 ? this.sides[side].route.movesOf(level.places[side]) : 0;
  }

  /** Shows the layer up to a move; beyond the last one means all of it. */
  setMove(move) {
    const most = this.moveCount();
    this.state.move = move >= most ? null : Math.max(0, move);
    this.update();
  }

  /** The share of the current layer's moves that is shown. */
  moveShare() {
    const most = this.moveCount();
    return this.state.move === null || most === 0 ? 1 : this.state.move / most;
  }

  setColour(mode) {
    this.state.colour = mode;
    this.paint();
    this.update();
  }

  toggle(name) {
    this.state.shown[name] = !this.state.shown[name];
    this.paint();
    this.update();
  }

  /** Gives every move its colour. */
  paint() {
    const { colour, shown } = this.state;
    const drawn = this.sides.filter((side) => side.route);
    const palette = new Palette(this.experiment.colours);
    let speedRange = null;
    if (colour === "speed") {
      for (const side of drawn) side.speeds = this.speedsOf(side);
      speedRange = rangeOf(drawn.map((side) => side.speeds));
    }
    for (const side of drawn) {
      side.pane.beads.setTints(
        palette.segmentTints(side.route, colour, {
          contenderColour: side.source.colour, speeds: side.speeds, speedRange,
        }),
      );
      side.pane.travels.setTints(palette.travelTints(side.route, shown));
    }
    this.legend = palette.legend(colour, drawn.map((side) => side.route), shown, {
      contenders: drawn.map((side) => side.source),
      speedRange,
      speedsAreModelled: drawn.every((side) => !side.route.segmentSpeed),
    });
  }

  speedsOf(side) {
    const { route } = side;
    if (route.segmentSpeed) return route.segmentSpeed;
    if (!route.modelled)
      route.modelled = modelledSpeeds(
        route, this.experiment.settings[this.state.setting].printer,
      );
    return route.modelled;
  }

  /** Puts the state on the stage and tells the page. */
  update() {
    const { state } = this;
    const level = this.levels[state.level];
    const share = this.moveShare();
    const whole = state.level === this.levels.length - 1 && state.move === null;
    this.sides.forEach((side, number) => {
      if (!side.route) return;
      side.shown = this.rangeFor(side.route, level, number, share);
      const { from, to, moves } = side.shown;
      side.pane.show(from, to, moves, state.shown, whole);
    });
    this.stage.request();
    this.onChange();
  }

  /** Places and moves of a route under the current sliders. */
  rangeFor(route, level, number, share) {
    if (!level) return { from: 0, to: -1, moves: 0, here: false };
    const slack = 1e-6;
    const first = this.levels[this.state.from].topMm - slack;
    const from = route.layers.findIndex((layer) => layer.topMm >= first);
    const here = level.places[number] >= 0;
    let to = level.places[number];
    if (!here)
      route.layers.forEach((layer, place) => {
        if (layer.topMm <= level.topMm && layer.topMm >= first) to = place;
      });
    const moves = here && to >= 0 ? Math.round(share * route.movesOf(to)) : Infinity;
    return { from: Math.max(0, from), to, moves, here };
  }

  /** From above, on the current layer ("top"), or from the side ("iso"). */
  look(from) {
    const level = this.levels[this.state.level];
    this.stage.look(from, level && level.topMm);
  }

  // ---- jumps ----

  /** Goes to the worst layer of a side under the metric; called again, to the next worst. */
  toWorst(number) {
    const side = this.sides[number];
    const metric = this.experiment.metrics[this.state.metric];
    if (!side || !side.scores || !metric) {
      this.say("There are no layer scores to look through.");
      return;
    }
    const better = metric.better === "higher" ? "higher" : "lower";
    const worst = worstLayers(side.scores, this.state.metric, better);
    const what = metric.better === "neither" ? "largest" : "worst";
    this.visit(`worst ${number} ${side.key}`, worst, number, (entry, rank) => {
      const nth = rank === 0 ? what : `${ordinal(rank + 1)} ${what}`;
      return `${side.source.name}: layer ${entry.index} is the ${nth} by ${metric.label}, ` +
        this.amount(entry.value);
    });
  }

  /** Goes to the layer where the sides differ most under the metric; again: to the next. */
  toDifference() {
    const [one, other] = this.sides;
    const metric = this.experiment.metrics[this.state.metric];
    if (!one || !other || !one.scores || !other.scores || !metric) {
      this.say("A difference needs a contender on either side.");
      return;
    }
    const theirs = other.scores.zMm;
    const column = this.state.metric;
    const found = [];
    let near = 0;
    const gap = (row, z) => Math.abs(theirs[row] - z);
    one.scores.indices.forEach((index, row) => {
      const z = one.scores.zMm[row];
      while (near + 1 < theirs.length && gap(near + 1, z) <= gap(near, z)) near++;
      if (theirs.length === 0 || gap(near, z) > 0.6 * this.heightMm()) return;
      const left = one.scores.columns[column][row];
      const right = other.scores.columns[column][near];
      if (Number.isNaN(left) || Number.isNaN(right)) return;
      found.push({ index, value: Math.abs(left - right), left, right });
    });
    found.sort((a, b) => b.value - a.value || a.index - b.index);
    this.visit(`difference ${one.key} ${other.key}`, found, 0, (entry) =>
      `Layer ${entry.index}: ${metric.label} ${this.amount(entry.left)} on the left, ` +
      `${this.amount(entry.right)} on the right`);
  }

  /** Goes to the next listed layer whose route was kept; says so if others come before it. */
  visit(key, entries, number, words) {
    const full = [
      key, this.state.metric, this.state.model, this.state.setting, this.state.seed,
    ].join(" ");
    if (this.visits.key !== full) this.visits = { key: full, next: 0 };
    if (entries.length === 0) {
      this.say("No layer has a value of this metric.");
      return;
    }
    const { route } = this.sides[number];
    const kept = new Map(route ? route.layers.map((layer, place) => [layer.index, place]) : []);
    const start = this.visits.next % entries.length;
    let rank = start;
    while (rank < entries.length && !kept.has(entries[rank].index)) rank++;
    if (rank === entries.length) {
      this.visits.next = 0;
      this.say(
        `${words(entries[start], start)}; its route was not kept. ` +
          `Run with keep_layers = "all" in [run] to see it.`,
      );
      return;
    }
    this.visits.next = rank + 1;
    const missed = rank > start
      ? ` ${words(entries[start], start)}, but its route was not kept.`
      : "";
    const place = kept.get(entries[rank].index);
    this.setLevel(this.levels.findIndex((level) => level.places[number] === place), { from: 0 });
    this.say(`${words(entries[rank], rank)}.${missed}`);
  }

  /** A value of the current metric with its unit. */
  amount(value) {
    const metric = this.experiment.metrics[this.state.metric];
    const unit = metric.layer_unit ? ` ${metric.layer_unit}` : "";
    return `${formatNumber(value / metric.layer_factor)}${unit}`;
  }

  say(message) {
    this.message = message;
    this.onChange();
  }

  // ---- links ----

  link() {
    const { state, experiment } = this;
    const level = this.levels[state.level];
    const name = (key) => {
      const source = this.sources().find((s) => s.key === key);
      return source ? source.name : "";
    };
    return {
      model: experiment.models[state.model],
      setting: experiment.settings.length > 1 ? experiment.settings[state.setting].name : null,
      a: name(state.a),
      b: name(state.b),
      seed: state.seed,
      layer: level ? level.index : null,
      from: level && state.from > 0 ? this.levels[state.from].index : null,
      move: state.move,
      colour: state.colour === "kind" ? null : state.colour,
      metric: experiment.metrics.length ? experiment.metrics[state.metric].name : null,
      hide: TOGGLES.filter((toggle) => !state.shown[toggle]).join(","),
      camera: this.stage.cameraPlace().map((v) => Number(v.toFixed(2))).join(","),
    };
  }

  /** Shows what a link asks for; what it does not name stays as it is. */
  async follow(link) {
    const { experiment, state } = this;
    const unknown = [];
    const find = (list, wanted, what, otherwise) => {
      if (wanted === undefined) return otherwise;
      const place = list.indexOf(wanted);
      if (place < 0) unknown.push(`${what} “${wanted}”`);
      return place < 0 ? otherwise : place;
    };
    const change = {
      model: find(experiment.models, link.model, "model", state.model),
      setting: find(experiment.settings.map((s) => s.name), link.setting, "setting", state.setting),
    };
    const sources = this.sources();
    for (const side of ["a", "b"]) {
      if (link[side] === undefined) {
        if (side === "b" && link.a !== undefined) change.b = "";
        continue;
      }
      const place = find(sources.map((s) => s.name), link[side], "contender", -1);
      if (place >= 0) change[side] = sources[place].key;
    }
    if (link.seed !== undefined) change.seed = link.seed;
    if (MODES.includes(link.colour)) change.colour = link.colour;
    const worst = /^worst:(.*)$/.exec(link.layer || "");
    const metricName = worst ? worst[1] : link.metric;
    change.metric = find(experiment.metrics.map((m) => m.name), metricName, "metric", state.metric);
    if (link.hide !== undefined || link.layer !== undefined) {
      const hidden = (link.hide || "").split(",");
      change.shown = Object.fromEntries(TOGGLES.map((name) => [name, !hidden.includes(name)]));
    }
    await this.choose(change, { keepCamera: true });
    this.message = "";
    if (worst) {
      this.visits.key = "";
      this.state.single = false;
      this.toWorst(0);
    } else if (link.layer !== undefined) {
      const wanted = Number(link.layer);
      const level = this.levelOfIndex(wanted);
      const from = link.from === undefined ? 0 : this.levelOfIndex(Number(link.from));
      this.state.single = from === level && from > 0;
      this.setLevel(level, { from });
      if (level >= 0 && this.levels[level].index !== wanted)
        this.message = `The route of layer ${wanted} was not kept; this is the nearest that was.`;
      if (link.move !== undefined) this.setMove(Number(link.move));
    }
    const camera = (link.camera || "").split(",").map(Number);
    if (camera.length === 6 && camera.every(Number.isFinite)) this.stage.setCameraPlace(camera);
    if (unknown.length) this.message = `This page has no ${unknown.join(" and no ")}.`;
    this.onChange();
  }
}

/** Smallest and largest of some arrays' values; null where there is none. */
function rangeOf(arrays) {
  let low = Infinity;
  let high = -Infinity;
  for (const array of arrays)
    for (const value of array) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  return low <= high ? [low, high] : null;
}

function ordinal(number) {
  const tens = number % 100;
  const ending = tens > 10 && tens < 14 ? "th" : ["th", "st", "nd", "rd"][number % 10] || "th";
  return `${number}${ending}`;
}
