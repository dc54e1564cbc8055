// How fast the head moves, by the printer's own limits: speed, acceleration, junction deviation.

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
  let moves = 0;
  let standing = true;
  let before = null;
  const add = (array, number, speed, retracted, segment) => {
    const at = STRIDE * number;
    const way = [array[at + 2] - array[at], array[at + 3] - array[at + 1]];
    length[moves] = Math.hypot(way[0], way[1]);
    top2[moves] = speed * speed;
    standing = standing || retracted;
    if (!standing)
      entry2[moves] = Math.min(top2[moves], top2[moves - 1], junction2(before, way, printer));
    segmentOf[moves++] = segment;
    before = way;
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

  let next2 = 0; // the last move ends at rest
  for (let i = moves - 1; i >= 0; i--) {
    entry2[i] = Math.min(entry2[i], next2 + 2 * accel * length[i]);
    next2 = entry2[i];
  }
  for (let i = 0; i < moves; i++) {
    let exit2 = 0;
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

/** Speed at which two moves may meet, squared. */
function junction2(before, after, printer) {
  const lengths = Math.hypot(before[0], before[1]) * Math.hypot(after[0], after[1]);
  const cosTurn = Math.max(
    -1,
    Math.min(1, (before[0] * after[0] + before[1] * after[1]) / lengths),
  );
  const sinHalf = Math.sqrt((1 + cosTurn) / 2);
  if (sinHalf >= 1) return Infinity;
  return (Number(printer.accel_mm_s2) * Number(printer.junction_mm) * sinHalf) / (1 - sinHalf);
}
