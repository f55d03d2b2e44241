/** The placement of labels: the more important first, without overlaps. */

const GAP = 4;
const CELL = 48;

/** The corners that a label may have beside its point, the best first, by [width, height] and the symbol's radius. */
const SLOTS = [
  ([, h], r) => [r + GAP, -h / 2],
  ([w, h], r) => [-r - GAP - w, -h / 2],
  ([w, h], r) => [-w / 2, -r - h],
  ([w], r) => [-w / 2, r],
  ([, h], r) => [r * 0.7, -r * 0.7 - h],
  ([], r) => [r * 0.7, r * 0.7],
  ([w, h], r) => [-r * 0.7 - w, -r * 0.7 - h],
  ([w], r) => [-r * 0.7 - w, r * 0.7],
];

/** A spatial index of boxes [left, top, right, bottom]. */
export class Boxes {
  #cells = new Map();

  add(box) {
    for (const key of cellsOf(box)) {
      const found = this.#cells.get(key);
      if (found) found.push(box);
      else this.#cells.set(key, [box]);
    }
  }

  hits(box) {
    for (const key of cellsOf(box)) if (this.#cells.get(key)?.some((other) => overlap(box, other))) return true;
    return false;
  }
}

function* cellsOf([left, top, right, bottom]) {
  for (let x = Math.floor(left / CELL); x <= Math.floor(right / CELL); x++)
    for (let y = Math.floor(top / CELL); y <= Math.floor(bottom / CELL); y++) yield x * 4096 + y;
}

/** Whether two boxes overlap. */
export const overlap = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];

/**
 * Place labels: each has a `key`, `at`, `radius`, `size`, `priority` (the lowest first), and may be `centred`. A label
 * without room is left out, unless it is `needed`. `slots` keep the last side of each label, which it reuses if it can.
 */
export function placeLabels(labels, taken, slots, view) {
  const placed = [];
  for (const label of labels.toSorted((a, b) => a.priority - b.priority)) {
    const box = freeBox(label, taken, slots, view);
    if (!box) continue;
    taken.add(box);
    placed.push({ ...label, corner: [box[0], box[1]] });
  }
  return placed;
}

function freeBox(label, taken, slots, view) {
  if (label.centred) return centredBox(label, taken, view);
  const last = slots.get(label.key) ?? 0;
  for (let n = -1; n < SLOTS.length; n++) {
    const slot = n < 0 ? last : n;
    const box = roomAt(boxAt(label, SLOTS[slot]), taken, view);
    if (!box) continue;
    slots.set(label.key, slot);
    return box;
  }
  return label.needed ? boxAt(label, SLOTS[last]) : null;
}

/** The first box with room in an area, from its upper edge downwards. */
function centredBox(label, taken, view) {
  for (let line = 0; line < 4; line++) {
    const box = roomAt(boxAt(label, ([w, h]) => [-w / 2, -h / 2 + line * 1.5 * h]), taken, view);
    if (box) return box;
  }
  return null;
}

function boxAt({ at, size, radius }, slot) {
  const [x, y] = slot(size, radius);
  return [at[0] + x, at[1] + y, at[0] + x + size[0], at[1] + y + size[1]];
}

const roomAt = (box, taken, view) => (isWithin(box, view) && !taken.hits(box) ? box : null);

const isWithin = ([left, top, right, bottom], { width, height }) =>
  left >= 0 && top >= 0 && right <= width && bottom <= height;
