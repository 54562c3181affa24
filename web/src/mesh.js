// Meshes as the engine sends them.

const MAGIC = 0x6d676163;
const VERSION = 1;
const HEADER = 32; // bytes
const HAS_NORMALS = 1, HAS_LABELS = 2;

/**
 * @typedef {object} MeshData
 * @property {Float32Array} positions
 * @property {Float32Array | null} normals
 * @property {Uint32Array} triangles  those of one label are adjacent
 * @property {Uint32Array | null} order  the number of each triangle in the engine's order; null: the same
 * @property {{ label: number, start: number, count: number }[]} groups  ranges of triangles by label
 * @property {Uint32Array} edges  pairs of vertices: feature edges, or the segments of a curve
 * @property {number} bytes
 */

/**
 * Reads a mesh. Throws an Error if the data is not one.
 *
 * @param {ArrayBuffer} buffer
 * @returns {MeshData}
 */
export function readMesh(buffer) {
  if (buffer.byteLength < HEADER) throw new Error("the mesh is truncated");
  const [magic, version, vertices, triangleCount, edgeCount, flags] = new Uint32Array(buffer, 0, 8);
  if (magic !== MAGIC || version !== VERSION) throw new Error("the mesh has an unknown format; reload the page");
  const hasNormals = (flags & HAS_NORMALS) !== 0, hasLabels = (flags & HAS_LABELS) !== 0;
  const size = HEADER + 4 * (vertices * (hasNormals ? 6 : 3) + triangleCount * (hasLabels ? 4 : 3) + edgeCount * 2);
  if (buffer.byteLength !== size) throw new Error(`expected a mesh of ${size} bytes, found ${buffer.byteLength}`);
  let at = HEADER;
  /** @param {Float32ArrayConstructor | Uint32ArrayConstructor} Type @param {number} count */
  const take = (Type, count) => {
    const array = new Type(buffer, at, count);
    at += 4 * count;
    return array;
  };
  const positions = /** @type {Float32Array} */ (take(Float32Array, vertices * 3));
  const normals = hasNormals ? /** @type {Float32Array} */ (take(Float32Array, vertices * 3)) : null;
  const triangles = /** @type {Uint32Array} */ (take(Uint32Array, triangleCount * 3));
  const labels = hasLabels ? /** @type {Uint32Array} */ (take(Uint32Array, triangleCount)) : null;
  const edges = /** @type {Uint32Array} */ (take(Uint32Array, edgeCount * 2));
  const { groups, order } = labels ? sortByLabel(triangles, labels) : { groups: [{ label: 0, start: 0, count: triangleCount }], order: null };
  return { positions, normals, triangles, order, groups, edges, bytes: buffer.byteLength };
}

/** @param {Uint32Array} triangles @param {Uint32Array} labels */
function sortByLabel(triangles, labels) {
  /** @type {Map<number, number>} */
  const counts = new Map();
  for (const label of labels) counts.set(label, (counts.get(label) ?? 0) + 1);
  let start = 0;
  const groups = [...counts.keys()].sort((a, b) => a - b).map((label) => {
    const group = { label, start, count: counts.get(label) ?? 0 };
    start += group.count;
    return group;
  });
  if (groups.length < 2) return { groups, order: null };
  const next = new Map(groups.map((g) => [g.label, g.start]));
  const source = triangles.slice(), order = new Uint32Array(labels.length);
  for (let i = 0; i < labels.length; i++) {
    const to = next.get(labels[i]) ?? 0;
    next.set(labels[i], to + 1);
    triangles.set(source.subarray(3 * i, 3 * i + 3), 3 * to);
    order[to] = i;
  }
  return { groups, order };
}

/**
 * The meshes of the scene and, up to a limit, those that were shown before: a slider that goes back shows them at once.
 *
 * @template T
 */
export class MeshCache {
  /**
   * @param {(id: string) => Promise<T>} load
   * @param {(mesh: T) => number} sizeOf  bytes
   * @param {(mesh: T) => void} release
   * @param {number} limit  bytes of the meshes that are not shown
   */
  constructor(load, sizeOf, release, limit) {
    this.load = load;
    this.sizeOf = sizeOf;
    this.release = release;
    this.limit = limit;
    /** @type {Map<string, Promise<T>>} in the order of their last use */
    this.loading = new Map();
    /** @type {Map<string, T>} */
    this.ready = new Map();
  }

  /** @param {string} id @returns {Promise<T>} */
  get(id) {
    let mesh = this.loading.get(id);
    this.loading.delete(id);
    if (!mesh) {
      mesh = this.load(id);
      mesh.then((m) => this.ready.set(id, m), () => this.loading.delete(id));
    }
    this.loading.set(id, mesh);
    return mesh;
  }

  /** Releases what is not shown, oldest first, until the rest is below the limit. @param {Set<string>} shown */
  trim(shown) {
    let bytes = 0;
    for (const [id, mesh] of this.ready) if (!shown.has(id)) bytes += this.sizeOf(mesh);
    for (const id of [...this.loading.keys()]) {
      if (bytes <= this.limit) return;
      const mesh = this.ready.get(id);
      if (!mesh || shown.has(id)) continue;
      bytes -= this.sizeOf(mesh);
      this.loading.delete(id);
      this.ready.delete(id);
      this.release(mesh);
    }
  }
}
