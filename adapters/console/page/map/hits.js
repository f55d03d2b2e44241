/** Hit testing: the thing under a point of the screen. */
import { areaOf, isInside, lineOf } from "./projection.js";

/** The nearest thing drawn at a point, else the smallest place around the point: {name, section}, or null. */
export function hitAt(point, drawn, places, view, tolerance) {
  return nearest(point, drawn, tolerance) ?? smallestAround(point, places, view);
}

/** Among equally near things, vehicles come first. */
function nearest([x, y], drawn, tolerance) {
  let best = null;
  for (const { name, section, at, radius, entity } of drawn) {
    const distance = Math.hypot(at[0] - x, at[1] - y);
    const score = distance - (entity?.vehicle ? radius : 0);
    if (distance <= Math.max(radius, tolerance) && (best === null || score < best.score)) best = { name, section, score };
  }
  return best && { name: best.name, section: best.section };
}

function smallestAround(point, places, view) {
  let best = null;
  for (const [name, { ring }] of places) {
    if (ring.length < 3 || !view.seesLine(lineOf(ring), 0)) continue;
    const pixels = view.pixels(lineOf(ring));
    if (!isInside(point, pixels)) continue;
    const area = areaOf(pixels);
    if (best === null || area < best.area) best = { name, section: "places", area };
  }
  return best && { name: best.name, section: best.section };
}
