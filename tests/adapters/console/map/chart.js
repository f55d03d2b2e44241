/** The chart with its own store, into which the tests put frames. */
import { createMap } from "/parts/map/map.js";
import * as geodesy from "/parts/map/geodesy.js";
import * as words from "/parts/map/words.js";
import { Store } from "/parts/store.js";

const headers = { Authorization: "Bearer looks-on" };

async function fetchJson(path) {
  const answer = await fetch(path, { headers });
  if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
  return answer.json();
}

const heard = { selected: [], followed: [], measured: [] };
const store = new Store();
const asked = new URLSearchParams(location.search);
const map = createMap(document.getElementById("map"), store, {
  select: (name) => heard.selected.push(name),
  followed: (name) => heard.followed.push(name),
  measured: (on) => heard.measured.push(on),
  fetchJson,
  tiles: asked.has("tiles") ? { url: "/tiles", headers } : null,
});
if (asked.has("theme")) map.setTheme(asked.get("theme"));
Object.assign(globalThis, { map, store, heard, geodesy, words });
document.body.dataset.ready = "yes";
