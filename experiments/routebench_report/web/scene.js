// The picture: one canvas, a pane for each contender, one camera for all panes.

const VIEW_ANGLE = 28; // degrees; narrow, so that heights hardly shift what lies below
const FRAME_MS = 30; // what drawing may take at a time; what is left follows in the next frames
const FIRST_PART = 4000; // beads of the first frame, before it is known how fast the machine is
const LINES_FROM_MS = 600; // beads that would take longer than this are drawn as lines
const CROWD = 100; // more marks than these are drawn smaller
const TRAVEL_LIFT_MM = 0.06;

/** What a pane shows of one route. */
class Pane {
  constructor(route, heightMm, outlines) {
    this.route = route;
    this.heightMm = heightMm;
    this.beadScene = new THREE.Scene(); // drawn in parts
    this.scene = new THREE.Scene(); // all else
    this.ground = new THREE.Scene(); // stays where it is when the route is moved
    this.beads = new BeadMesh(heightMm);
    this.travels = new MoveMesh({
      heightMm: 0, leastPixels: 0.9, lift: TRAVEL_LIFT_MM, shade: 0, template: STRIP,
    });
    this.retractions = new Marks({ colour: RETRACTION_COLOUR });
    this.head = new Marks({ colour: "#ffffff", ring: true });
    this.beadScene.add(this.beads.setMoves(route.segments));
    this.scene.add(this.travels.setMoves(route.travels));
    this.scene.add(this.retractions.setPlaces(this.retractionPlaces()));
    this.scene.add(this.head.setPlaces(new Float32Array(3)));
    this.outlines = outlines;
    this.outlineOf = null;
    this.outlineLines = null;
  }

  /** Moves the route sideways onto the middle of another one. Returns by how much, mm. */
  moveOnto(other) {
    const middle = (box) => [0, 1].map((i) => (box.low[i] + box.high[i]) / 2);
    const [own, wanted] = [this.route.partBounds(), other.partBounds()];
    if (!own || !wanted) return [0, 0];
    const [from, to] = [middle(own), middle(wanted)];
    for (const scene of [this.scene, this.beadScene])
      scene.position.set(to[0] - from[0], to[1] - from[1], 0);
    return [to[0] - from[0], to[1] - from[1]];
  }

  /** Box around all that is laid, where it stands. */
  bounds() {
    const box = this.route.bounds();
    if (!box) return null;
    const shift = this.scene.position.toArray();
    return { low: box.low.map((v, i) => v + shift[i]), high: box.high.map((v, i) => v + shift[i]) };
  }

  /** Marks stand where the filament is pulled back: at the beginning of the travel. */
  retractionPlaces() {
    const { route } = this;
    const places = new GrowingArray(Float32Array, 64);
    this.retractedTravels = new GrowingArray(Uint32Array, 64);
    for (let t = 0; t < route.travelCount; t++) {
      if (!(route.travelFlags[t] & RETRACTED)) continue;
      const at = STRIDE * t;
      places.push(route.travels[at]);
      places.push(route.travels[at + 1]);
      places.push(route.travels[at + 4] + TRAVEL_LIFT_MM);
      this.retractedTravels.push(t);
    }
    return places.taken();
  }

  /**
   * Shows layers from one place to another, the last of them up to a number of moves. Layers below
   * the last one step back if so wished, but for their colours where the whole part is shown.
   */
  show(from, to, moves, shown, whole) {
    const { route } = this;
    if (to < 0) {
      for (const part of [this.beads, this.travels, this.retractions, this.head]) part.draw(0, 0);
      this.setOutline(-1);
      return;
    }
    const begin = route.start(Math.min(from, to));
    const end = route.after(to, moves);
    this.beads.draw(begin.segment, shown.strokes ? end.segment : begin.segment);
    const firstTravel = shown.fade ? route.start(to).travel : begin.travel;
    this.travels.draw(firstTravel, end.travel);
    const marks = this.retractedTravels.taken();
    const first = firstNotBelow(marks, firstTravel);
    this.retractions.draw(first, shown.retractions ? firstNotBelow(marks, end.travel) : first);
    const top = route.layers[to].topMm;
    this.beads.material.uniforms.fadeBelow.value = shown.fade && !whole ? top - 1e-3 : -1e9;
    const nozzle = moves < route.movesOf(to) ? route.nozzle(to, moves) : null;
    this.head.draw(0, nozzle ? 1 : 0);
    if (nozzle) {
      this.head.geometry.attributes.position.array.set([nozzle.x, nozzle.y, nozzle.z]);
      this.head.geometry.attributes.position.needsUpdate = true;
    }
    this.setOutline(shown.outline ? to : -1);
  }

