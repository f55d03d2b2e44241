/** The start panel: the readiness of each vehicle, the links of other stations, the checks, and the Start button. */
import { html, byName, useSections, useWatched } from "./ui.js";
import { Battery, LinkAge } from "./cards.js";
import { HeldButton } from "./press.js";
import { position } from "./units.js";

export function Preflight({ app }) {
  const [preflight, vehicles, entities, stations] = useSections(app.store, ["preflight", "vehicles", "entities", "stations", "clock"], 200);
  const act = useWatched(app.mayAct);
  const state = preflight.get("state");
  if (!["waits", "ready"].includes(state) || app.clock.get("ended")) return null;
  const start = () => app.act({ start: true }, { what: "start", about: "the run" });
  const items = preflight.get("items") ?? [];
  const rows = items.filter(({ vehicle }) => vehicle).sort((a, b) => byName(a.vehicle, b.vehicle));
  const others = [...stations].filter(([, { here }]) => !here).sort(([a], [b]) => byName(a, b));
  return html`<section class="preflight" aria-labelledby="preflight-title" tabindex="0">
    <div class="head"><h2 id="preflight-title">Before the start: nothing is commanded yet</h2>
    ${act ? html`<${HeldButton} kind="start" label="Start the run" tell=${app.tell} disabled=${state !== "ready"} act=${start}>Start<//>` : html`<p class="quiet">Somebody who may act has to press Start.</p>`}</div>
    <ul>${items.filter(({ vehicle }) => !vehicle).map((item) => html`<${Check} key=${item.what} ...${item} />`)}
      ${others.map(([name, { reached, begun }]) => html`<${Check} key=${`station ${name}`} what=${`station ${name} is reached`} done=${reached === true} detail=${reached && begun === false ? "it has not started yet" : ""} />`)}</ul>
    ${rows.length > 0 && html`<div class="rows"><table><thead><tr>${["Vehicle", "Heard", "Position", "Mode", "Battery", "Fence read back", "Refuses to arm"].map((title) => html`<th scope="col" key=${title}>${title}</th>`)}</tr></thead>
      <tbody>${rows.map((item) => html`<${Row} key=${item.vehicle} app=${app} item=${item} card=${vehicles.get(item.vehicle)} at=${entities.get(item.vehicle)?.at} />`)}</tbody></table></div>`}
  </section>`;
}

const Sign = ({ done }) => html`<span aria-hidden="true">${done ? "✓" : "…"}</span>`;

const Check = ({ what, done, detail }) => html`<li class=${done ? "done" : "open"}><${Sign} done=${done} /> ${what}${done ? "" : html`<span class="unseen">: not yet</span>`}${detail ? html` <span class="quiet">${detail}</span>` : ""}</li>`;

function Row({ app, item: { vehicle, done, fence, refuses = [] }, card, at }) {
  const ready = done && refuses.length === 0;
  return html`<tr class=${ready ? "done" : "open"}>
    <th scope="row"><${Sign} done=${ready} /> ${vehicle}${done ? "" : html`<span class="unseen">: not yet</span>`}</th>
    <td>${card && done ? html`<${LinkAge} app=${app} link=${card.link} />` : "not heard"}</td>
    <td>${at && done ? position(at) : "unknown"}</td>
    <td>${card?.mode ?? "unknown"}${card?.armed === true ? ", armed" : card?.armed === false ? ", disarmed" : ""}</td>
    <td>${card?.battery ? html`<${Battery} battery=${card.battery} />` : "unknown"}</td>
    <td title="fence">${fence ?? "not reported"}</td>
    <td title="refuses to arm" class=${refuses.length ? "bad" : "quiet"}>${refuses.join("; ") || "nothing said"}</td></tr>`;
}
