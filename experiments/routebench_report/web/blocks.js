// Blocks: the page's packed data, each in a <script type="text/plain">. Their layout is described
// in blocks.py, which writes them.

/** The bytes of the block with that name, unpacked when they are asked for. */
async function unpackedBlock(name) {
  const element = document.getElementById(`block-${name}`);
  if (!element) throw new Error(`the page holds no block ${name}`);
  const packed = bytesOfBase64(element.textContent);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Reads a block's arrays one after the other. */
class BlockReader {
  constructor(buffer) {
    this.buffer = buffer;
    this.at = 0;
  }

  integers(count) {
    return new Int32Array(this.buffer, this.skip(4 * count), count);
  }

  floats(count) {
    return new Float32Array(this.buffer, this.skip(4 * count), count);
  }

  /** Running sums of differences, lowest bytes of all first. */
  coordinates(count) {
    const bytes = new Uint8Array(this.buffer, this.skip(4 * count), 4 * count);
    const values = new Int32Array(count);
    let sum = 0;
    for (let i = 0, j = count, k = 2 * count, l = 3 * count; i < count; i++, j++, k++, l++) {
      sum = (sum + (bytes[i] | (bytes[j] << 8) | (bytes[k] << 16) | (bytes[l] << 24))) | 0;
      values[i] = sum;
    }
    return values;
  }

  text(bytes) {
    const padded = bytes + ((4 - (bytes % 4)) % 4);
    return new TextDecoder().decode(new Uint8Array(this.buffer, this.skip(padded), bytes));
  }

  skip(bytes) {
    const start = this.at;
    this.at += bytes;
    return start;
  }
}

/** Outlines of a model's layers: rings of each, by the layer's index. */
function readOutlines(buffer, quantumMm) {
  const reader = new BlockReader(buffer);
  const [layers, rings, points] = reader.integers(3);
  const indices = reader.integers(layers);
  const heights = reader.integers(layers);
  const ringCounts = reader.integers(layers);
  const pointCounts = reader.integers(rings);
  const x = reader.coordinates(points);
  const y = reader.coordinates(points);
  const byIndex = new Map();
  let ring = 0;
  let point = 0;
  for (let layer = 0; layer < layers; layer++) {
    const own = [];
    for (let i = 0; i < ringCounts[layer]; i++, ring++) {
      const xy = new Float64Array(2 * pointCounts[ring]);
      for (let p = 0; p < pointCounts[ring]; p++, point++) {
        xy[2 * p] = x[point] * quantumMm;
        xy[2 * p + 1] = y[point] * quantumMm;
      }
      own.push(xy);
    }
    byIndex.set(indices[layer], { zMm: heights[layer] * quantumMm, rings: own });
  }
  return byIndex;
}

/** Scores of a cell's layers: a column for each metric. */
function readScores(buffer, quantumMm) {
  const reader = new BlockReader(buffer);
  const [layers, metrics] = reader.integers(2);
  const indices = Array.from(reader.integers(layers));
  const zMm = Array.from(reader.integers(layers), (z) => z * quantumMm);
  const columns = Array.from({ length: metrics }, () => reader.floats(layers));
  return { indices, zMm, columns };
}