  setOutline(place) {
    if (place === this.outlineOf) return;
    this.outlineOf = place;
    if (this.outlineLines) {
      this.scene.remove(this.outlineLines);
      this.outlineLines.geometry.dispose();
      this.outlineLines = null;
    }
    const layer = place >= 0 && this.route.layers[place];
    const shape = layer && this.outlines && this.outlines.get(layer.index);
    if (!shape) return;
    const ends = [];
    for (const ring of shape.rings)
      for (let i = 0, j = ring.length - 2; i < ring.length; j = i, i += 2)
        ends.push(ring[j], ring[j + 1], layer.topMm, ring[i], ring[i + 1], layer.topMm);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(ends), 3));
    this.outlineLines = new THREE.LineSegments(
      geometry, new THREE.LineBasicMaterial({ color: 0x8a8a8a }),
    );
    this.outlineLines.frustumCulled = false;
    this.scene.add(this.outlineLines);
  }

  dispose() {
    for (const part of [this.beads, this.travels, this.retractions, this.head]) part.dispose();
    this.setOutline(-1);
  }
}

function firstNotBelow(sorted, value) {
  let low = 0;
  let high = sorted.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The canvas. It draws when something has changed, and not otherwise. */
class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({
      canvas, antialias: true, preserveDrawingBuffer: true,
    });
    this.renderer.setScissorTest(true);
    this.renderer.autoClear = false;
    this.background = new THREE.Color("#f6f7f8");
    this.camera = new THREE.PerspectiveCamera(VIEW_ANGLE, 1, 0.5, 5000);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.zoomSpeed = 1.3;
    this.controls.addEventListener("change", () => this.request());
    this.panes = [];
    this.forgetSpeeds();
    this.complete = false; // whether all that is to be seen has been drawn
    this.box = { low: [0, 0, 0], high: [10, 10, 10] };
    this.pending = false;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  setPanes(panes) {
    for (const pane of this.panes) pane.dispose();
    this.panes = panes;
    this.forgetSpeeds();
    const boxes = panes.map((pane) => pane.bounds()).filter(Boolean);
    if (boxes.length > 0)
      this.box = {
        low: [0, 1, 2].map((i) => Math.min(...boxes.map((box) => box.low[i]))),
        high: [0, 1, 2].map((i) => Math.max(...boxes.map((box) => box.high[i]))),
      };
    for (const pane of panes) pane.ground.add(this.plate());
    this.request();
  }

  /** Lines 10 mm apart under the part. */
  plate() {
    const step = 10;
    const [x0, y0] = this.box.low.map((v) => Math.floor(v / step - 0.5) * step);
    const [x1, y1] = this.box.high.map((v) => Math.ceil(v / step + 0.5) * step);
    const ends = [];
    const most = 400; // a part as large as a house needs no grid
    if ((x1 - x0 + y1 - y0) / step < most) {
      for (let x = x0; x <= x1; x += step) ends.push(x, y0, 0, x, y1, 0);
      for (let y = y0; y <= y1; y += step) ends.push(x0, y, 0, x1, y, 0);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(ends), 3));
    return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0xd9dcdf }));
  }

  /** Looks at the whole part: "top", from above on what is at a height, or "iso". */
  look(from, heightMm) {
    const { low, high } = this.box;
    const centre = low.map((v, i) => (v + high[i]) / 2);
    const size = low.map((v, i) => high[i] - v);
    const aspect = this.paneAspect();
    const reach = 1 / Math.tan((VIEW_ANGLE * Math.PI) / 360);
    const target = new THREE.Vector3(...centre);
    if (from === "top") {
      target.z = heightMm === undefined ? high[2] : heightMm;
      const away = (Math.max(size[1], size[0] / aspect) / 2) * 1.12 * reach;
      this.camera.position.set(centre[0], centre[1] - away * 1e-3, target.z + away);
    } else {
      const way = new THREE.Vector3(0.42, -0.78, 0.62).normalize();
      const across = new THREE.Vector3(0, 0, 1).cross(way).normalize();
      const upright = way.clone().cross(across);
      // As near as all corners of the box are still seen from.
      let away = 1;
      for (let corner = 0; corner < 8; corner++) {
        const to = new THREE.Vector3(...size.map((s, i) => (corner & (1 << i) ? s : -s) / 2));
        const wide = (Math.abs(to.dot(across)) * reach) / aspect;
        const tall = Math.abs(to.dot(upright)) * reach;
        away = Math.max(away, to.dot(way) + Math.max(wide, tall) * 1.15);
      }
      this.camera.position.copy(target).add(way.multiplyScalar(away));
    }
    this.controls.target.copy(target);
    this.controls.update();
    this.request();
  }

  paneAspect() {
    const width = this.canvas.clientWidth / Math.max(1, this.panes.length);
    return width / Math.max(1, this.canvas.clientHeight) || 1;
  }

  /** Six numbers: where the camera is and what it looks at. */
  cameraPlace() {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()];
  }

  setCameraPlace(numbers) {
    this.camera.position.fromArray(numbers);
    this.controls.target.fromArray(numbers, 3);
    this.controls.update();
    this.request();
  }

  resize() {
    const frame = this.canvas.parentElement;
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.renderer.setSize(frame.clientWidth, frame.clientHeight, false);
    this.request();
  }

  /** Draws anew, soon. */
  request() {
    this.complete = false;
    this.restart = true;
    this.schedule();
  }

  schedule() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.render();
    });
  }

  /**
   * Draws what the time of a frame allows, the uppermost beads first. The next frames add the
   * others below, unless there is something new to draw by then.
   */
  render() {
    if (this.canvas.clientWidth === 0 || this.canvas.clientHeight === 0) return;
    if (this.restart) {
      this.restart = false;
      this.begin();
    }
    const begin = performance.now();
    const kind = this.kindOfBeads();
    const known = this.msPerBead[kind];
    const room = known > 0 ? Math.max(500, FRAME_MS / known) : FIRST_PART;
    let drawn = 0;
    this.panes.forEach((pane, i) => {
      const { beads } = pane;
      const first = Math.max(beads.first, Math.floor(pane.undrawn - room / this.panes.length));
      beads.drawPart(first, pane.undrawn, kind === "line");
      drawn += pane.undrawn - first;
      pane.undrawn = first;
      this.aim(i);
      this.renderer.render(pane.beadScene, this.camera);
    });
    const left = this.undrawn();
    if (drawn + left > FIRST_PART) this.measure(kind, drawn, begin);
    this.complete = left === 0;
    if (!this.complete) this.schedule();
  }

  /** An empty canvas, and on it all but the beads. */
  begin() {
    const { renderer, camera } = this;
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    const size = Math.hypot(...this.box.low.map((v, i) => this.box.high[i] - v));
    const away = camera.position.distanceTo(this.controls.target);
    camera.near = Math.max(0.01, (away - size) / 20, away / 400);
    camera.far = away + 4 * size + 100;
    camera.aspect = this.paneAspect();
    camera.updateProjectionMatrix();
    const pixel = (2 * Math.tan((VIEW_ANGLE * Math.PI) / 360)) / height;
    renderer.setScissor(0, 0, width, height);
    renderer.setViewport(0, 0, width, height);
    renderer.setClearColor(this.background);
    renderer.clear();
    this.panes.forEach((pane, i) => {
      pane.beads.material.uniforms.pixel.value = pixel;
      pane.travels.material.uniforms.pixel.value = pixel;
      const few = pane.retractions.shown <= CROWD;
      pane.retractions.setPixels((few ? 11 : 7) * renderer.getPixelRatio());
      pane.head.setPixels(17 * renderer.getPixelRatio());
      pane.undrawn = pane.beads.last;
      this.aim(i);
      renderer.render(pane.ground, camera);
      renderer.render(pane.scene, camera);
    });
  }

  /** Draws into one of the panes from here on. */
  aim(number) {
    const width = this.canvas.clientWidth / this.panes.length;
    const height = this.canvas.clientHeight;
    this.renderer.setViewport(number * width, 0, width, height);
    this.renderer.setScissor(number * width, 0, width, height);
  }

  /** Beads that the current picture still lacks. */
  undrawn() {
    return this.panes.reduce((sum, pane) => sum + pane.undrawn - pane.beads.first, 0);
  }

  kindOfBeads() {
    const total = this.panes.reduce((sum, { beads }) => sum + beads.last - beads.first, 0);
    return total * this.msPerBead.roof > LINES_FROM_MS ? "line" : "roof";
  }

  /** Milliseconds a bead takes, as measured; 0 where that is not known. */
  forgetSpeeds() {
    this.msPerBead = { roof: 0, line: 0 };
    this.warm = { roof: false, line: false };
  }

  /** Learns how fast the machine draws: waits for it to be done. */
  measure(kind, beads, begin) {
    if (beads === 0) return;
    if (!this.warm[kind]) {
      // The first time the arrays go to the card as well.
      this.warm[kind] = true;
      return;
    }
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    const now = (performance.now() - begin) / beads;
    const before = this.msPerBead[kind];
    this.msPerBead[kind] = Math.max(1e-7, before > 0 ? (before + now) / 2 : now);
  }
}
