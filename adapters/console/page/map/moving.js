/** The moving layer: the last pieces of tracks, planned ways, AIS targets, vehicles, differences of L and P, labels. */
import { FRESH, LOST, OLD, OPACITY, ageClass } from "./ages.js";
import { Boxes, placeLabels } from "./labels.js";
import { lineOf } from "./projection.js";
import { drawTrack } from "./still.js";
import { isUnderWay, wayOf } from "../wording.js";
import { TRIANGLE, addTurned, pathOf, shapeOf } from "./symbols.js";
import { drawable } from "./words.js";

const EARTH = 40075016.7;
const VECTOR = 360; // seconds: the length of AIS vectors, six minutes as on radars
const RADIUS = { vehicle: 14, target: 9, diamond: 8, place: 5, dot: 2 };
const CROWD = 300; // the targets in view above which only one in each cell has a symbol, the others dots
const CELL = 22;
const LABELLED = 120;
const ROOMY = 55; // pixels of height with room for a name and a vehicle
const EDGE = 12; // pixels beside a name inside its area
const PRIORITY = { chosen: 0, vehicle: 1, named: 2, place: 3, fence: 4, target: 5 };
const MARKS = ["", "▲", "■", "✖"];

/** Draw the moving layer; return the things that may be hit: {name, section, at, radius}. */
export function drawMoving(pen, store, tracks, { now, chosen, hovered, slots, covered, hidden }) {
  const things = inView(pen.view, store, now, chosen, hidden);
  for (const [name, chunk] of tracks.growing()) drawTrack(pen, [joined(chunk, store, name)], 1);
  for (const way of store.section("ways").values()) drawCorridor(pen, way);
  for (const invariant of store.section("invariants").values()) if (!invariant.holds) drawBreach(pen, invariant);
  for (const [name, vehicle] of store.section("vehicles")) drawWay(pen, vehicle, store.section("entities").get(name));
  thin(things);
  drawTargets(pen, things);
  for (const thing of things) if (thing.shape !== "target") drawThing(pen, thing);
  for (const thing of things) if (thing.entity.differs) drawDifference(pen, thing, store);
  for (const thing of things) if (thing.level > 0) drawLevel(pen, thing);
  const stations = stationsIn(pen.view, store.section("places"));
  for (const station of stations) drawStation(pen, station);
  const hits = [...things, ...stations];
  for (const hit of hits) if (hit.name === chosen || hit.name === hovered) drawBrackets(pen, hit, hit.name === chosen);
  return { hits, labels: drawLabels(pen, store, things, stations, { chosen, slots, covered }) };
}

/** Join the last piece of a track with the vehicle's position. */
function joined(chunk, store, name) {
  const at = store.section("entities").get(name)?.at;
  return at && chunk.length ? [...chunk, at] : chunk;
}

// --- things in view --------------------------------------------------------------------------------------------

function inView(view, store, now, chosen, hidden) {
  const things = [];
  const vehicles = store.section("vehicles");
  for (const [name, entity] of store.section("entities")) {
    if (hidden.has(name) && name !== chosen) continue;
    const at = view.point(entity.at);
    if (!view.sees(at, 60)) continue;
    const shape = shapeOf(entity);
    const card = vehicles.get(name);
    const age = ageClass(entity, now);
    things.push({
      name, entity, at, shape, section: "entities",
      age: card?.link?.lost ? LOST : age,
      heading: card?.heading ?? entity.course ?? 0,
      level: card?.level ?? 0,
      expected: Boolean(card && (card.returning || isUnderWay(card.order) || card.going)),
      radius: entity.vehicle ? RADIUS.vehicle : RADIUS[shape],
      full: entity.vehicle || entity.named || entity.differs || name === chosen,
    });
  }
  return things;
}

/** In a crowd, keep the symbol of one target in each cell; the others become dots at their positions. */
function thin(things) {
  const crowd = things.filter(({ full }) => !full);
  const taken = new Set(things.filter(({ full }) => full).map(cellOf));
  for (const thing of crowd) {
    const cell = cellOf(thing);
    thing.dot = crowd.length > CROWD && taken.has(cell);
    if (thing.dot) thing.radius = RADIUS.dot;
    taken.add(cell);
  }
}

const cellOf = ({ at: [x, y] }) => `${Math.floor(x / CELL)} ${Math.floor(y / CELL)}`;

function stationsIn(view, places) {
  const found = [];
  for (const [name, place] of places) {
    if (place.ring.length === 0 || place.ring.length > 2) continue;
    const at = view.point(place.ring[0]);
    if (view.sees(at, 20)) found.push({ name, at, section: "places", radius: RADIUS.place, differs: place.differs });
  }
  return found;
}

