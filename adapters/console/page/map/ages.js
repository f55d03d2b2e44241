/** The age classes of positions: fresh, old, lost. */

export const FRESH = "fresh";
export const OLD = "old";
export const LOST = "lost";
export const OPACITY = { [FRESH]: 1, [OLD]: 0.8, [LOST]: 0.6 };

/** Seconds after which a position is old, and lost: a vehicle reports all the time, a ship at anchor every three minutes. */
const LIMITS = { vehicle: [5, 30], other: [200, 600] };

export function ageClass(entity, now) {
  if ((entity.seen ?? null) === null) return OLD;
  const [old, lost] = entity.vehicle ? LIMITS.vehicle : LIMITS.other;
  const age = now - entity.seen;
  return age > lost ? LOST : age > old ? OLD : FRESH;
}
