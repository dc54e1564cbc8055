// Reads G-code of Marlin, Klipper, RepRapFirmware and UltiGCode into a route, in one pass.

const GCODE_KINDS = ["wall", "dense", "sparse", "other", "unknown"];
const GCODE_TYPES = {
  wall: [
    "external perimeter", "perimeter", "overhang perimeter", "thin wall", "outer wall",
    "inner wall", "overhang wall", "wall-outer", "wall-inner",
  ],
  dense: [
    "gap fill", "solid infill", "top solid infill", "bridge infill", "ironing", "gap infill",
    "top surface", "bottom surface", "internal solid infill", "bridge", "internal bridge",
    "floating vertical shell", "skin",
  ],
  sparse: ["internal infill", "sparse infill", "fill"],
};
const KIND_OF_TYPE = new Map(
  Object.entries(GCODE_TYPES).flatMap(([kind, names]) =>
    names.map((name) => [name, GCODE_KINDS.indexOf(kind)]),
  ),
);
const OTHER_KIND = GCODE_KINDS.indexOf("other");
const UNKNOWN_KIND = GCODE_KINDS.indexOf("unknown");

const CHORD_MM = 0.01; // how far a chord may be from its arc
const FARTHEST_MM = 1e5;
const NEW_LAYER_MM = 0.02; // without comments, a layer begins where material is laid this far off
const INCH_MM = 25.4;
const BEAD_CORNERS = 1 - Math.PI / 4;
const DEFAULT_WIDTH_MM = 0.45;
const DEFAULT_HEIGHT_MM = 0.2;

class GcodeReader {
  constructor(name) {
    this.builder = new RouteBuilder(name, GCODE_KINDS);
    this.builder.recordSpeeds();
    this.place = { x: 0, y: 0, z: 0 };
    this.offset = { x: 0, y: 0, z: 0 };
    this.e = 0;
    this.scale = 1;
    this.absolute = true;
    this.absoluteE = true;
    this.volumetric = false;
    this.filamentMm = 1.75;
    this.speed = 0;
    this.kind = UNKNOWN_KIND;
    this.width = 0;
    this.height = 0;
    this.hasMarks = false; // comments tell where layers begin
    this.layerIsDue = true;
    this.layerZ = -Infinity;
    this.layerBelowZ = 0;
    this.retractedMm = 0;
    this.firmwareRetracted = false;
    this.lastWasTravel = false;
    this.pending = []; // travels before the first segment of a layer belong to it
    this.positioned = false; // before the first move nobody knows where the head is
  }

  read(text) {
    let start = 0;
    while (start < text.length) {
      let end = text.indexOf("\n", start);
      if (end < 0) end = text.length;
      this.line(text, start, end);
      start = end + 1;
    }
    if (this.builder.segmentKind.length === 0)
      throw new Error("no move in it lays material; is this G-code?");
    return this.builder.finish();
  }

  line(text, start, end) {
    const semicolon = text.indexOf(";", start);
    let stop = end;
    if (semicolon >= 0 && semicolon < end) {
      stop = semicolon;
      this.comment(text.slice(semicolon + 1, end).trim());
    }
    if (stop === start) return;
    const words = this.wordsOf(text, start, stop);
    if (words.G === 0 || words.G === 1) this.straight(words);
    else if (words.G === 2 || words.G === 3) this.arc(words, words.G === 2);
    else this.command(words);
  }

  /** Letters and numbers of a line; a later one of the same letter counts. */
  wordsOf(text, start, stop) {
    const words = {};
    let at = start;
    while (at < stop) {
      let code = text.charCodeAt(at) & ~32;
      if (text.charCodeAt(at) === 40) { // a comment in brackets
        const close = text.indexOf(")", at);
        at = close < 0 || close > stop ? stop : close + 1;
        continue;
      }
      at++;
      if (code === 10) break; // '*': what follows is a checksum
      if (code < 65 || code > 90) continue;
      let numberEnd = at;
      while (numberEnd < stop) {
        const c = text.charCodeAt(numberEnd);
        if (!((c >= 48 && c <= 57) || c === 43 || c === 45 || c === 46 || c === 32)) break;
        numberEnd++;
      }
      const number = Number(text.slice(at, numberEnd));
      words[String.fromCharCode(code)] = numberEnd > at && Number.isFinite(number) ? number : NaN;
      at = numberEnd;
    }
    return words;
  }