// --- symbols ---------------------------------------------------------------------------------------------------

/** Draw AIS triangles and vectors in one path for each age: a thousand separate paths are slow. */
function drawTargets({ ctx, view, palette }, things) {
  Object.assign(ctx, { strokeStyle: palette.ais, fillStyle: palette.aisFill });
  for (const age of [LOST, OLD, FRESH]) {
    const theirs = things.filter((thing) => thing.shape === "target" && thing.age === age);
    if (theirs.length === 0) continue;
    ctx.globalAlpha = OPACITY[age];
    const { bodies, vectors, dots, crosses } = targetPaths(view, theirs);
    ctx.setLineDash(age === FRESH ? [] : [3, 2]);
    ctx.fill(bodies);
    ctx.lineWidth = 1.6;
    ctx.stroke(bodies);
    ctx.setLineDash([]);
    ctx.lineWidth = 1.2;
    ctx.stroke(vectors);
    ctx.lineWidth = 1.6;
    if (age === LOST) ctx.stroke(crosses);
    ctx.fillStyle = palette.ais;
    ctx.fill(dots);
    ctx.fillStyle = palette.aisFill;
  }
  ctx.globalAlpha = 1;
}

function targetPaths(view, targets) {
  const paths = { bodies: new Path2D(), vectors: new Path2D(), dots: new Path2D(), crosses: new Path2D() };
  for (const { at, entity, heading, dot, full } of targets) {
    const [x, y] = at;
    if (dot) {
      paths.dots.rect(x - 1.5, y - 1.5, 3, 3);
      continue;
    }
    addTurned(paths.bodies, TRIANGLE, at, heading, full ? 1 : 0.75);
    if (entity.course !== null && entity.speed) addVector(paths.vectors, view, at, entity);
    paths.crosses.moveTo(x - 9, y + 4);
    paths.crosses.lineTo(x + 9, y - 4);
  }
  return paths;
}

/** Mercator preserves angles, so that a course needs no correction. */
function addVector(path, view, [x, y], { at, course, speed }) {
  const metre = view.side / EARTH / Math.cos((at[0] * Math.PI) / 180);
  const length = speed * VECTOR * metre;
  if (length < 12 || length > 5000) return;
  const turn = (course * Math.PI) / 180;
  path.moveTo(x, y);
  path.lineTo(x + Math.sin(turn) * length, y - Math.cos(turn) * length);
}

/** Draw a vehicle or another thing with a position; hollow and dashed when the position is old. */
function drawThing({ ctx, palette }, { at, shape, entity, heading, age }) {
  const path = pathOf(shape);
  ctx.save();
  ctx.translate(...at);
  ctx.rotate(shape === "diamond" ? 0 : (heading * Math.PI) / 180);
  ctx.globalAlpha = OPACITY[age];
  ctx.lineJoin = "round";
  Object.assign(ctx, { lineWidth: 4, strokeStyle: palette.halo });
  ctx.stroke(path);
  ctx.fillStyle = age !== FRESH ? palette.halo : entity.vehicle ? palette.vehicle : palette.seenFill;
  ctx.fill(path);
  Object.assign(ctx, { lineWidth: 1.5, strokeStyle: entity.vehicle ? palette.vehicleInk : palette.seen });
  ctx.setLineDash(age === FRESH ? [] : [3, 2]);
  ctx.stroke(path);
  ctx.restore();
  if (age === LOST) drawCross(ctx, at, palette.levels[3]);
}

function drawCross(ctx, [x, y], colour) {
  Object.assign(ctx, { lineWidth: 2, strokeStyle: colour });
  ctx.beginPath();
  ctx.moveTo(x - 14, y + 6);
  ctx.lineTo(x + 14, y - 6);
  ctx.stroke();
}

function drawStation({ ctx, palette }, { at: [x, y], differs }) {
  Object.assign(ctx, { lineWidth: 1.5, strokeStyle: differs ? palette.differs : palette.place, fillStyle: palette.halo });
  ctx.beginPath();
  ctx.arc(x, y, 4.5, 0, 2 * Math.PI);
  ctx.fill();
  ctx.setLineDash(differs ? [3, 2] : []);
  ctx.stroke();
  ctx.setLineDash([]);
  ctx.fillStyle = palette.place;
  ctx.fillRect(x - 1.25, y - 1.25, 2.5, 2.5);
}

function drawLevel({ ctx, palette, lettering }, { at: [x, y], level }) {
  lettering.draw(ctx, MARKS[level], [x + 8, y - 20], "named", palette.levels[level]);
}

