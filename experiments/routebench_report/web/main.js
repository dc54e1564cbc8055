// Starts the page: reads its data, shows what the address asks for, or what there is.

/** The cells that a page shows first: two valid contenders with the most kept layers. */
function firstChoice(experiment) {
  const setting = 0;
  const of = (model) =>
    experiment.cells
      .filter((cell) => cell.setting === setting && cell.model === model && cell.route)
      .sort((one, other) => (other.outcome === "valid") - (one.outcome === "valid"));
  let model = experiment.models.findIndex((_, i) => of(i).length > 0);
  if (model < 0) model = 0;
  const keys = [...new Set(of(model).map((cell) => `c${cell.contender}`))];
  if (keys.length === 0 && experiment.contenders.length > 0) keys.push("c0");
  return { setting, model, a: keys[0] || "", b: keys[1] || "" };
}

async function start() {
  const experiment = new Experiment(JSON.parse(document.getElementById("data").textContent));
  const tableRoot = document.getElementById("table");
  if (tableRoot) new CellTable(experiment, tableRoot);
  wireFigures();
  if (typeof WebGLRenderingContext === "undefined" || !canDraw()) {
    document.getElementById("viewer").replaceChildren(
      element("p", { className: "absent", textContent:
        "The route viewer needs WebGL, which this browser does not offer or has switched off. " +
        "All other parts of the page work without it." }),
    );
    return;
  }
  const controls = new Controls(experiment, { wholePage: experiment.viewer_only });
  const { viewer } = controls;
  // For scripts, and for those who are curious.
  window.routebench = { experiment, viewer, stage: viewer.stage, readGcode, modelledSpeeds };
  const travel = experiment.metrics.findIndex(({ name }) => name === "travel_mm");
  viewer.state.metric = Math.max(0, travel);

  const followLink = (link) =>
    controls.busy(async () => {
      await viewer.follow(link);
      controls.root.scrollIntoView({ block: "start" });
    });
  const link = readLink(location.hash);
  await controls.busy(async () => {
    if (experiment.gcode) {
      const { name, block } = experiment.gcode;
      const text = new TextDecoder().decode(await unpackedBlock(block));
      await controls.openText(name, text);
    } else {
      await viewer.choose(firstChoice(experiment), { keepCamera: false });
    }
  });
  if (link) await followLink(link);
  controls.ready = true;
  window.addEventListener("hashchange", () => {
    const wanted = readLink(location.hash);
    if (wanted) followLink(wanted);
  });
  performance.mark("ready");
  document.documentElement.dataset.ready = "yes";
}

function canDraw() {
  const canvas = document.createElement("canvas");
  return Boolean(canvas.getContext("webgl") || canvas.getContext("experimental-webgl"));
}

/** A click on a figure shows it as large as the window allows. */
function wireFigures() {
  const dialog = document.getElementById("large-figure");
  if (!dialog) return;
  for (const button of document.querySelectorAll(".figure button"))
    button.addEventListener("click", () => {
      dialog.querySelector("img").src = button.querySelector("img").src;
      dialog.querySelector("img").alt = button.querySelector("img").alt;
      dialog.showModal();
    });
  dialog.addEventListener("click", () => dialog.close());
}

start();