  command(words) {
    const has = (letter) => letter in words;
    if (words.G === 10 && !has("L") && !has("P")) this.firmwareRetracted = true;
    else if (words.G === 11) this.firmwareRetracted = false;
    else if (words.G === 20) this.scale = INCH_MM;
    else if (words.G === 21) this.scale = 1;
    else if (words.G === 28) this.home(words);
    else if (words.G === 90 || words.G === 91) this.absolute = words.G === 90;
    else if (words.G === 92) this.setPlace(words);
    else if (words.M === 82) this.absoluteE = true;
    else if (words.M === 83) this.absoluteE = false;
  }

  home(words) {
    const all = !("X" in words || "Y" in words || "Z" in words);
    for (const [axis, letter] of [["x", "X"], ["y", "Y"], ["z", "Z"]])
      if (all || letter in words) { this.place[axis] = 0; this.offset[axis] = 0; }
  }

  setPlace(words) {
    for (const [axis, letter] of [["x", "X"], ["y", "Y"], ["z", "Z"]])
      if (words[letter] === words[letter] && letter in words)
        this.offset[axis] = this.place[axis] - words[letter] * this.scale;
    if ("E" in words) this.e = words.E * this.scale;
  }

  /** The end of a move, and how much filament goes into it. */
  target(words) {
    const place = { ...this.place };
    for (const [axis, letter] of [["x", "X"], ["y", "Y"], ["z", "Z"]]) {
      const value = words[letter];
      if (value === undefined || Number.isNaN(value)) continue;
      place[axis] = this.absolute
        ? value * this.scale + this.offset[axis]
        : place[axis] + value * this.scale;
      if (!(Math.abs(place[axis]) <= FARTHEST_MM))
        throw new Error(`a move goes to ${letter}${value}, farther than any printer reaches`);
    }
    let filament = 0;
    if (words.E !== undefined && !Number.isNaN(words.E)) {
      const value = words.E * this.scale;
      // M83 makes E relative, and so does G91 for every axis.
      const absolute = this.absolute && this.absoluteE;
      filament = absolute ? value - this.e : value;
      this.e = absolute ? value : this.e + value;
    }
    if (words.F > 0) this.speed = (words.F * this.scale) / 60;
    return { place, filament };
  }

  straight(words) {
    const { place, filament } = this.target(words);
    this.move(place, filament);
  }

  arc(words, clockwise) {
    const from = { ...this.place };
    const { place, filament } = this.target(words);
    const centre = arcCentre(from, place, words, this.scale, clockwise);
    if (!centre) {
      this.move(place, filament);
      return;
    }
    const radius = Math.hypot(from.x - centre.x, from.y - centre.y);
    const begin = Math.atan2(from.y - centre.y, from.x - centre.x);
    let sweep = Math.atan2(place.y - centre.y, place.x - centre.x) - begin;
    if (clockwise && sweep >= -1e-9) sweep -= 2 * Math.PI;
    if (!clockwise && sweep <= 1e-9) sweep += 2 * Math.PI;
    const step = 2 * Math.acos(Math.max(0, 1 - CHORD_MM / Math.max(radius, CHORD_MM)));
    const chords = Math.max(1, Math.min(4096, Math.ceil(Math.abs(sweep) / step)));
    for (let i = 1; i <= chords; i++) {
      const angle = begin + (sweep * i) / chords;
      const next = i === chords
        ? place
        : {
            x: centre.x + radius * Math.cos(angle),
            y: centre.y + radius * Math.sin(angle),
            z: from.z + ((place.z - from.z) * i) / chords,
          };
      this.move(next, filament / chords);
    }
  }

  move(to, filament) {
    const from = this.place;
    const length = Math.hypot(to.x - from.x, to.y - from.y);
    this.place = to;
    if (filament < 0) this.retractedMm -= filament;
    if (length === 0) {
      if (filament > 0) this.retractedMm = Math.max(0, this.retractedMm - filament);
      return;
    }
    if (filament > 0) this.extrude(from, to, length, filament);
    else this.travel(from, to);
    this.positioned = true;
  }

  extrude(from, to, length, filament) {
    this.retractedMm = 0;
    const marked = this.hasMarks ? this.layerIsDue : false;
    const raised = !this.hasMarks && Math.abs(to.z - this.layerZ) > NEW_LAYER_MM;
    if (marked || raised || this.builder.layers.length === 0) this.beginLayer(to.z);
    for (const way of this.pending) this.putTravel(...way);
    this.pending = [];
    this.builder.segment(
      from.x, from.y, to.x, to.y, to.z, this.width || this.widthOf(length, filament), this.kind,
    );
    this.builder.segmentSpeed.push(this.speed);
    this.lastWasTravel = false;
  }

