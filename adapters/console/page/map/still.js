/** The still layer, which seldom changes: graticule, places, fences, and the tracks without their last pieces. */
import { drawGraticule } from "./graticule.js";
import { lineOf } from "./projection.js";
import { FADED } from "./tracks.js";

const TICK = { every: 16, length: 6 };

export function drawStill(pen, store, tracks, covered) {
  drawGraticule(pen, covered);
  drawPlaces(pen, store.section("places"));
  drawFences(pen, store.section("fences"));
  for (const [opacity, chunks] of tracks.finished(FADED)) drawTrack(pen, chunks, opacity);
}

/** Draw the outlines of places, dashed if L and P differ on the parent. */
function drawPlaces({ ctx, view, palette }, places) {
  Object.assign(ctx, { lineWidth: 1.5, strokeStyle: palette.place, fillStyle: palette.placeFill });
  for (const { ring, differs } of places.values()) {
    const line = lineOf(ring);
    if (ring.length < 3 || !view.seesLine(line)) continue;
    const path = new Path2D();
    view.trace(path, line, 0.7);
    path.closePath();
    ctx.fill(path);
    Object.assign(ctx, differs ? { lineWidth: 2.5, strokeStyle: palette.differs } : { lineWidth: 1.5, strokeStyle: palette.place });
    ctx.setLineDash(differs ? [9, 6] : []);
    ctx.stroke(path);
  }
  ctx.setLineDash([]);
}

/** Draw fences, with ticks on the permitted side. */
function drawFences({ ctx, view, palette }, fences) {
  const path = new Path2D();
  for (const { ring } of fences.values()) {
    const line = lineOf(ring);
    if (!view.seesLine(line)) continue;
    view.trace(path, line);
    path.closePath();
    addTicks(path, inwards(view.pixels(line)), view);
  }
  Object.assign(ctx, { lineWidth: 1.5, strokeStyle: palette.fence });
  ctx.stroke(path);
}

/** The pixels of a ring, ordered so that its inside is on the right. */
function inwards(pixels) {
  const turn = pixels.reduce((sum, [x, y], n) => {
    const [x2, y2] = pixels[(n + 1) % pixels.length];
    return sum + x * y2 - x2 * y;
  }, 0);
  return turn > 0 ? pixels : pixels.toReversed();
}

function addTicks(path, pixels, view) {
  pixels.forEach(([x, y], n) => {
    const [x2, y2] = pixels[(n + 1) % pixels.length];
    const length = Math.hypot(x2 - x, y2 - y);
    if (length < 1 || length > 1e5) return;
    const [east, south] = [(x2 - x) / length, (y2 - y) / length];
    for (let at = TICK.every / 2; at < length; at += TICK.every) {
      const foot = [x + east * at, y + south * at];
      if (!view.sees(foot, TICK.length)) continue;
      path.moveTo(...foot);
      path.lineTo(foot[0] - south * TICK.length, foot[1] + east * TICK.length);
    }
  });
}

/** Draw pieces of tracks. */
export function drawTrack({ ctx, view, palette }, chunks, opacity) {
  const path = new Path2D();
  for (const chunk of chunks) {
    const line = lineOf(chunk);
    if (view.seesLine(line)) view.trace(path, line, 1.5);
  }
  Object.assign(ctx, { lineWidth: 2, lineJoin: "round", strokeStyle: palette.track, globalAlpha: opacity });
  ctx.stroke(path);
  ctx.globalAlpha = 1;
}
