// The viewer's elements: selects, sliders, keys, dropped files.

class Controls {
  /** `wholePage`: keys count wherever the focus is, not only in the viewer. */
  constructor(experiment, { wholePage }) {
    this.root = document.getElementById("viewer");
    this.experiment = experiment;
    this.stage = new Stage(this.get("canvas"));
    this.viewer = new Viewer(experiment, this.stage, () => this.refresh());
    this.chart = new LayerChart(this.get("chart"), (zMm) => {
      this.viewer.message = "";
      this.viewer.setLevel(this.viewer.nearest((level) => Math.abs(level.zMm - zMm)));
    });
    this.playing = false;
    this.wireSelects();
    this.wireSliders();
    this.wireButtons();
    this.wireFiles();
    (wholePage ? document : this.root).addEventListener("keydown", (event) => this.key(event));
    this.wireCanvas(wholePage);
    this.stage.controls.addEventListener("end", () => this.refresh());
  }

  get(name) {
    return document.getElementById(`v-${name}`);
  }

  on(name, event, act) {
    this.get(name).addEventListener(event, act);
  }

  /** Within a longer page the wheel scrolls that, until the picture has been clicked. */
  wireCanvas(wholePage) {
    const canvas = this.get("canvas");
    canvas.addEventListener("pointerdown", () => canvas.focus());
    const held = (event) => {
      if (!wholePage && document.activeElement !== canvas) event.stopPropagation();
    };
    canvas.parentElement.addEventListener("wheel", held, { capture: true, passive: true });
  }

  wireSelects() {
    const { experiment, viewer } = this;
    fill(this.get("model"), experiment.shortNames.map((name, i) => [i, name]));
    fill(this.get("setting"), experiment.settings.map(({ name }, i) => [i, name || "default"]));
    fill(this.get("colour"), MODES.map((mode) => [mode, MODE_WORDS[mode]]));
    fill(this.get("metric"), experiment.metrics.map(({ label }, i) => [i, label]));
    const load = (change) => this.busy(() => viewer.choose(change));
    this.on("model", "change", (e) => load({ model: Number(e.target.value), seed: null }));
    this.on("setting", "change", (e) => load({ setting: Number(e.target.value), seed: null }));
    this.on("seed", "change", (e) => load({ seed: e.target.value }));
    this.on("a", "change", (e) => load({ a: e.target.value }));
    this.on("b", "change", (e) => load({ b: e.target.value }));
    this.on("colour", "change", (e) => viewer.setColour(e.target.value));
    this.on("metric", "change", (e) => {
      viewer.state.metric = Number(e.target.value);
      viewer.say("");
    });
  }

  wireSliders() {
    const { viewer } = this;
    const slide = (name, act) =>
      this.on(name, "input", (event) => {
        viewer.message = "";
        act(Number(event.target.value));
      });
    slide("layer", (value) => viewer.setLevel(value));
    slide("from", (value) => viewer.setFrom(value));
    slide("move", (value) => {
      this.stop();
      viewer.setMove(value);
    });
    this.on("single", "change", (event) => viewer.setSingle(event.target.checked));
    for (const name of TOGGLES) this.on(name, "change", () => viewer.toggle(name));
  }

  wireButtons() {
    const { viewer, stage } = this;
    const click = (name, act) => this.on(name, "click", act);
    click("swap", () => this.swap());
    click("worst", () => viewer.toWorst(0));
    click("difference", () => viewer.toDifference());
    click("top", () => this.look("top"));
    click("iso", () => this.look("iso"));
    click("full", () => this.fillWindow());
    click("help", () => this.get("keys").showModal());
    click("play", () => this.togglePlay());
    click("open", () => this.get("file").click());
  }

  look(from) {
    this.viewer.look(from);
    this.refresh();
  }

  swap() {
    const { a, b } = this.viewer.state;
    if (b !== "") this.busy(() => this.viewer.choose({ a: b, b: a }));
  }

  fillWindow() {
    const full = this.root.classList.toggle("full");
    document.body.classList.toggle("covered", full);
    this.get("full").textContent = full ? "Back" : "Full";
  }

