/** The tracks of vehicles: pieces `uav0#3` of the section `tracks`; only the last piece of each vehicle grows. */

/** The opacity of a piece by the number of pieces after it: `[at most, opacity]`; older ones are fainter. */
export const FADED = [[2, 0.85], [8, 0.6], [24, 0.4], [Infinity, 0.25]];

export class Tracks {
  #chunks;
  #last = new Map();

  constructor(chunks) {
    this.#chunks = chunks;
  }

  /** Take in changed pieces; return whether others than the growing ones changed. */
  update(keys) {
    const before = this.#last;
    this.#last = lastOf(this.#chunks.keys());
    return [...keys].some((key) => {
      const [name, rank] = split(key);
      return rank !== this.#last.get(name) || rank !== before.get(name);
    });
  }

  /** The growing piece of each vehicle, by name. */
  *growing() {
    for (const [name, rank] of this.#last) yield [name, this.#chunks.get(`${name}#${rank}`)];
  }

  /** The finished pieces, grouped by opacity. */
  finished(faded) {
    const groups = faded.map(([, opacity]) => [opacity, []]);
    for (const [key, chunk] of this.#chunks) {
      const [name, rank] = split(key);
      const after = this.#last.get(name) - rank;
      if (after > 0) groups[faded.findIndex(([most]) => after <= most)][1].push(chunk);
    }
    return groups;
  }
}

function split(key) {
  const at = key.lastIndexOf("#");
  return [key.slice(0, at), Number(key.slice(at + 1))];
}

function lastOf(keys) {
  const last = new Map();
  for (const key of keys) {
    const [name, rank] = split(key);
    if (rank > (last.get(name) ?? -1)) last.set(name, rank);
  }
  return last;
}
