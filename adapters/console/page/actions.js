/** The messages and orders that an operator may give, and the states of past actions. */
import { Field, html, memo, byName, useSections, useWatched } from "./ui.js";
import { eachFate, fateOf } from "./wording.js";
import { HeldButton } from "./press.js";
import { utc } from "./units.js";
import { LONGEST_NAME } from "./operator_name.js";

export function Actions({ app }) {
  const [sayings, actions, vehicles, agents, mission] = useSections(app.store, ["sayings", "actions", "vehicles", "agents", "mission"], 200);
  const act = useWatched(app.mayOrder);
  const past = useWatched(app.inPast);
  const why = useWatched(app.whyNot);
  const { role, mode } = useWatched(app.link.welcome) ?? {};
  const order = (which) => () => app.act({ order: { order: which, vehicle: null } }, { what: which, about: "all" });
  return html`<div class="actions">
    ${role === "act" && mode === "live" && html`<${Name} key="name" app=${app} />`}
    ${act ? html`
      <h2>Say</h2>
      ${sayings.size === 0 && html`<p class="none">The mission lets nobody say anything now.</p>`}
      ${sayings.size > 0 && mission.get("fallen_back") && html`<p class="none bad">The mission has fallen back: ${mission.get("fallen_back")}. Messages to its agents move no vehicle.</p>`}
      <ul class="sayings">${[...sayings].sort(([a], [b]) => byName(a, b)).map(([key, saying]) => html`<${Saying} key=${key} app=${app} saying=${saying} over=${agents.get(saying.agent)?.state === "has ended"} fallen=${Boolean(mission.get("fallen_back"))} />`)}</ul>
      ${vehicles.size > 1 && html`<h2>All ${vehicles.size} vehicles</h2>
      <div class="buttons">
        <${HeldButton} label="Hold all" tell=${app.tell} act=${order("hold")}>Hold all<//>
        <${HeldButton} label="Return all" tell=${app.tell} act=${order("return")}>Return all<//>
      </div>
      ${[...vehicles].filter(([, card]) => card.on_return).slice(0, 1).map(([name, card]) => html`<p key=${name} class="on-return"><b>Return all</b>, of ${name}: ${card.on_return}</p>`)}`}` : html`<p class="none">${why}</p>${past && html`<p><button type="button" class="now" onClick=${app.live}>Go to now (L) to act</button></p>`}`}
    ${act && html`<${Note} key="note" app=${app} />`}
    <h2>What was done</h2>
    ${actions.size === 0 && html`<p class="none">Nothing yet.</p>`}
    <ol class="fates">${[...actions].sort(([, a], [, b]) => b.time - a.time).slice(0, 100).map(([key, action]) => html`<${Fate} key=${key} action=${action} />`)}</ol>
    <${Exports} app=${app} />
  </div>`;
}

/** A note, which is recorded with the operator's name and the time. */
function Note({ app }) {
  const take = (event) => {
    event.preventDefault();
    const field = event.currentTarget.elements.note;
    const text = field.value.trim();
    if (text) app.act({ note: { text } }, { what: "note", about: text });
    field.value = "";
  };
  return html`<form class="who" onSubmit=${take}><label for="note">Note</label> <${Field} id="note" name="note" value="" maxlength="400" placeholder="for the recording" /> <button>Record</button></form>`;
}

const FILES = [["track.gpx", "Tracks as GPX"], ["track.csv", "CSV"], ["track.geojson", "GeoJSON"], ["map.png", "Map as PNG"], ["report.html", "Report"]];

/** The files that the page can save, of all that is recorded so far. */
const Exports = ({ app }) => html`<h2>Save</h2><p class="buttons">${FILES.map(([name, words]) => html`<button type="button" key=${name} onClick=${() => app.save(name)}>${words}</button>`)}</p>`;

/** The button of a message; it shows whether the agent waits for it, since an early message stays in the mailbox. */
const Saying = memo(({ app, saying: { agent, message, left, awaited, vain }, over, fallen }) => {
  const rest = over ? "has ended, hears nothing" : `${left} left${awaited === false ? ", not waited for yet" : awaited ? ", waited for now" : ""}`;
  const say = `say “${message}” to ${agent}`;
  return html`<li class=${awaited && left !== 0 && !over && !vain ? "awaited" : ""}><${HeldButton} label=${`${say} ${rest}${vain && !fallen ? ` ${vain}` : ""}`} short=${say} tell=${app.tell} disabled=${left === 0 || over || fallen} act=${() => app.act({ say: { agent, message } }, { what: `say "${message}"`, about: agent })}>
    “${message}” to ${agent} <span class="left">${rest}</span>${vain && !fallen && html` <span class="aside">${vain}</span>`}<//></li>`;
});

const Fate = memo(({ action }) => html`<li class=${action.state}><time>${utc(action.time)}</time>
    <span><b>${action.what}</b>${action.about ? ` ${action.about}` : ""} · ${action.by || "someone"} · <span class="state">${fateOf(action)}${action.why ? `: ${action.why}` : ""}</span>${action.answered ? html` <time>${utc(action.answered)}</time>` : ""}
      ${eachFate(action).map((each) => html`<span class="aside" key=${each}>${each}</span>`)}
      ${Object.entries(action.left_out ?? {}).sort(([a], [b]) => byName(a, b)).map(([name, why]) => html`<span class="aside" key=${name}>not ${name}: ${why}</span>`)}
      ${(action.notes ?? []).map((note) => html`<span class="aside" key=${note}>${note}</span>`)}</span></li>`);

/** The operator's name, which takes effect when its input is complete. */
function Name({ app }) {
  const name = useWatched(app.name);
  const [mission] = useSections(app.store, ["mission"], 500);
  const station = mission.get("station");
  const take = (event) => {
    app.name.set(event.currentTarget.value.trim());
    event.currentTarget.value = app.name.value;
  };
  return html`<p class="who"><label for="who">You act as</label> <${Field} id="who" value=${name} maxlength=${LONGEST_NAME} placeholder="your name" onChange=${take} /> <span class="quiet">${station ? `for station ${station}, ` : ""}recorded with each action</span></p>`;
}