  wireFiles() {
    const cover = this.get("drop");
    const holdsFiles = ({ dataTransfer }) =>
      dataTransfer && [...dataTransfer.types].includes("Files");
    document.addEventListener("dragover", (event) => {
      if (!holdsFiles(event)) return;
      event.preventDefault();
      cover.hidden = false;
    });
    document.addEventListener("dragleave", (event) => {
      if (event.relatedTarget === null) cover.hidden = true;
    });
    document.addEventListener("drop", (event) => {
      if (!holdsFiles(event)) return;
      event.preventDefault();
      cover.hidden = true;
      this.openFiles(event.dataTransfer.files);
    });
    this.on("file", "change", (event) => {
      this.openFiles(event.target.files);
    });
  }

  openFiles(files) {
    return this.busy(async () => {
      for (const file of [...files].slice(0, 2)) await this.openText(file.name, await file.text());
      this.root.scrollIntoView({ block: "start" });
    });
  }

  /** Shows G-code on the right, or on the left if nothing is there. */
  async openText(name, text) {
    const { viewer } = this;
    let route;
    try {
      route = readGcode(name, text);
    } catch (error) {
      viewer.say(`${name}: ${error.message}`);
      return;
    }
    const first = viewer.sides.length === 0;
    viewer.addFile(route);
    await viewer.choose({}, { keepCamera: !first });
    viewer.say(
      `${name}: ${formatNumber(route.segmentCount)} segments in ${route.layers.length} layers.`,
    );
  }

  /** Runs what may take a while, and says so meanwhile. */
  async busy(work) {
    this.stop();
    this.viewer.message = "";
    const sign = setTimeout(() => { this.get("busy").hidden = false; }, 120);
    try {
      await work();
    } catch (error) {
      console.error(error);
      this.viewer.say(`This could not be shown: ${error.message}`);
    } finally {
      clearTimeout(sign);
      this.get("busy").hidden = true;
    }
  }

  // ---- playing ----

  togglePlay() {
    if (this.playing) {
      this.stop();
      return;
    }
    const { viewer } = this;
    this.playing = true;
    this.showPlaying();
    if (viewer.state.move === null) viewer.setMove(0);
    let before = performance.now();
    let exact = viewer.state.move || 0;
    const step = (now) => {
      if (!this.playing) return;
      exact += ((now - before) / 1000) * Number(this.get("pace").value);
      before = now;
      if (exact >= viewer.moveCount()) {
        if (viewer.state.level + 1 >= viewer.levels.length) {
          viewer.setMove(Infinity);
          this.stop();
          return;
        }
        viewer.setLevel(viewer.state.level + 1);
        exact = 0;
      }
      viewer.setMove(Math.floor(exact));
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  stop() {
    this.playing = false;
    this.showPlaying();
  }

  showPlaying() {
    this.get("play").textContent = this.playing ? "■ Stop" : "▶ Play";
    this.get("play").setAttribute("aria-pressed", String(this.playing));
  }

  // ---- keys ----

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || this.get("keys").open) return;
    const { target } = event;
    const tag = target.tagName;
    const isText = tag === "INPUT" && !["range", "checkbox"].includes(target.type);
    if (tag === "SELECT" || isText) return;
    // Sliders, boxes and buttons have their own use for these.
    const ownKeys = tag === "INPUT" && target.type === "range"
      ? ["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight", "Home", "End"]
      : tag === "INPUT" || tag === "BUTTON" || tag === "A" ? [" ", "Enter"] : [];
    if (ownKeys.includes(event.key)) return;
    const act = this.actionOf(event);
    if (!act) return;
    event.preventDefault();
    if (!event.key.startsWith("Arrow") && event.key !== " ") this.viewer.message = "";
    act();
  }

