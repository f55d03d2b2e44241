/** Which targets the map shows: by kind, motion, and distance from the nearest vehicle. Vehicles and named entities always are. */
import { distance } from "./map/geodesy.js";
import { html, byName, useSections, useWatched, Watched } from "./ui.js";
import { MILE, range, system } from "./units.js";

const RANGES = [1, 2, 5, 10, 20];
/** Metres a second above which a target moves: an anchored ship's position wanders. */
const MOVES = 0.5;
/** Milliseconds for which a choice of targets is kept: distances to vehicles are not computed for each frame. */
const KEPT = 1000;

const ANY = { kind: "", moving: false, within: 0 };

export class Targets {
  wanted = new Watched(ANY);
  #store;
  #hidden = new Set();
  #until = 0;

  constructor(store) {
    this.#store = store;
    this.wanted.on(() => (this.#until = 0));
  }

  /** The names of the targets that are not shown now. */
  get hidden() {
    const wanted = this.wanted.value;
    if (wanted === ANY) return NONE;
    if (performance.now() > this.#until) {
      const entities = [...this.#store.section("entities")];
      const vehicles = entities.filter(([, { vehicle }]) => vehicle).map(([, { at }]) => at);
      this.#hidden = new Set(entities.filter(([, entity]) => !isShown(entity, wanted, vehicles)).map(([name]) => name));
      this.#until = performance.now() + KEPT;
    }
    return this.#hidden;
  }
}

const NONE = new Set();

function isShown({ vehicle, named, kind, speed, at }, wanted, vehicles) {
  if (vehicle || named) return true;
  if (wanted.kind && kind !== wanted.kind) return false;
  if (wanted.moving && !(speed > MOVES)) return false;
  return !wanted.within || vehicles.some((each) => distance(each, at) <= wanted.within * MILE);
}

export function TargetFilter({ app }) {
  const [entities] = useSections(app.store, ["entities"], 1000);
  const wanted = useWatched(app.targets.wanted);
  useWatched(system);
  const others = [...entities.values()].filter(({ vehicle, named }) => !vehicle && !named);
  if (others.length === 0 && wanted === ANY) return null;
  const kinds = [...new Set(others.map(({ kind }) => kind).filter(Boolean))].sort(byName);
  const set = (change) => {
    const next = { ...wanted, ...change };
    app.targets.wanted.set(Object.keys(ANY).every((key) => next[key] === ANY[key]) ? ANY : next);
    app.map?.redraw();
  };
  const hidden = app.targets.hidden.size;
  return html`<details class="targets"><summary>Targets${hidden > 0 ? ` · ${hidden} hidden` : ""}</summary><div>
    <label>Kind <select value=${wanted.kind} onChange=${(event) => set({ kind: event.currentTarget.value })}><option value="">any</option>${kinds.map((kind) => html`<option key=${kind} value=${kind}>${kind}</option>`)}</select></label>
    <label>Within <select value=${String(wanted.within)} onChange=${(event) => set({ within: Number(event.currentTarget.value) })}><option value="0">any distance</option>${RANGES.map((miles) => html`<option key=${miles} value=${String(miles)}>${range(miles * MILE)} of a vehicle</option>`)}</select></label>
    <label><input type="checkbox" checked=${wanted.moving} onChange=${(event) => set({ moving: event.currentTarget.checked })} /> moving only</label>
  </div></details>`;
}
