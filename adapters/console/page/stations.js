/** The stations of the mission: their connections, the ages of their last messages, and the vehicles that each controls. */
import { html, byName, useSections } from "./ui.js";
import { Age } from "./clock.js";

export function Stations({ app }) {
  const [stations] = useSections(app.store, ["stations"], 500);
  if (stations.size === 0) return html`<p class="none">No other station takes part in this mission: all vehicles obey this one.</p>`;
  return html`<div class="wide"><table class="stations"><thead><tr><th scope="col">Station</th><th scope="col">Heard</th><th scope="col">Reaches us</th><th scope="col">Same L</th><th scope="col">Authority over</th></tr></thead>
    <tbody>${[...stations].sort(([a], [b]) => byName(a, b)).map(([name, station]) => html`<tr key=${name} class=${station.reached === false || station.begun === false ? "bad" : ""}>
      <th scope="row">${name}${station.here ? html` <span class="here">here</span>` : ""}</th>
      <td>${station.here ? "–" : station.heard === null ? "never" : html`<${Age} clock=${app.clock} time=${station.heard} /> ago`}</td>
      <td>${station.here ? "–" : station.reached === null ? "not known" : station.reached ? `yes${station.begun === false ? ", not started" : ""}` : "no"}</td>
      <td class=${station.agrees === false ? "bad" : ""}>${station.here ? "–" : station.agrees === null || station.agrees === undefined ? "not known" : station.agrees ? "yes" : "no: it differs"}</td>
      <td>${station.vehicles.length ? station.vehicles.toSorted(byName).join(", ") : html`<span class="quiet">none</span>`}</td></tr>`)}</tbody></table></div>`;
}
