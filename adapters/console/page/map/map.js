/**
 * The chart: the store's content, over a coast or over tiles. It is drawn only after a change. Everything is at its last
 * known position: nothing is interpolated.
 */
import { Coast } from "./coast.js";
import { describe, summary } from "./describe.js";
import { bearing, boundsOf, distance } from "./geodesy.js";
import { hitAt } from "./hits.js";
import { element, northArrow, say, Scale } from "./instruments.js";
import { listenForKeys, listenForPointer, TOLERANCE } from "./input.js";
import { Legend } from "./legend.js";
import { Measure } from "./measure.js";
import { drawMoving, pointOf } from "./moving.js";
import { drawStill } from "./still.js";
import { Surface } from "./surface.js";
import { Tiles } from "./tiles.js";
import { Tracks } from "./tracks.js";
import { angle, position, range, system } from "../units.js";

const { L } = globalThis;

const EARTH = 40075016.7;
const SECTIONS = ["places", "fences", "entities", "vehicles", "tracks", "clock"];
const STILL = ["places", "fences"];
const SUMMARY = 3000; // milliseconds between two texts for screen readers
const CREDIT = "Coast: Natural Earth, good to about 1 km. Not for navigation.";
const EDGE = 20; // the least pixels between a chosen thing and the edge

/**
 * Show a store's state on a map in an element. The map calls `select(name)` when the operator chooses a thing, with null
 * for nothing. It calls `followed(null)` and `measured(false)`, which are optional, when it ends following or measuring.
 * `covers()` returns the elements of the page that lie over the map, `hidden()` the names that it does not show.
 */
export function createMap(container, store, options) {
  return new Chart(container, store, options);
}

class Chart {
  #store;
  #options;
  #parts;
  #surface;
  #coast;
  #tiles = null;
  #tracks;
  #measure = new Measure();
  #theme = "light";
  #drawn = { hits: [], labels: [] };
  #slots = new Map();
  #chosen = null;
  #hovered = null;
  #following = null;
  #pointer = null;
  #pixel = null;
  #isFitted = false;
  #second = NaN;
  #summaryTimer = null;
  #ends = [];