  travel(from, to) {
    if (!this.positioned) return;
    const retracted = this.retractedMm > 0 || this.firmwareRetracted;
    this.pending.push([from.x, from.y, to.x, to.y, to.z, retracted ? RETRACTED : 0, this.speed]);
  }

  putTravel(x0, y0, x1, y1, z, flags, speed) {
    const { travelFlags } = this.builder;
    if (this.lastWasTravel) {
      // One gap, however many moves it takes; retracted if any of them is.
      if (flags & RETRACTED) travelFlags.values[this.gapStart] |= RETRACTED;
      this.builder.travel(x0, y0, x1, y1, z, (flags & ~RETRACTED) | CONTINUED);
    } else {
      this.gapStart = travelFlags.length;
      const entry = this.builder.layerIsEmpty() ? ENTRY : 0;
      this.builder.travel(x0, y0, x1, y1, z, flags | entry);
    }
    this.builder.travelSpeed.push(speed);
    this.lastWasTravel = true;
  }

  beginLayer(z) {
    this.layerBelowZ = z > this.layerZ && this.layerZ > -Infinity ? this.layerZ : 0;
    this.layerZ = z;
    this.layerIsDue = false;
    this.lastWasTravel = false;
    this.builder.beginLayer(this.builder.layers.length, z, z);
  }

  /** The width of a bead with round ends that takes this much filament. */
  widthOf(length, filament) {
    const height = this.height || Math.min(1, Math.max(0, this.layerZ - this.layerBelowZ)) ||
      DEFAULT_HEIGHT_MM;
    const volume = this.volumetric ? filament : filament * Math.PI * (this.filamentMm / 2) ** 2;
    const width = volume / length / height + height * BEAD_CORNERS;
    return width > 0.02 && width < 5 ? width : DEFAULT_WIDTH_MM;
  }

  comment(text) {
    const after = (...keys) => {
      const key = keys.find((k) => text.startsWith(k));
      return key === undefined ? undefined : text.slice(key.length).trim();
    };
    let value;
    if (text === "LAYER_CHANGE" || text === "CHANGE_LAYER" || text.startsWith("LAYER:")) {
      this.hasMarks = true;
      this.layerIsDue = true;
    } else if ((value = after("TYPE:", "FEATURE:")) !== undefined) {
      this.kind = KIND_OF_TYPE.get(value.toLowerCase()) ?? OTHER_KIND;
    } else if ((value = after("WIDTH:", "LINE_WIDTH:")) !== undefined) {
      this.width = Number(value) > 0 ? Number(value) : 0;
    } else if ((value = after("HEIGHT:", "LAYER_HEIGHT:")) !== undefined) {
      this.height = Number(value) > 0 ? Number(value) : 0;
    } else if ((value = after("FLAVOR:")) !== undefined) {
      if (value === "UltiGCode") { this.volumetric = true; this.absoluteE = true; }
    } else if ((value = after("filament_diameter =", "printer.filament_mm =")) !== undefined) {
      if (parseFloat(value) > 0) this.filamentMm = parseFloat(value);
    }
  }
}

/** The centre of an arc, from I and J or from R; null where there is none. */
function arcCentre(from, to, words, scale, clockwise) {
  if (words.I !== undefined || words.J !== undefined)
    return { x: from.x + (words.I || 0) * scale, y: from.y + (words.J || 0) * scale };
  const radius = (words.R || 0) * scale;
  const dx = to.x - from.x;
  const dy = to.y - from.y;
  const chord = Math.hypot(dx, dy);
  if (radius === 0 || chord === 0) return null;
  const height = Math.sqrt(Math.max(0, radius * radius - (chord * chord) / 4));
  // A negative radius asks for the longer way round.
  const side = (clockwise ? -1 : 1) * Math.sign(radius);
  return {
    x: from.x + dx / 2 - (side * height * dy) / chord,
    y: from.y + dy / 2 + (side * height * dx) / chord,
  };
}

/** A file of G-code as a route. Throws Error with what is wrong. */
function readGcode(name, text) {
  return new GcodeReader(name).read(text);
}
