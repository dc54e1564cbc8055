// Beads and travels as three.js meshes. One small template is drawn once for every move by the
// graphics card, from the route's own arrays; scrubbing only changes which part of them is drawn.
// Where that is too slow, beads are lines.

const BEAD_VERTEX = `
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform float height;       // of a bead, mm
uniform float pixel;        // mm that a pixel spans at a distance of 1 mm
uniform float leastPixels;  // half of the width that is always seen, more for what is opaque
uniform float lift;         // mm above the layer
uniform float fadeBelow;    // what lies below this height steps back
attribute vec3 position;    // of a corner: end, side, beyond the end
attribute vec4 path;
attribute vec2 size;        // height of the top, width
attribute vec4 tint;
varying vec3 colour;
varying vec3 normal;
void main() {
  if (tint.a == 0.0) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    return;
  }
  vec2 way = path.zw - path.xy;
  float run = length(way);
  vec2 along = run > 0.0 ? way / run : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  vec2 centre = mix(path.xy, path.zw, position.x);
  float away = -(modelViewMatrix * vec4(centre, size.x, 1.0)).z;
  float half_width = max(size.y * 0.5, leastPixels * (0.4 + tint.a) * pixel * away);
  vec2 outward = across * position.y + along * position.z;
  float edge = abs(position.y) + abs(position.z) > 0.0 ? 1.0 : 0.0;
  vec3 place = vec3(centre + outward * half_width, size.x - edge * height * 0.5 + lift);
  normal = normalize(vec3(outward, edge > 0.0 ? 0.55 : 1.0));
  colour = tint.rgb;
  if (size.x < fadeBelow) colour = mix(colour, vec3(0.87, 0.885, 0.9), 0.72);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(place, 1.0);
}`;

const BEAD_FRAGMENT = `
precision mediump float;
uniform float shade;
varying vec3 colour;
varying vec3 normal;
void main() {
  vec3 n = normalize(normal);
  float light = max(0.0, dot(n, normalize(vec3(-0.45, -0.55, 0.85))));
  gl_FragColor = vec4(colour * mix(1.0, 0.5 + 0.62 * light, shade), 1.0);
}`;

/** Like a roof: a ridge, two sides, a hip at either end. */
const ROOF = {
  corners: [
    [0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, -1, 0], [1, -1, 0], [0, 0, -1], [1, 0, 1],
  ],
  triangles: [
    [0, 1, 3], [0, 3, 2], [0, 4, 5], [0, 5, 1], [6, 0, 2], [6, 4, 0], [7, 3, 1], [7, 1, 5],
  ],
};

/** A flat strip. */
const STRIP = {
  corners: [[0, 1, -0.6], [1, 1, 0.6], [1, -1, 0.6], [0, -1, -0.6]],
  triangles: [[0, 1, 2], [0, 2, 3]],
};

const LINE_VERTEX = `
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform float fadeBelow;
attribute vec3 position;
attribute vec4 tint;
varying vec3 colour;
void main() {
  colour = tint.rgb;
  if (position.z < fadeBelow) colour = mix(colour, vec3(0.87, 0.885, 0.9), 0.72);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const LINE_FRAGMENT = `