  constructor(container, store, { select, fetchJson, tiles = null, followed = () => {}, measured = () => {}, covers = () => [], hidden = () => new Set() }) {
    this.#store = store;
    this.#options = { select, followed, measured, covers, hidden };
    this.#tracks = new Tracks(store.section("tracks"));
    this.#tracks.update([]);
    this.#parts = addParts(container);
    this.#surface = new Surface(this.#parts.leaflet, { still: (pen) => this.#drawStill(pen), moving: (pen) => this.#drawMoving(pen) });
    L.control.zoom({ position: "topleft", zoomInTitle: "closer  +", zoomOutTitle: "farther  −" }).addTo(this.#surface.map);
    this.#coast = new Coast(this.#surface.map, { fetchJson, tell: (problem) => say(this.#parts.problem, problem) });
    this.setTheme("light");
    this.#listen();
    this.#fitFirst();
    this.#coast.show();
    this.#describeSoon();
    if (tiles) this.#openTiles(tiles);
  }

  // --- for the page ----------------------------------------------------------------------------------------------

  /** Mark a thing as chosen, and bring it into view; null for none. */
  choose(name) {
    this.#chosen = name;
    const at = name === null ? null : this.pointOf(name);
    if (at && !this.#surface.view.sees(at, -EDGE)) this.#centreOn(name);
    this.#sayPosition();
    if (document.activeElement === this.#parts.leaflet) say(this.#parts.told, name === null ? "" : describe(name, this.#store, this.#now).join(", "));
    this.#surface.invalidate("moving");
  }

  /** Keep a thing in the middle; null for none. */
  follow(name) {
    this.#following = name;
    if (name !== null) this.#centreOn(name);
  }

  /** Begin measuring anew, or end it. */
  measure(on) {
    this.#measure.set(on);
    this.#parts.leaflet.classList.toggle("measuring", on);
    this.#sayMeasure();
    this.#surface.invalidate("moving");
  }

  /** Fit the view to the mission's places and entities, else to other targets; return whether there are any. */
  fit() {
    const bounds = boundsOf(pointsToFit(this.#store));
    if (!bounds || this.#surface.isHidden) return false;
    const [south, west, north, east] = bounds;
    this.#surface.map.fitBounds([[south, west], [north, east]], { padding: [48, 48], maxZoom: 16, animate: false });
    return true;
  }

  /** Centre the view on a position, at a zoom level of Leaflet. */
  look(at, zoom) {
    this.#isFitted = true;
    this.#surface.map.setView(at, zoom, { animate: false });
  }

  /** Draw anew, also after a change of the element's size. */
  redraw() {
    this.#surface.map.invalidateSize({ animate: false });
    this.#surface.invalidate();
    this.#fitFirst();
    if (this.#hovered !== null) this.#hover(null); // the named thing lies elsewhere now
  }

  setTheme(theme) {
    this.#theme = theme === "dark" ? "dark" : "light";
    this.#parts.leaflet.parentElement.dataset.theme = this.#theme;
    this.#surface.dress(this.#theme);
    this.#parts.legend.dress(this.#surface.palette);
    this.#coast.dress(this.#surface.palette);
    this.#tiles?.dress(this.#theme);
  }

  /** Copy the pointer's position, or the middle's if the pointer is not on the map; returns the text. */
  copyPosition() {
    const text = position(this.#pointer ?? this.#surface.centre);
    const told = (words) => say(this.#parts.told, words);
    const copied = navigator.clipboard?.writeText(text) ?? Promise.reject(new Error("no clipboard"));
    copied.then(() => told(`${text} copied`), () => told(`The browser does not let this page copy ${text}`));
    return text;
  }

  /** The Leaflet map, for what a page adds to it. */
  get leaflet() {
    return this.#surface.map;
  }

  /** The map as it is seen now: a PNG, with the time and the sources. */
  async picture() {
    this.#surface.draw();
    const { leaflet, credit } = this.#parts;
    const { left, top, width, height } = leaflet.getBoundingClientRect();
    if (!width || !height) throw new Error("the map is not shown");
    const ratio = globalThis.devicePixelRatio || 1;
    const made = Object.assign(document.createElement("canvas"), { width: width * ratio, height: height * ratio });
    const ctx = made.getContext("2d");
    ctx.scale(ratio, ratio);
    ctx.fillStyle = this.#surface.palette.sea;
    ctx.fillRect(0, 0, width, height);
    for (const each of leaflet.querySelectorAll("canvas, img.leaflet-tile")) {
      const box = each.getBoundingClientRect();
      if (box.width) ctx.drawImage(each, box.left - left, box.top - top, box.width, box.height);
    }
    Object.assign(ctx, { font: "12px system-ui, sans-serif", fillStyle: this.#surface.palette.ink, textBaseline: "bottom" });
    ctx.fillText(`${new Date(this.#now * 1000).toISOString().slice(0, 19)}Z · ${credit.textContent}`, 8, height - 6);
    return new Promise((resolve, reject) => made.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the browser draws no picture"))), "image/png"));
  }

  // --- for tests and screen readers ------------------------------------------------------------------------------

  /** The thing at a pixel of the map: {name, section}, or null. */
  hit(x, y, tolerance = TOLERANCE.mouse) {
    this.#surface.draw();
    return hitAt([x, y], this.#drawn.hits, this.#store.section("places"), this.#surface.view, tolerance);
  }

  /** The pixel [x, y] of a thing, null if it has no position. */
  pointOf(name) {
    return pointOf(this.#surface.view, this.#store, name);
  }

  /** The pixel [x, y] of a position. */
  pixelOf(position) {
    return this.#surface.view.point(position);
  }

  /** The last drawing: its things and labels, the window [south, west, north, east], zoom, and the number of frames. */
  drawn() {
    this.#surface.draw();
    const { map, window, frames } = this.#surface;
    return { ...this.#drawn, window, zoom: map.getZoom(), frames };
  }

  /** The chart in words. */
  summary() {
    return summary(this.#store, this.#now, this.#surface.centre);
  }

  destroy() {
    clearTimeout(this.#summaryTimer);
    for (const end of this.#ends) end();
    this.#surface.destroy();
    for (const part of Object.values(this.#parts)) (part.element ?? part).remove?.();
  }

  // --- the operator's input --------------------------------------------------------------------------------------

  click(pixel, at, tolerance) {
    if (this.#measure.on) return this.#addPoint(this.#snapped(pixel, at, tolerance));
    this.#select(this.hit(...pixel, tolerance)?.name ?? null);
  }

  /** Act like a click at the middle of the map, for measuring by keyboard. */
  clickMiddle() {
    if (!this.#measure.on) return false;
    this.#addPoint(this.#surface.centre);
    return true;
  }

  point(pixel, at) {
    this.#pointer = at;
    this.#pixel = pixel;
    this.#hover(pixel);
    if (this.#measure.on) {
      this.#measure.point(at && this.#snapped(pixel, at, TOLERANCE.mouse));
      this.#sayMeasure();
      this.#surface.invalidate("moving");
    }
    this.#sayPosition();
  }

  drag() {
    if (this.#following === null) return;
    this.#following = null;
    this.#options.followed(null);
  }

  undo() {
    if (!this.#measure.on) return false;
    this.#measure.undo();
    this.#sayMeasure();
    this.#surface.invalidate("moving");
    return true;
  }

  /** End measuring, or choose nothing. */
  escape() {
    if (this.#measure.on) {
      this.measure(false);
      this.#options.measured(false);
      return true;
    }
    if (this.#chosen === null) return false;
    this.#select(null);
    return true;
  }

  /** Show or hide the legend. */
  toggleLegend() {
    this.#parts.legend.toggle();
  }

  // --- within ----------------------------------------------------------------------------------------------------

  get #now() {
    return this.#store.section("clock").get("now") ?? Date.now() / 1000;
  }

  #listen() {
    const { map } = this.#surface;
    this.#ends.push(this.#store.on(SECTIONS, (changed) => this.#hear(changed)));
    listenForPointer(map, this);
    listenForKeys(this.#parts.leaflet, this);
    map.on("move zoomend resize", () => this.#sayScale());
    map.on("moveend", () => this.#pointAgain());
    this.#ends.push(system.on(() => this.#measureAnew()));
    const sizes = new ResizeObserver(() => this.redraw());
    sizes.observe(this.#parts.leaflet);
    this.#ends.push(() => sizes.disconnect());
    this.#sayScale();
  }

  #hear(changed) {
    const isStill = STILL.some((name) => changed[name]);
    const isTrack = changed.tracks ? this.#tracks.update(changed.tracks) : false;
    if (isStill || isTrack) this.#surface.invalidate("still");
    const second = Math.floor(this.#now);
    const isOnlyClock = Object.keys(changed).length === 1 && changed.clock;
    if (isOnlyClock && second === this.#second) return; // ages alone change once a second
    this.#second = second;
    this.#surface.invalidate("moving");
    this.#fitFirst();
    if (this.#following !== null) this.#centreOn(this.#following);
    this.#describeSoon();
  }

  /** Fit the view once at the beginning, when there is something to show; afterwards the operator moves it. */
  #fitFirst() {
    if (!this.#isFitted) this.#isFitted = this.fit();
  }

  #centreOn(name) {
    const at = whereIs(this.#store, name);
    if (!at) return;
    const { map, view } = this.#surface;
    const [x, y] = view.point(at);
    if (Math.hypot(x - view.width / 2, y - view.height / 2) >= 1) map.setView(map.containerPointToLatLng([x, y]), map.getZoom(), { animate: false });
  }

  #select(name) {
    if (name === this.#chosen) return;
    this.choose(name);
    this.#options.select(name);
  }

  /** Update the pointer's position after the map has moved under it, as it does while it follows a thing. */
  #pointAgain() {
    if (!this.#pixel) return;
    const { lat, lng } = this.#surface.map.containerPointToLatLng(this.#pixel);
    this.point(this.#pixel, [lat, lng]);
  }

  /** Show and draw all figures again, in other units. */
  #measureAnew() {
    this.#sayScale();
    this.#sayPosition();
    this.#sayMeasure();
    this.#surface.invalidate();
  }

  /** The position of a thing or a place's corner within the tolerance, else the point itself. */
  #snapped(pixel, at, tolerance) {
    const { view } = this.#surface;
    const corners = [...this.#store.section("places").values()].flatMap(({ ring }) => ring);
    const positions = [...this.#drawn.hits.map(({ name }) => whereIs(this.#store, name)), ...corners].filter(Boolean);
    return nearestWithin(positions, (each) => view.point(each), pixel, tolerance) ?? at;
  }

  #addPoint(at) {
    this.#measure.add(at);
    this.#sayMeasure();
    this.#surface.invalidate("moving");
  }

  #hover(pixel) {
    const hit = pixel && !this.#measure.on ? this.hit(...pixel) : null;
    const name = hit?.name ?? null;
    if (name !== this.#hovered) this.#surface.invalidate("moving");
    this.#hovered = name;
    this.#parts.leaflet.classList.toggle("pointing", name !== null);
    showTip(this.#parts.tip, name === null ? [] : describe(name, this.#store, this.#now), pixel, this.#surface.view);
  }

  #sayMeasure() {
    say(this.#parts.measured, this.#measure.on ? this.#measure.words() : "");
  }

  /** Show the pointer's position, and its range and bearing from the chosen thing. */
  #sayPosition() {
    const from = this.#chosen === null ? null : whereIs(this.#store, this.#chosen);
    const at = this.#pointer;
    say(this.#parts.position, at ? position(at) : `middle of the map: ${position(this.#surface.centre)}`);
    say(this.#parts.from, at && from ? `${range(distance(from, at))} ${angle(bearing(from, at))} from the chosen` : "");
  }

  #sayScale() {
    const { view, centre } = this.#surface;
    this.#parts.scale.show((EARTH * Math.cos((centre[0] * Math.PI) / 180)) / view.side);
    if (!this.#pointer) this.#sayPosition();
  }

  #describeSoon() {
    this.#summaryTimer ??= setTimeout(() => {
      this.#summaryTimer = null;
      say(this.#parts.summary, this.summary());
    }, Number.isNaN(this.#second) ? 0 : SUMMARY);
  }

  async #openTiles(tiles) {
    try {
      const [opened, credit] = await Tiles.open(this.#surface.map, tiles);
      this.#tiles = opened;
      opened.dress(this.#theme);
      if (credit) say(this.#parts.credit, `${CREDIT} Tiles: ${credit}`);
    } catch (problem) {
      say(this.#parts.problem, `No tiles: ${problem.message}`);
    }
  }

  /** The boxes of elements over the chart; labels avoid them. */
  get #covered() {
    const { left, top } = this.#parts.leaflet.getBoundingClientRect();
    const over = [...this.#parts.leaflet.querySelectorAll(".leaflet-control"), this.#parts.north, this.#parts.legend.element, ...this.#parts.foot.children, ...this.#options.covers()];
    return over.map((each) => each.getBoundingClientRect()).filter(({ width }) => width > 0)
      .map((box) => [box.left - left, box.top - top, box.right - left, box.bottom - top]);
  }

  #drawStill(pen) {
    drawStill(pen, this.#store, this.#tracks, this.#covered);
  }

  #drawMoving(pen) {
    const marks = { now: this.#now, chosen: this.#chosen, hovered: this.#hovered, slots: this.#slots, covered: this.#covered, hidden: this.#options.hidden() };
    this.#drawn = drawMoving(pen, this.#store, this.#tracks, marks);
    this.#measure.draw(pen);
  }
}

/** The elements of a map, in reading order. */
function addParts(container) {
  container.classList.add("chart");
  const scale = new Scale();
  const parts = {
    leaflet: element("div", "map-leaflet"),
    summary: element("p", "map-summary"),
    north: northArrow(),
    foot: element("div", "map-foot"),
    tip: element("div", "map-tip"),
  };
  const legend = new Legend();
  const foot = {
    scaleElement: scale.element,
    position: element("output", "map-position"),
    from: element("output", "map-from"),
    measured: element("output", "map-measured"),
    told: element("output", "map-told"),
    problem: element("output", "map-problem"),
    credit: element("span", "map-credit", CREDIT),
  };
  parts.foot.append(...Object.values(foot));
  parts.summary.id = `map-summary-${Math.random().toString(36).slice(2)}`;
  parts.leaflet.tabIndex = 0;
  describeForReaders(parts);
  for (const part of [foot.from, foot.measured, foot.told, foot.problem]) part.hidden = true;
  parts.tip.hidden = true;
  container.append(...Object.values(parts), legend.element);
  return { ...parts, ...foot, scale, legend };
}

function describeForReaders({ leaflet, summary: words, tip }) {
  leaflet.setAttribute("role", "application");
  leaflet.setAttribute("aria-roledescription", "chart");
  leaflet.setAttribute("aria-label", "Chart. Arrows move it, plus and minus enlarge it, J and K go from vehicle to vehicle.");
  leaflet.setAttribute("aria-describedby", words.id);
  tip.setAttribute("aria-hidden", "true"); // the summary has it
}

/** Show lines beside a pixel, on the side where there is room. */
function showTip(tip, lines, pixel, { width, height }) {
  tip.hidden = lines.length === 0;
  if (tip.hidden) return;
  tip.replaceChildren(...lines.map((line) => element("div", "", line)));
  const [x, y] = pixel;
  const left = x + 18 + tip.offsetWidth > width ? x - 18 - tip.offsetWidth : x + 18;
  const top = y + 14 + tip.offsetHeight > height ? y - 14 - tip.offsetHeight : y + 14;
  tip.style.transform = `translate(${Math.max(0, Math.round(left))}px, ${Math.max(0, Math.round(top))}px)`;
}

/** The position drawn nearest to a pixel, null if none is within the tolerance. */
function nearestWithin(positions, pixelOf, [x, y], tolerance) {
  let best = { position: null, distance: tolerance };
  for (const position of positions) {
    const [east, south] = pixelOf(position);
    const distance = Math.hypot(east - x, south - y);
    if (distance <= best.distance) best = { position, distance };
  }
  return best.position;
}

/** The position of an entity, or the first point of a place's ring. */
function whereIs(store, name) {
  return store.section("entities").get(name)?.at ?? store.section("places").get(name)?.ring[0] ?? null;
}

function pointsToFit(store) {
  const entities = [...store.section("entities").values()];
  const known = entities.filter(({ vehicle, named }) => vehicle || named);
  const rings = ["places", "fences"].flatMap((name) => [...store.section(name).values()].map(({ ring }) => ring));
  const points = [...rings.flat(), ...known.map(({ at }) => at)];
  return points.length ? points : entities.map(({ at }) => at);
}
