/** Leaflet's map with two canvases over it; after a change they are drawn at the screen's next frame. */
import { Lettering } from "./lettering.js";
import { PALETTES } from "./palette.js";
import { View } from "./projection.js";

const { L } = globalThis;

const OPTIONS = {
  attributionControl: false, zoomControl: false, fadeAnimation: false, zoomAnimation: false, markerZoomAnimation: false,
  minZoom: 2, maxZoom: 19, zoomSnap: 0.25, wheelPxPerZoomLevel: 90, maxBounds: [[-85, -1e6], [85, 1e6]], maxBoundsViscosity: 1,
};

export class Surface {
  frames = 0;
  #painters;
  #layers;
  #dirty = new Set();
  #frame = 0;
  #ratio = 0;

  /** `painters` are called with a pen, by the canvas's name: {still, moving}. */
  constructor(element, painters) {
    this.element = element;
    this.#painters = painters;
    this.map = L.map(element, OPTIONS).setView([20, 0], 3, { animate: false });
    this.#layers = new Map(Object.keys(painters).map((name) => [name, addCanvas(element, name)]));
    this.map.on("move zoom viewreset resize", () => this.invalidate());
    this.dress("light");
  }

  dress(theme) {
    this.palette = PALETTES[theme];
    this.element.style.setProperty("--sea", this.palette.sea);
    this.#ratio = 0; // letters have the theme's halo
    this.invalidate();
  }

  /** Mark canvases to be drawn again; all if none is named. */
  invalidate(...names) {
    for (const name of names.length ? names : this.#layers.keys()) this.#dirty.add(name);
    this.#frame ||= requestAnimationFrame(() => this.draw());
  }

  /** Draw the marked canvases now. */
  draw() {
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    if (this.#dirty.size === 0) return;
    this.#fit();
    const view = this.view;
    for (const [name, { canvas, ctx }] of this.#layers) {
      if (!this.#dirty.delete(name)) continue;
      ctx.setTransform(1, 0, 0, 1, 0, 0);
      ctx.clearRect(0, 0, canvas.width, canvas.height);
      ctx.scale(this.#ratio, this.#ratio);
      this.#painters[name]({ ctx, view, palette: this.palette, lettering: this.lettering });
    }
    this.frames++;
  }

  /** The visible part, in Leaflet's rounded pixels. */
  get view() {
    const { x: width, y: height } = this.map.getSize();
    const { x: left, y: top } = this.map.getPixelBounds().min;
    return new View({ left, top, side: 256 * 2 ** this.map.getZoom(), width, height });
  }

  get centre() {
    const { lat, lng } = this.map.getCenter();
    return [lat, lng];
  }

  /** [south, west, north, east]. */
  get window() {
    const bounds = this.map.getBounds();
    return [bounds.getSouth(), bounds.getWest(), bounds.getNorth(), bounds.getEast()];
  }

  get isHidden() {
    return this.element.clientWidth === 0 || this.element.clientHeight === 0;
  }

  destroy() {
    cancelAnimationFrame(this.#frame);
    this.map.remove();
  }

  /** Fit the canvases to the screen's resolution. */
  #fit() {
    const ratio = globalThis.devicePixelRatio || 1;
    const { x, y } = this.map.getSize();
    if (ratio !== this.#ratio) this.lettering = new Lettering(this.palette.halo, ratio);
    this.#ratio = ratio;
    for (const [name, { canvas }] of this.#layers) {
      if (canvas.width === Math.round(x * ratio) && canvas.height === Math.round(y * ratio)) continue;
      [canvas.width, canvas.height] = [Math.round(x * ratio), Math.round(y * ratio)];
      [canvas.style.width, canvas.style.height] = [`${x}px`, `${y}px`];
      this.#dirty.add(name);
    }
  }
}

function addCanvas(element, name) {
  const canvas = document.createElement("canvas");
  canvas.className = `map-canvas ${name}`;
  canvas.setAttribute("aria-hidden", "true");
  element.append(canvas);
  return { canvas, ctx: canvas.getContext("2d") };
}
