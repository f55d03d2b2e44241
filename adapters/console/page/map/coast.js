/** The land under all other layers, fetched in windows somewhat larger than the view. */
const { L } = globalThis;

const KEPT = 12;
const MARGIN = 0.5;

/**
 * The window to fetch for a view [south, west, north, east]: snapped to a grid of powers of two, so that a small move
 * needs no other window. Its west lies between -180 and 180; `turns` times 360 brings its longitudes back to the view.
 */
export function windowFor([south, west, north, east]) {
  const size = 2 ** Math.ceil(Math.log2(Math.max(north - south, east - west) * MARGIN));
  const down = (value) => Math.floor(value / size - MARGIN) * size;
  const up = (value) => Math.ceil(value / size + MARGIN) * size;
  const turns = Math.floor((down(west) + 180) / 360);
  const [left, right] = [down(west) - 360 * turns, up(east) - 360 * turns];
  return { south: Math.max(-90, down(south)), west: left, north: Math.min(90, up(north)), east: Math.min(left + 360, right), turns };
}

const addressOf = ({ south, west, north, east }) => `/land?south=${south}&west=${west}&north=${north}&east=${east}`;

/** The layer with the land in the map's view; `tell(problem)` receives a failure, or an empty text. */
export class Coast {
  #map;
  #fetchJson;
  #tell;
  #layer;
  #pieces = new Map();
  #shown = "";

  constructor(map, { fetchJson, tell }) {
    [this.#map, this.#fetchJson, this.#tell] = [map, fetchJson, tell];
    const pane = map.createPane("land");
    pane.style.zIndex = 150;
    this.#layer = L.geoJSON(null, { interactive: false, renderer: L.canvas({ pane: "land", padding: 0.5 }), pane: "land" });
    this.#layer.addTo(map);
    map.on("moveend", () => this.show());
  }

  dress({ land, coast }) {
    this.#layer.options.style = { fillColor: land, fillOpacity: 1, color: coast, weight: 1, opacity: 1 };
    this.#layer.setStyle(this.#layer.options.style);
  }

  async show() {
    const window = windowFor(viewOf(this.#map));
    const key = `${addressOf(window)} ${window.turns}`;
    if (key === this.#shown) return;
    this.#shown = key;
    try {
      const found = await this.#get(addressOf(window));
      if (this.#shown !== key) return; // the view has moved on
      this.#layer.options.coordsToLatLng = ([east, north]) => L.latLng(north, east + 360 * window.turns);
      this.#layer.clearLayers();
      this.#layer.addData(found);
      this.#tell("");
    } catch (problem) {
      if (this.#shown === key) this.#shown = "";
      this.#tell(`No coast: ${problem.message}`);
    }
  }

  #get(address) {
    const kept = this.#pieces.get(address);
    if (kept) return kept;
    if (this.#pieces.size >= KEPT) this.#pieces.delete(this.#pieces.keys().next().value);
    const asked = this.#fetchJson(address);
    this.#pieces.set(address, asked);
    asked.catch(() => this.#pieces.delete(address));
    return asked;
  }
}

function viewOf(map) {
  const bounds = map.getBounds();
  return [bounds.getSouth(), bounds.getWest(), bounds.getNorth(), bounds.getEast()];
}
