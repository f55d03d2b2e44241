/** The world edited on the map: handles of the chosen entity, which move and resize it in the text. */
import { html, useState, useWatched } from "/parts/ui.js";

const { L } = globalThis;
const STEP = 8; // pixels that an arrow key moves a handle
const ARROWS = { ArrowUp: [0, -STEP], ArrowDown: [0, STEP], ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0] };
const SHAPES = ["circle", "box", "polygon", "point"];
export const FILES = ".geojson,.json,.plan,.waypoints";

/** The handles of one entity on a Leaflet map; `reshape(points, radius)` is called when one was moved. */
export class Handles {
  #parts = [];
  #focused = "";
  #shown = "";

  constructor(map, reshape) {
    this.map = map;
    this.reshape = reshape;
  }

  /** Show the handles of a shape `{shape, points, radius}`; none for null. */
  show(name, shape) {
    const shown = JSON.stringify([name, shape]);
    if (shown === this.#shown) return; // a handle that is held stays
    this.#shown = shown;
    const focused = this.#parts.find((part) => part.getElement?.() === document.activeElement)?.part ?? "";
    this.clear();
    if (!shape) return;
    this.#focused = focused;
    const outline = this.#add(outlineOf(shape));
    const handle = (part, at, moved) => this.#handle(`${name}: ${part}`, part, at, (to) => outline.setShape(moved(to)), (to) => this.#moved(moved(to)));
    const { points, radius } = shape;
    if (points.length > 1) {
      const centre = middleOf(points);
      handle("move", centre, (to) => ({ ...shape, points: points.map((each) => [each[0] + to[0] - centre[0], each[1] + to[1] - centre[1]]) }));
    }
    points.forEach((point, n) => handle(points.length > 1 ? `corner ${n + 1}` : "move", point, (to) => ({ ...shape, points: points.with(n, to) })));
    if (radius !== null) {
      const [[north, east]] = points;
      const edge = L.circle(points[0], { radius }).addTo(this.map);
      const side = [north, edge.getBounds().getEast()];
      edge.remove();
      handle("radius", side, (to) => ({ ...shape, radius: this.map.distance([north, east], to) }));
    }
  }

  clear() {
    for (const part of this.#parts) part.remove();
    this.#parts = [];
  }

  #moved({ points, radius }) {
    this.#shown = ""; // what is refused goes back
    this.reshape(points.map(([north, east]) => [Math.max(-90, Math.min(90, north)), ((east + 540) % 360) - 180]), radius);
  }

  #add(part) {
    this.#parts.push(part);
    return part.addTo(this.map);
  }

  #handle(title, part, at, preview, done) {
    const icon = L.divIcon({ className: `handle handle-${part.split(" ")[0]}`, iconSize: [16, 16] });
    const marker = this.#add(L.marker(at, { icon, draggable: true, title, alt: title, zIndexOffset: part === "move" ? 0 : 100 }));
    marker.part = part;
    const place = () => [marker.getLatLng().lat, marker.getLatLng().lng];
    marker.on("drag", () => preview(place()));
    marker.on("dragend", () => done(place()));
    const element = marker.getElement();
    element.addEventListener("keydown", (event) => {
      const by = ARROWS[event.key];
      if (!by) return;
      event.preventDefault();
      event.stopPropagation();
      const { lat, lng } = this.map.unproject(this.map.project(marker.getLatLng()).add(by));
      done([lat, lng]);
    });
    if (part === this.#focused) element.focus();
  }
}

function outlineOf(shape) {
  const style = { className: "handle-outline", interactive: false, weight: 2, fill: false };
  const outline = shape.radius !== null ? L.circle(shape.points[0], { ...style, radius: shape.radius }) : L.polygon(ringOf(shape), style);
  outline.setShape = (next) => (next.radius !== null ? outline.setLatLng(next.points[0]).setRadius(next.radius) : outline.setLatLngs(ringOf(next)));
  return outline;
}

function ringOf({ shape, points }) {
  if (shape !== "box") return points;
  const [[north, east], [south, west]] = points;
  return [[north, east], [north, west], [south, west], [south, east]];
}

function middleOf(points) {
  return [0, 1].map((n) => points.reduce((sum, point) => sum + point[n], 0) / points.length);
}

/** The tools that draw: on or off, a new entity in the middle of the map, and files of places. */
export function DrawingTools({ app }) {
  const drawing = useWatched(app.drawing);
  const { kinds } = useWatched(app.shapes);
  const [kind, setKind] = useState("");
  const [shape, setShape] = useState("circle");
  const taken = kinds.includes(kind) ? kind : kinds[0] ?? "";
  return html`<button type="button" aria-pressed=${String(drawing)} title="move and resize the chosen entity; the text changes with it" onClick=${() => app.drawing.set(!drawing)}>Draw</button>
    ${drawing && html`<select aria-label="kind" value=${taken} onChange=${(event) => setKind(event.currentTarget.value)}>${kinds.map((each) => html`<option key=${each} value=${each}>${each}</option>`)}</select>
      <select aria-label="shape" value=${shape} onChange=${(event) => setShape(event.currentTarget.value)}>${SHAPES.map((each) => html`<option key=${each} value=${each}>${each}</option>`)}</select>
      <button type="button" disabled=${!taken} title="in the middle of the map" onClick=${() => app.add(taken, shape)}>Add</button>
      <label class="button">Take a file<input class="unseen" type="file" accept=${FILES} onChange=${(event) => { app.drop(event.currentTarget.files); event.currentTarget.value = ""; }} /></label>`}`;
}