/** Draw corners around the chosen thing, as chart systems do; a thin circle around a thing under the pointer. */
function drawBrackets({ ctx, palette }, { at: [x, y], radius }, isChosen) {
  const half = radius + 6;
  Object.assign(ctx, { lineWidth: isChosen ? 2.5 : 1.5, strokeStyle: palette.chosen });
  ctx.beginPath();
  if (!isChosen) ctx.arc(x, y, half, 0, 2 * Math.PI);
  else
    for (const [right, down] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
      ctx.moveTo(x + right * half, y + down * (half - 6));
      ctx.lineTo(x + right * half, y + down * half);
      ctx.lineTo(x + right * (half - 6), y + down * half);
    }
  ctx.stroke();
}

// --- ways and differences --------------------------------------------------------------------------------------

/**
 * Draw a planned way, with numbered VIA points and a target for its destination. The vehicle is joined to the way only
 * while it flies to the first point: the passed points are not known.
 */
function drawWay(pen, card, entity) {
  const way = wayOf(card);
  if (way.length === 0) return;
  const { ctx, view, palette } = pen;
  const line = lineOf(way);
  const isUntold = !card.returning && card.order.state === "sent";
  const whole = (way.length === 1 || isUntold) && entity ? lineOf([entity.at, ...way]) : line;
  if (!view.seesLine(whole)) return;
  const path = new Path2D();
  view.trace(path, whole);
  Object.assign(ctx, { lineWidth: 2, strokeStyle: palette.way });
  ctx.setLineDash(isUntold ? [2, 5] : [10, 5]);
  ctx.stroke(path);
  ctx.setLineDash([]);
  const points = view.pixels(line);
  points.slice(0, -1).forEach((at, n) => drawVia(pen, at, n + 1));
  drawDestination(pen, points.at(-1));
}

/** Draw the lines to which a vehicle keeps, as wide as the mission lets it stray. */
function drawCorridor({ ctx, view, palette }, { points, strays }) {
  if (!strays || points.length === 0) return;
  const line = lineOf(points);
  const radius = Math.max(1, (strays * view.side) / EARTH / Math.cos((points[0][0] * Math.PI) / 180));
  if (!view.seesLine(line, radius)) return;
  const path = new Path2D();
  if (points.length === 1) path.arc(...view.point(points[0]), radius, 0, 2 * Math.PI);
  else view.trace(path, line);
  ctx.save();
  Object.assign(ctx, { lineWidth: 2 * radius, strokeStyle: palette.wayFill, fillStyle: palette.wayFill, lineCap: "round", lineJoin: "round" });
  if (points.length === 1) ctx.fill(path);
  else ctx.stroke(path);
  ctx.restore();
}

/** Draw the points that show why an invariant about ways is broken, and the line between them. */
function drawBreach({ ctx, view, palette }, { points }) {
  if (points.length === 0) return;
  const line = lineOf(points);
  if (!view.seesLine(line)) return;
  ctx.save();
  Object.assign(ctx, { lineWidth: 2.5, strokeStyle: palette.levels[3] });
  ctx.beginPath();
  const pixels = view.pixels(line);
  pixels.forEach(([x, y], n) => (n === 0 ? ctx.moveTo(x, y) : ctx.lineTo(x, y)));
  ctx.stroke();
  ctx.beginPath();
  for (const [x, y] of pixels) {
    ctx.moveTo(x + 5, y);
    ctx.arc(x, y, 5, 0, 2 * Math.PI);
  }
  ctx.stroke();
  ctx.restore();
}

function drawVia({ ctx, palette, lettering }, [x, y], number) {
  Object.assign(ctx, { lineWidth: 1.5, strokeStyle: palette.way, fillStyle: palette.halo });
  ctx.beginPath();
  ctx.arc(x, y, 8, 0, 2 * Math.PI);
  ctx.fill();
  ctx.stroke();
  const [width, height] = lettering.size(String(number), "small");
  lettering.draw(ctx, String(number), [x - width / 2, y - height / 2], "small", palette.way);
}

function drawDestination({ ctx, palette }, [x, y]) {
  Object.assign(ctx, { lineWidth: 1.5, strokeStyle: palette.way, fillStyle: palette.halo });
  ctx.beginPath();
  ctx.arc(x, y, 8, 0, 2 * Math.PI);
  ctx.fill();
  ctx.moveTo(x + 4, y);
  ctx.arc(x, y, 4, 0, 2 * Math.PI);
  for (const [right, down] of [[1, 0], [0, 1], [-1, 0], [0, -1]]) {
    ctx.moveTo(x + 4 * right, y + 4 * down);
    ctx.lineTo(x + 12 * right, y + 12 * down);
  }
  ctx.stroke();
}