  actionOf(event) {
    const { viewer } = this;
    const { state } = viewer;
    const step = event.shiftKey ? 10 : 1;
    const move = () => (state.move === null ? viewer.moveCount() : state.move);
    switch (event.key) {
      case "ArrowUp": return () => viewer.setLevel(state.level + step);
      case "ArrowDown": return () => viewer.setLevel(state.level - step);
      case "ArrowLeft": return () => { this.stop(); viewer.setMove(move() - step); };
      case "ArrowRight": return () => { this.stop(); viewer.setMove(move() + step); };
      case "Home": return () => viewer.setLevel(0);
      case "End": return () => viewer.setLevel(viewer.levels.length - 1);
      case " ": return () => this.togglePlay();
      case "w": return () => viewer.toWorst(0);
      case "W": return () => viewer.toWorst(1);
      case "d": return () => viewer.toDifference();
      case "s": return () => viewer.setSingle(!state.single);
      case "c": return () => viewer.setColour(nextOf(MODES, state.colour));
      case "x": return () => this.swap();
      case "t": return () => this.look("top");
      case "i": return () => this.look("iso");
      case "m": return () => this.fillWindow();
      case "?": return () => this.get("keys").showModal();
      default: {
        const toggle = TOGGLES[Number(event.key) - 1];
        return toggle ? () => viewer.toggle(toggle) : null;
      }
    }
  }

  // ---- what is shown ----

  refresh() {
    const { viewer, experiment } = this;
    const { state, levels } = viewer;
    const level = levels[state.level];
    const sources = viewer.sources().map(({ key, name }) => [key, name]);
    fill(this.get("a"), sources.length ? sources : [["", "nothing yet"]], state.a);
    fill(this.get("b"), [["", "nothing"], ...sources], state.b);
    this.get("model").value = state.model;
    this.get("model").title = experiment.models[state.model] || "";
    this.get("setting").value = state.setting;
    this.get("colour").value = state.colour;
    this.get("metric").value = state.metric;
    const seeds = state.a[0] === "c"
      ? experiment.cellsOf(state.setting, state.model, Number(state.a.slice(1))).map((c) => c.seed)
      : [];
    fill(this.get("seed"), seeds.map((seed) => [seed, seed]), state.seed || seeds[0]);
    this.showField("model", experiment.models.length > 0);
    this.showField("setting", experiment.settings.length > 1);
    this.showField("seed", seeds.length > 1);
    for (const name of TOGGLES) this.get(name).checked = state.shown[name];
    this.get("difference").disabled = viewer.sides.length < 2;
    this.get("swap").disabled = viewer.sides.length < 2;

    const last = Math.max(0, levels.length - 1);
    const lowest = levels[state.from];
    setSlider(this.get("layer"), last, state.level, level ? this.layerWords(level) : "");
    setSlider(this.get("from"), last, state.from, lowest ? this.layerWords(lowest) : "");
    this.get("layer-text").textContent = level
      ? `${this.layerWords(level)} (${state.level + 1} of ${levels.length})`
      : "none";
    this.get("from-text").textContent = lowest ? String(lowest.index) : "";
    this.get("single").checked = state.single;
    const most = viewer.moveCount();
    const move = state.move === null ? most : state.move;
    setSlider(this.get("move"), most, move, `${move} of ${most}`);
    this.get("move-text").textContent = `${formatNumber(move)} of ${formatNumber(most)}`;

    this.showLabels(level);
    this.showLegend();
    this.showChart(level);
    this.get("status").textContent = viewer.message;
    this.get("kept").textContent = this.keptWords();
    this.remember();
  }

  layerWords(level) {
    return `${level.index}, z ${formatNumber(level.zMm)} mm`;
  }

  showField(name, shown) {
    this.root.querySelector(`[data-for="${name}"]`).hidden = !shown;
  }

  /** Over each pane: whose route it is, and what it adds up to so far. */
  showLabels() {
    const { viewer } = this;
    const labels = this.get("labels");
    const drawn = viewer.sides.filter((side) => side.pane).length;
    labels.replaceChildren(
      ...viewer.sides.map((side) => {
        const box = element("div", { className: side.pane ? "label" : "label absent" });
        const name = element("strong", { textContent: side.source.name });
        name.style.borderColor = side.source.colour;
        box.append(name);
        if (side.cell && side.cell.outcome !== "valid")
          box.append(element("span", {
            className: `outcome ${side.cell.outcome}`,
            textContent: side.cell.outcome_words,
            title: side.cell.reason,
          }));
        box.append(element("span", { className: "sums", textContent: this.sumWords(side) }));
        return box;
      }),
    );
    labels.style.setProperty("--panes", Math.max(1, drawn));
  }

