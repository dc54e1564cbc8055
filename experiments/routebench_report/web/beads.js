// Beads and travels as three.js meshes. One small template is drawn once for every move by the
// graphics card, from the route's own arrays; scrubbing only changes which part of them is drawn.

const BEAD_VERTEX = `
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform float height;       // of a bead, mm
uniform float pixel;        // mm that a pixel spans at a distance of 1 mm
uniform float leastPixels;  // half of the width that is always seen
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
  float half_width = max(size.y * 0.5, leastPixels * pixel * away);
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

/** A flat strip, for when there is much to draw at once. */
const STRIP = {
  corners: [[0, 1, -0.6], [1, 1, 0.6], [1, -1, 0.6], [0, -1, -0.6]],
  triangles: [[0, 1, 2], [0, 2, 3]],
};

/** Moves of a route that are drawn alike. */
class MoveMesh {
  constructor({ heightMm, leastPixels, lift = 0, shade = 1, flat = false }) {
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
    this.templates = flat ? [STRIP] : [ROOF, STRIP];
    this.geometries = [];
    this.mesh = null;
  }

  /** Takes what a route keeps of each move. */
  setMoves(moves) {
    this.dispose();
    const count = moves.length / STRIDE;
    // A buffer of no length cannot be bound.
    const array = count > 0 ? moves : new Float32Array(STRIDE);
    this.count = count;
    this.buffer = new THREE.InstancedInterleavedBuffer(array, STRIDE, 1);
    this.setTints(new Uint8Array(4 * count));
    this.geometries = this.templates.map((template) => this.geometryOf(template));
    this.mesh = new THREE.Mesh(this.geometries[0], this.material);
    this.mesh.frustumCulled = false;
    this.draw(0, count);
    return this.mesh;
  }

  /** Colours, four bytes a move. */
  setTints(tints) {
    const array = tints.length > 0 ? tints : new Uint8Array(4);
    if (this.tintBuffer && this.tintBuffer.array.length === array.length) {
      this.tintBuffer.array.set(array);
      this.tintBuffer.needsUpdate = true;
    } else {
      this.tintBuffer = new THREE.InstancedInterleavedBuffer(array, 4, 1);
    }
  }

  geometryOf(template) {
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setIndex(template.triangles.flat());
    geometry.setAttribute(
      "position",
      new THREE.BufferAttribute(new Float32Array(template.corners.flat()), 3),
    );
    geometry.setAttribute("path", new THREE.InterleavedBufferAttribute(this.buffer, 4, 0));
    geometry.setAttribute("size", new THREE.InterleavedBufferAttribute(this.buffer, 2, 4));
    geometry.setAttribute("tint", new THREE.InterleavedBufferAttribute(this.tintBuffer, 4, 0, true));
    return geometry;
  }

  /** Shows moves from `first` up to, not including, `last`. Nothing is sent to the card. */
  draw(first, last) {
    this.first = first;
    this.last = Math.max(first, last);
    for (const geometry of this.geometries) {
      geometry.attributes.path.offset = STRIDE * first;
      geometry.attributes.size.offset = STRIDE * first + 4;
      geometry.attributes.tint.offset = 4 * first;
      geometry.maxInstancedCount = this.last - first;
    }
    if (this.mesh) this.mesh.visible = this.last > first;
  }

  /** Chooses the template: the coarse one while many moves are in motion. */
  setCoarse(coarse) {
    if (this.mesh) this.mesh.geometry = this.geometries[coarse ? this.geometries.length - 1 : 0];
  }

  dispose() {
    for (const geometry of this.geometries) geometry.dispose();
    this.geometries = [];
    this.tintBuffer = null;
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