/** Mark a difference of L and P: a dashed ring, and a line from the believed place; faint if a flight explains it. */
function drawDifference({ ctx, view, palette }, { at, entity, radius, expected }, store) {
  Object.assign(ctx, { lineWidth: expected ? 1.2 : 2, strokeStyle: expected ? palette.way : palette.differs });
  ctx.setLineDash([3, 4]);
  ctx.beginPath();
  ctx.arc(...at, radius + 6, 0, 2 * Math.PI);
  const believed = pointOf(view, store, entity.believed);
  if (believed) addLine(ctx, believed, at, radius + 6);
  ctx.stroke();
  ctx.setLineDash([]);
  if (!believed) return;
  ctx.beginPath();
  ctx.arc(...believed, 5, 0, 2 * Math.PI);
  ctx.stroke();
}

function addLine(ctx, from, to, gap) {
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
  if (length <= gap) return;
  const part = (length - gap) / length;
  ctx.moveTo(...from);
  ctx.lineTo(from[0] + (to[0] - from[0]) * part, from[1] + (to[1] - from[1]) * part);
}

/** The pixel of an entity, or of a place's middle; null if it has no position. */
export function pointOf(view, store, name) {
  const entity = store.section("entities").get(name);
  if (entity) return view.point(entity.at);
  const place = store.section("places").get(name);
  if (!place?.ring.length) return null;
  const [left, top, right, bottom] = view.box(lineOf(place.ring));
  return [(left + right) / 2, (top + bottom) / 2];
}

// --- labels ----------------------------------------------------------------------------------------------------

function drawLabels({ ctx, view, palette, lettering }, store, things, stations, { chosen, slots, covered }) {
  const taken = new Boxes();
  for (const box of covered) taken.add(box);
  for (const { at: [x, y], radius, full } of things) if (full) taken.add([x - radius, y - radius, x + radius, y + radius]);
  const wanted = [
    ...things.filter(({ full, shape }) => full || shape === "diamond").map((thing) => thingLabel(thing, chosen)),
    ...targetLabels(things),
    ...stations.map(({ name, at, radius }) => ({ key: `p ${name}`, name, at, radius, font: "place", colour: "place", priority: PRIORITY.place })),
    ...areaLabels(view, store.section("places"), "place", lettering),
    ...areaLabels(view, store.section("fences"), "fence", lettering),
  ];
  const sized = wanted.map((label) => withSize(label, lettering));
  const placed = placeLabels(sized, taken, slots, view);
  for (const { text, corner, font, colour } of placed.toReversed()) lettering.draw(ctx, text, corner, font, palette[colour]);
  return placed;
}

function withSize(label, lettering) {
  const text = label.text ?? drawable(label.name);
  return { ...label, text, size: lettering.size(text, label.font) };
}

function thingLabel({ name, at, radius, entity, shape }, chosen) {
  const isChosen = name === chosen;
  const priority = isChosen ? PRIORITY.chosen : entity.vehicle ? PRIORITY.vehicle : PRIORITY.named;
  const colour = entity.vehicle ? "ink" : shape === "target" ? "ais" : "seen";
  return { key: name, name, at, radius: radius + (isChosen ? 6 : 0), font: entity.vehicle ? "vehicle" : "named", colour, priority, needed: isChosen };
}

function targetLabels(things) {
  const targets = things.filter(({ full, shape, dot }) => !full && !dot && shape === "target");
  if (targets.length > LABELLED) return [];
  return targets.map(({ name, at, radius }) => ({ key: name, name, at, radius, font: "small", colour: "ais", priority: PRIORITY.target }));
}

/** The labels of places and fences: inside at the upper edge, or beside areas too small for that. */
function* areaLabels(view, areas, sort, lettering) {
  for (const [name, { ring }] of areas) {
    if (ring.length < 3 || !view.seesLine(lineOf(ring), 0)) continue;
    const [left, top, right, bottom] = view.box(lineOf(ring));
    const text = sort === "fence" ? `fence of ${drawable(name)}` : undefined;
    const label = withSize({ key: `${sort} ${name}`, name, text, font: "place", colour: sort, priority: PRIORITY[sort] }, lettering);
    if (right - left > label.size[0] + EDGE && bottom - top > ROOMY) yield { ...label, at: shown([left, top, right, bottom], view), radius: 0, centred: true };
    else yield { ...label, at: [(left + right) / 2, (top + bottom) / 2], radius: Math.max(right - left, bottom - top) / 2 };
  }
}

/** The position of a large area's name: near the upper edge of the visible part, clear of its line. */
const shown = ([left, top, right], view) => [(Math.max(0, left) + Math.min(view.width, right)) / 2, Math.max(24, top + 18)];
