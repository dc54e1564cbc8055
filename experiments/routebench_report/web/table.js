// The table of all cells: sorted by any column, filtered by words, every figure a link to the layer
// behind it.

class CellTable {
  constructor(experiment, root) {
    this.experiment = experiment;
    this.root = root;
    this.filter = root.querySelector("input[type=search]");
    this.all = root.querySelector("input[type=checkbox]");
    this.count = root.querySelector("output");
    this.table = root.querySelector("table");
    this.sorted = { column: 0, down: false };
    this.filter.addEventListener("input", () => this.draw());
    this.all.addEventListener("change", () => this.draw());
    this.draw();
  }

  columns() {
    const { experiment } = this;
    const { cells } = experiment;
    const text = (title, of) => ({ title, of, number: false });
    const columns = [text("Model", (cell) => experiment.shortNames[cell.model])];
    if (experiment.settings.length > 1)
      columns.push(text("Setting", (cell) => experiment.settings[cell.setting].name));
    columns.push(text("Contender", (cell) => experiment.contenders[cell.contender].name));
    if (new Set(cells.map((cell) => cell.seed)).size > 1)
      columns.push({ title: "Seed", of: (cell) => Number(cell.seed), number: true, plain: true });
    columns.push(text("Outcome", (cell) => cell.outcome_words));
    experiment.metrics.forEach((metric, i) => {
      if (!this.all.checked && !metric.of_interest) return;
      if (cells.every((cell) => cell.scores[i] === null)) return;
      const arrow = { lower: "↓", higher: "↑" }[metric.better] || "";
      columns.push({
        title: metric.label,
        unit: [metric.unit && `[${metric.unit}]`, arrow].filter(Boolean).join(" "),
        hint: metric.meaning,
        of: (cell) => (cell.scores[i] === null ? NaN : cell.scores[i] / metric.factor),
        number: true,
        metric,
      });
    });
    return columns;
  }

  rows(columns) {
    const wanted = this.filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const texts = columns.filter((column) => !column.number);
    const rows = this.experiment.cells.filter((cell) => {
      const words = `${texts.map(({ of }) => of(cell)).join(" ")} ${cell.reason}`.toLowerCase();
      return wanted.every((word) => words.includes(word));
    });
    const { of, number } = columns[Math.min(this.sorted.column, columns.length - 1)];
    const sign = this.sorted.down ? -1 : 1;
    return rows.sort((one, other) => {
      const [a, b] = [of(one), of(other)];
      if (!number) return sign * a.localeCompare(b, "en", { numeric: true });
      // What has no value comes last, whichever way.
      if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
      return sign * (a - b);
    });
  }

  draw() {
    const columns = this.columns();
    const rows = this.rows(columns);
    this.count.textContent = `${rows.length} of ${this.experiment.cells.length} cells`;
    const head = element("tr", {});
    columns.forEach((column, i) => head.append(this.headOf(column, i)));
    const body = element("tbody", {});
    for (const cell of rows) {
      const row = element("tr", { className: cell.outcome === "valid" ? "" : "invalid" });
      for (const column of columns) row.append(this.entry(column, cell));
      body.append(row);
    }
    const thead = element("thead", {});
    thead.append(head);
    this.table.replaceChildren(thead, body);
  }

  headOf(column, i) {
    const sorted = this.sorted.column === i;
    const head = element("th", { scope: "col", className: column.number ? "number" : "" });
    if (sorted) head.setAttribute("aria-sort", this.sorted.down ? "descending" : "ascending");
    const button = element("button", { type: "button", textContent: column.title });
    if (column.hint) button.title = column.hint;
    if (column.unit)
      button.append(element("span", { className: "unit", textContent: ` ${column.unit}` }));
    button.addEventListener("click", () => {
      this.sorted = { column: i, down: sorted && !this.sorted.down };
      this.draw();
      this.table.querySelectorAll("th button")[i].focus();
    });
    head.append(button);
    return head;
  }

  entry(column, cell) {
    const value = column.of(cell);
    const place = element("td", { className: column.number ? "number" : "" });
    if (column.title === "Outcome") {
      place.append(element("span", {
        className: `outcome ${cell.outcome}`, textContent: value, title: cell.reason,
      }));
      return place;
    }
    if (!column.number) {
      place.append(element("a", { href: this.linkTo(cell, null), textContent: value }));
      return place;
    }
    if (column.plain || Number.isNaN(value)) {
      place.textContent = column.plain ? cell.seed : "n/a";
      return place;
    }
    place.append(element("a", {
      href: this.linkTo(cell, column.metric),
      textContent: formatNumber(value),
      title: `${column.title} of ${this.experiment.contenders[cell.contender].name}: ` +
        "show the layer that counts most",
    }));
    return place;
  }

  /** To the cell in the viewer, at the worst layer of a metric if one is given. */
  linkTo(cell, metric) {
    const { experiment } = this;
    return writeLink({
      model: experiment.models[cell.model],
      setting: experiment.settings.length > 1 ? experiment.settings[cell.setting].name : null,
      a: experiment.contenders[cell.contender].name,
      seed: cell.seed,
      layer: metric ? `worst:${metric.name}` : null,
    });
  }
}
