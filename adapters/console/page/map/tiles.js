/** The operator's own chart, a file of PMTiles from the server: vector or raster, over the coast. */
const { L, pmtiles, protomapsL } = globalThis;

const VECTOR = 1;

export class Tiles {
  #map;
  #source;
  #header;
  #layer = null;

  /** Open `{url, headers}`; return the tiles and their attribution. */
  static async open(map, { url, headers }) {
    const source = new pmtiles.PMTiles(new pmtiles.FetchSource(new URL(url, location.href).href, new Headers(headers)));
    const header = await source.getHeader();
    const metadata = await source.getMetadata().catch(() => ({}));
    return [new Tiles(map, source, header), plain(metadata?.attribution)];
  }

  constructor(map, source, header) {
    [this.#map, this.#source, this.#header] = [map, source, header];
  }

  dress(theme) {
    this.#layer?.remove();
    this.#layer = this.#header.tileType === VECTOR ? this.#vector(theme) : this.#raster(theme);
    this.#layer.addTo(this.#map);
  }

  #vector(theme) {
    const layer = protomapsL.leafletLayer({ url: this.#source, flavor: theme, lang: "en", attribution: "", maxDataZoom: this.#header.maxZoom });
    layer.backgroundColor = undefined; // the coast shows through where tiles are missing
    return layer;
  }

  #raster(theme) {
    const { minZoom, maxZoom } = this.#header;
    const className = theme === "dark" ? "tiles-dimmed" : "";
    return pmtiles.leafletRasterLayer(this.#source, { attribution: "", minNativeZoom: minZoom, maxNativeZoom: maxZoom, className });
  }
}

/** The words of an attribution, which may be written in HTML. */
function plain(attribution) {
  if (typeof attribution !== "string") return "";
  return new DOMParser().parseFromString(attribution, "text/html").body.textContent.trim().slice(0, 200);
}