precision mediump float;
varying vec3 colour;
void main() {
  gl_FragColor = vec4(colour, 1.0);
}`;

/** Moves of a route that are drawn alike, from a template. */
class MoveMesh {
  constructor({ heightMm, leastPixels, template, lift = 0, shade = 1 }) {
    this.template = template;
    this.material = new THREE.RawShaderMaterial({
      vertexShader: BEAD_VERTEX,
      fragmentShader: BEAD_FRAGMENT,
      side: THREE.DoubleSide,
      uniforms: {
        height: { value: heightMm },
        pixel: { value: 0.001 },
        leastPixels: { value: leastPixels },
        lift: { value: lift },
        fadeBelow: { value: -1e9 },
        shade: { value: shade },
      },
    });
  }

  /** Takes what a route keeps of each move. */
  setMoves(moves) {
    this.moves = moves;
    // A buffer of no length cannot be bound.
    const array = moves.length > 0 ? moves : new Float32Array(STRIDE);
    const buffer = new THREE.InstancedInterleavedBuffer(array, STRIDE, 1);
    const count = array.length / STRIDE;
    this.tints = new THREE.InstancedInterleavedBuffer(new Uint8Array(4 * count), 4, 1);
    this.geometry = new THREE.InstancedBufferGeometry();
    this.geometry.setIndex(this.template.triangles.flat());
    const interleaved = (name, from, size, normalized) =>
      this.geometry.setAttribute(
        name, new THREE.InterleavedBufferAttribute(from, size, 0, normalized),
      );
    this.geometry.setAttribute(
      "position",
      new THREE.BufferAttribute(new Float32Array(this.template.corners.flat()), 3),
    );
    interleaved("path", buffer, 4, false);
    interleaved("size", buffer, 2, false);
    interleaved("tint", this.tints, 4, true);
    this.mesh = new THREE.Mesh(this.geometry, this.material);
    this.mesh.frustumCulled = false;
    this.draw(0, moves.length / STRIDE);
    return this.mesh;
  }

  /** Colours, four bytes a move. */
  setTints(tints) {
    this.tints.array.set(tints);
    this.tints.needsUpdate = true;
  }

  /** Shows moves from `first` up to, not including, `last`. Nothing is sent to the card. */
  draw(first, last) {
    this.first = first;
    this.last = Math.max(first, last);
    this.drawPart(first, this.last);
  }

  /** Shows but a part of them. */
  drawPart(first, last) {
    const { path, size, tint } = this.geometry.attributes;
    path.offset = STRIDE * first;
    size.offset = STRIDE * first + 4;
    tint.offset = 4 * first;
    this.geometry.maxInstancedCount = last - first;
    this.mesh.visible = last > first;
  }

  dispose() {
    this.geometry.dispose();
  }
}

/** Beads: like roofs, or as lines where these are too many for the machine. */
class BeadMesh extends MoveMesh {
  constructor(heightMm) {
    super({ heightMm, leastPixels: 0.32, template: ROOF });
    this.lines = null;
    this.group = new THREE.Group();
  }

  setMoves(moves) {
    this.group.add(super.setMoves(moves));
    return this.group;
  }

  setTints(tints) {
    super.setTints(tints);
    if (this.lines) this.tintLines();
  }

  drawPart(first, last, coarse = false) {
    super.drawPart(first, coarse ? first : last);
    if (coarse && !this.lines) this.makeLines();
    if (!this.lines) return;
    this.lines.visible = coarse && last > first;
    this.lines.geometry.setDrawRange(2 * first, 2 * (last - first));
    this.lines.material.uniforms.fadeBelow.value = this.material.uniforms.fadeBelow.value;
  }

  /** Two ends for each move, apart from the template's arrays; made when first needed. */
  makeLines() {
    const count = this.moves.length / STRIDE;
    const ends = new Float32Array(6 * count);
    for (let i = 0, j = 0; j < ends.length; i += STRIDE, j += 6) {
      ends[j] = this.moves[i];
      ends[j + 1] = this.moves[i + 1];
      ends[j + 3] = this.moves[i + 2];
      ends[j + 4] = this.moves[i + 3];
      ends[j + 2] = ends[j + 5] = this.moves[i + 4];
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(ends, 3));
    geometry.setAttribute("tint", new THREE.BufferAttribute(new Uint8Array(8 * count), 4, true));
    this.lines = new THREE.LineSegments(
      geometry,
      new THREE.RawShaderMaterial({
        vertexShader: LINE_VERTEX,
        fragmentShader: LINE_FRAGMENT,
        uniforms: { fadeBelow: { value: 0 } },
      }),
    );
    this.lines.frustumCulled = false;
    this.group.add(this.lines);
    this.tintLines();
  }

  /** Lines have no sides that light could fall on: how they run decides how bright they are. */
  tintLines() {
    const { tint } = this.lines.geometry.attributes;
    const from = this.tints.array;
    const { moves } = this;
    for (let move = 0, i = 0, j = 0; i < from.length; move += STRIDE, i += 4, j += 8) {
      const dx = moves[move + 2] - moves[move];
      const dy = moves[move + 3] - moves[move + 1];
      const length = Math.sqrt(dx * dx + dy * dy) || 1;
      const light = 0.62 + (0.4 * Math.abs(0.87 * dx - 0.5 * dy)) / length;
      for (let channel = 0; channel < 3; channel++)
        tint.array[j + channel] = tint.array[j + 4 + channel] = Math.min(
          255, light * from[i + channel],
        );
    }
    tint.needsUpdate = true;
  }

  dispose() {
    super.dispose();
    if (this.lines) this.lines.geometry.dispose();
  }
}

const MARK_VERTEX = `
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform float pixels;
attribute vec3 position;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z -= 0.0004 * gl_Position.w;
  gl_PointSize = pixels;
}`;

/** A triangle that points down, or a ring with a dot, with a dark edge. */
const MARK_FRAGMENT = `
precision mediump float;
uniform vec3 fill;
uniform float ring;
void main() {
  vec2 p = gl_PointCoord * 2.0 - 1.0;
  float inside = ring > 0.5
    ? 1.0 - length(p)
    : min((0.85 - abs(p.x) * 1.6 - p.y) * 0.55, p.y + 0.92);
  if (inside < 0.0) discard;
  bool edge = ring > 0.5
    ? (inside < 0.16 || (inside > 0.42 && inside < 0.58))
    : inside < 0.2;
  gl_FragColor = vec4(edge ? vec3(0.1) : fill, 1.0);
}`;

/** Marks of a fixed size on the screen. */
class Marks {
  constructor({ colour, ring = false }) {
    this.material = new THREE.RawShaderMaterial({
      vertexShader: MARK_VERTEX,
      fragmentShader: MARK_FRAGMENT,
      uniforms: {
        pixels: { value: 10 },
        fill: { value: new THREE.Color(colour) },
        ring: { value: ring ? 1 : 0 },
      },
    });
  }

  /** Three numbers a mark. */
  setPlaces(places) {
    if (this.geometry) this.geometry.dispose();
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
    this.points = new THREE.Points(this.geometry, this.material);
    this.points.frustumCulled = false;
    return this.points;
  }

  draw(first, last) {
    this.geometry.setDrawRange(first, Math.max(0, last - first));
    this.points.visible = last > first;
    this.shown = last - first;
  }

  setPixels(pixels) {
    this.material.uniforms.pixels.value = pixels;
  }

  dispose() {
    if (this.geometry) this.geometry.dispose();
  }
}