  sumWords(side) {
    if (!side.route) return side.why;
    if (!side.shown || !side.shown.here) return "has no such layer here";
    const { to, moves } = side.shown;
    const sum = side.route.tally(to, moves);
    const words = [
      `laid ${formatNumber(sum.extrudeMm)} mm`,
      `travel ${formatNumber(sum.travelMm)} mm in ${sum.travels}`,
      counted(sum.retractions, "retraction"),
    ];
    if (side.route.knowsCrossings) words.push(counted(sum.crossings, "crossing"));
    if (side.moved && Math.hypot(...side.moved) > 0.1)
      words.push(`shown moved by ${side.moved.map((v) => v.toFixed(1)).join(", ")} mm`);
    return words.join(" · ");
  }

  showLegend() {
    this.get("legend").replaceChildren(
      ...(this.viewer.legend || []).map((entry) => {
        const line = element("div", { className: "entry" });
        if (entry.shape === "ramp") {
          const bar = element("span", { className: "ramp" });
          bar.style.background = rampCss();
          line.append(entry.from, bar, entry.to);
        } else {
          const mark = element("span", { className: `mark ${entry.shape}` });
          mark.style.color = entry.colour;
          line.append(mark, entry.words);
        }
        return line;
      }),
    );
  }

  showChart(level) {
    const { viewer, experiment } = this;
    const { state } = viewer;
    const metric = experiment.metrics[state.metric];
    const scored = metric ? viewer.sides.filter((side) => side.scores) : [];
    this.get("chart-label").textContent = metric ? metric.label : "";
    this.get("chart-label").title = metric ? `${metric.meaning}; a click goes to the layer` : "";
    this.chart.show(
      scored.map((side) => ({
        colour: side.source.colour,
        zMm: side.scores.zMm,
        values: side.scores.columns[state.metric],
      })),
      {
        cursor: level ? level.zMm : null,
        from: level ? viewer.levels[state.from].zMm : null,
        kept: viewer.levels.map(({ zMm }) => zMm),
      },
    );
    const here = level
      ? scored.map((side) => {
          const place = level.places[viewer.sides.indexOf(side)];
          const row = place < 0 ? -1 : side.scores.indices.indexOf(side.route.layers[place].index);
          const value = row < 0 ? NaN : side.scores.columns[state.metric][row];
          return Number.isNaN(value) ? "n/a" : viewer.amount(value);
        })
      : [];
    this.get("chart-values").textContent = here.join(" | ");
  }

  /** How many layers can be looked at, and how to have all of them. */
  keptWords() {
    const cells = this.viewer.sides.map((side) => side.cell).filter(Boolean);
    const total = Math.max(0, ...cells.map((cell) => cell.layer_count));
    const kept = Math.max(0, ...cells.map((cell) => cell.kept || 0));
    if (cells.length === 0 || kept >= total) return "";
    return `Routes of ${kept} of ${total} layers were kept. keep_layers = "all" in [run], and a ` +
      "run with --fresh, keeps them all.";
  }

  /** Puts what is shown into the address, once it has come to rest. */
  remember() {
    if (!this.ready) return;
    clearTimeout(this.remembering);
    this.remembering = setTimeout(() => this.writeAddress(), 200);
  }

  writeAddress() {
    const hash = writeLink(this.viewer.link());
    if (hash !== location.hash) history.replaceState(null, "", hash);
  }
}

function nextOf(list, entry) {
  return list[(list.indexOf(entry) + 1) % list.length];
}

function counted(number, noun) {
  return `${formatNumber(number)} ${noun}${number === 1 ? "" : "s"}`;
}

function element(tag, properties) {
  return Object.assign(document.createElement(tag), properties);
}

/** Gives a select its options, if they are others than it has, and chooses one. */
function fill(select, options, chosen) {
  const words = JSON.stringify(options);
  if (select.dataset.options !== words) {
    select.dataset.options = words;
    select.replaceChildren(
      ...options.map(([value, text]) => element("option", { value, textContent: text })),
    );
  }
  if (chosen !== undefined) select.value = chosen;
}

function setSlider(slider, most, value, words) {
  slider.max = most;
  slider.value = value;
  slider.setAttribute("aria-valuetext", words);
}
