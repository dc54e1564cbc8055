// How fast the head moves, by the printer's own limits: speed, acceleration, junction
// deviation or jerk.

/** Mean speed of every segment, mm/s, by the judge's look-ahead model, layer by layer. */
function modelledSpeeds(route, printer) {
  const speeds = new Float32Array(route.segmentCount);
  for (let place = 0; place < route.layers.length; place++)
    speedsOfLayer(route, place, printer, speeds);
  return speeds;
}

function speedsOfLayer(route, place, printer, speeds) {
  const accel = Number(printer.accel_mm_s2);
  const start = route.start(place);
  const stop = route.start(place + 1);
  const most = route.movesOf(place);
  const length = new Float64Array(most);
  const top2 = new Float64Array(most); // speeds are squared
  const entry2 = new Float64Array(most);
  const segmentOf = new Int32Array(most).fill(-1);
  const ways = [];
  const fromRest = new Uint8Array(most);
  let moves = 0;
  let standing = true;
  const add = (array, number, speed, retracted, segment) => {
    const at = STRIDE * number;
    const way = [array[at + 2] - array[at], array[at + 3] - array[at + 1]];
    length[moves] = Math.hypot(way[0], way[1]);
    top2[moves] = speed * speed;
    fromRest[moves] = standing || retracted ? 1 : 0;
    ways.push(way);
    segmentOf[moves++] = segment;
    standing = retracted;
  };
  let travel = start.travel;
  for (let segment = start.segment; segment <= stop.segment; segment++) {
    while (travel < stop.travel && route.segmentsBefore[travel] === segment) {
      const retracted = Boolean(route.travelFlags[travel] & RETRACTED);
      add(route.travels, travel++, Number(printer.travel_mm_s), retracted, -1);
    }
    if (segment < stop.segment)
      add(route.segments, segment, Number(printer.extrude_mm_s), false, segment);
  }

  const straight = straightStretches(ways, length, fromRest);
  const jerk = Number(printer.jerk_mm_s || 0);
  for (let i = 0; i < moves; i++) {
    const slower2 = i === 0 ? top2[i] : Math.min(top2[i], top2[i - 1]);
    entry2[i] = Math.min(slower2, jerk * jerk);
    if (fromRest[i]) continue;
    if (jerk > 0) {
      entry2[i] = Math.max(entry2[i], jerkJunction2(ways[i - 1], ways[i], slower2, jerk));
    } else {
      const stretch = Math.min(straight[i - 1], straight[i]);
      entry2[i] = Math.min(slower2, junction2(ways[i - 1], ways[i], stretch, printer));
    }
  }

  const last2 = moves === 0 ? 0 : Math.min(top2[moves - 1], jerk * jerk);
  let next2 = last2; // the last move ends at rest
  for (let i = moves - 1; i >= 0; i--) {
    entry2[i] = Math.min(entry2[i], next2 + 2 * accel * length[i]);
    next2 = entry2[i];
  }
  for (let i = 0; i < moves; i++) {
    let exit2 = Math.min(last2, entry2[i] + 2 * accel * length[i]);
    if (i + 1 < moves) {
      entry2[i + 1] = Math.min(entry2[i + 1], entry2[i] + 2 * accel * length[i]);
      exit2 = entry2[i + 1];
    }
    if (segmentOf[i] < 0) continue;
    const peak2 = Math.min(top2[i], accel * length[i] + (entry2[i] + exit2) / 2);
    const peak = Math.sqrt(peak2);
    const ramps = (2 * peak2 - entry2[i] - exit2) / (2 * accel);
    const time =
      (2 * peak - Math.sqrt(entry2[i]) - Math.sqrt(exit2)) / accel +
      Math.max(0, length[i] - ramps) / peak;
    speeds[segmentOf[i]] = length[i] / time;
  }
}

/** A turn slighter than this is none. */
const STRAIGHT_TURN = 1e-4;
/** By how much a way may be off: places here are rounded more coarsely than the judge's. */
const WAY_ERROR_MM = 1e-4;

/** Angle by which the way turns, without what rounding may have added to it. */
function turnOf(before, after) {
  const along = before[0] * after[0] + before[1] * after[1];
  const across = before[0] * after[1] - before[1] * after[0];
  const doubt =
    WAY_ERROR_MM * (1 / Math.hypot(before[0], before[1]) + 1 / Math.hypot(after[0], after[1]));
  return Math.max(0, Math.abs(Math.atan2(across, along)) - doubt);
}

function goesStraightOn(before, after) {
  return turnOf(before, after) < STRAIGHT_TURN;
}

/** Of every move the length of the straight stretch that it is a part of. */
function straightStretches(ways, length, fromRest) {
  const straight = new Float64Array(ways.length);
  for (let begin = 0, end = 0; begin < ways.length; begin = end) {
    let sum = length[begin];
    for (end = begin + 1; end < ways.length; end++) {
      if (fromRest[end] || !goesStraightOn(ways[end - 1], ways[end])) break;
      sum += length[end];
    }
    straight.fill(sum, begin, end);
  }
  return straight;
}

/** Speed at which two moves may meet by the jerk of each axis, squared. */
function jerkJunction2(before, after, top2, jerk) {
  const top = Math.sqrt(top2);
  const exitScale = top / Math.hypot(before[0], before[1]);
  const entryScale = top / Math.hypot(after[0], after[1]);
  const change = Math.max(
    ...[0, 1].map((axis) => {
      const exit = exitScale * before[axis];
      const entry = entryScale * after[axis];
      return exit * entry > 0
        ? Math.abs(entry - exit)
        : Math.max(Math.abs(exit), Math.abs(entry));
    }),
  );
  const share = change > jerk ? jerk / change : 1;
  return top2 * share * share;
}

/** Speed at which two moves may meet, squared; `stretch` is the shorter straight one beside them. */
function junction2(before, after, stretch, printer) {
  const lengths = Math.hypot(before[0], before[1]) * Math.hypot(after[0], after[1]);
  const cosTurn = Math.max(
    -1,
    Math.min(1, (before[0] * after[0] + before[1] * after[1]) / lengths),
  );
  const sinHalf = Math.sqrt((1 + cosTurn) / 2);
  if (sinHalf >= 1) return Infinity;
  const accel = Number(printer.accel_mm_s2);
  const corner2 = (accel * Number(printer.junction_mm) * sinHalf) / (1 - sinHalf);
  const turn = turnOf(before, after);
  const isCurve = stretch < 1 && cosTurn > Math.SQRT1_2 && turn >= STRAIGHT_TURN;
  return isCurve ? Math.min(corner2, (accel * stretch) / turn) : corner2;
}
