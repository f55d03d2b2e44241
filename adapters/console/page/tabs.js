/** The panels under the cards; on a phone, the map and the cards are tabs as well. */
import { html, Tabs, useEffect, useState, useWatched } from "./ui.js";
import { Actions } from "./actions.js";
import { Bigraph } from "./bigraph.js";
import { Agents, Steps } from "./lanes.js";
import { Stations } from "./stations.js";

export const PANELS = [
  ["actions", "Actions", Actions],
  ["bigraph", "Bigraph", Bigraph],
  ["steps", "Steps", Steps],
  ["agents", "Agents", Agents],
  ["stations", "Stations", Stations],
];
const AREAS = [["map", "Map"], ["vehicles", "Vehicles"]];
const PHONE = matchMedia("(max-width: 760px)");

export function usePhone() {
  const [phone, set] = useState(PHONE.matches);
  useEffect(() => {
    const changed = () => set(PHONE.matches);
    PHONE.addEventListener("change", changed);
    return () => PHONE.removeEventListener("change", changed);
  }, []);
  return phone;
}

/** The open tab; on a desk the map and the cards are always visible, so that it is one of the panels. */
export const openTab = (tab, phone) => (!phone && AREAS.some(([key]) => key === tab) ? "actions" : tab);

export function TabList({ app, phone }) {
  const tab = openTab(useWatched(app.tab), phone);
  const tabs = phone ? [...AREAS, ...PANELS] : PANELS;
  const panelOf = (key) => (AREAS.some(([each]) => each === key) ? `area-${key}` : "panel");
  return html`<${Tabs} label="Panels" tabs=${tabs} chosen=${tab} choose=${(key) => app.tab.set(key)} panelOf=${panelOf} />`;
}

export function Panel({ app, phone }) {
  const tab = openTab(useWatched(app.tab), phone);
  const large = useWatched(app.enlarged);
  const found = PANELS.find(([key]) => key === tab);
  if (!found) return null;
  return html`<div role="tabpanel" id="panel" class="panel" aria-labelledby=${`tab-${tab}`} tabindex="-1">
    ${!phone && html`<button type="button" class="enlarge icon" aria-pressed=${String(large)} title="enlarge  E" aria-label="enlarge the panel" onClick=${() => app.enlarged.set(!large)}>⤢</button>`}
    <${found[2]} app=${app} /></div>`;
}
