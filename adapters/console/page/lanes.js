/** The last steps, with a lane for each agent, and the agents. */
import { html, memo, byName, useSections, useState } from "./ui.js";
import { Ticking, say } from "./clock.js";
import { duration, utc } from "./units.js";

const LANES = 12;

export function Steps({ app }) {
  const [steps] = useSections(app.store, ["steps"], 200);
  const [all, setAll] = useState(false);
  const agents = [...new Set([...steps.values()].map((step) => step.agent).filter(Boolean))].sort(byName);
  const lanes = agents.slice(0, LANES).join("\n");
  const shown = [...steps].filter(([, step]) => all || step.told).sort(([a], [b]) => b - a);
  return html`<div class="steps">
    <p class="tools"><label><input type="checkbox" checked=${all} onChange=${(event) => setAll(event.currentTarget.checked)} /> each step, not only those in the terminal</label>
      <span class="quiet">${shown.length} of the last ${steps.size}</span></p>
    ${shown.length === 0 && html`<p class="none">No step yet.</p>`}
    <ol>${shown.map(([number, step]) => html`<${Step} key=${number} app=${app} number=${number} step=${step} lanes=${lanes} />`)}</ol>
  </div>`;
}

const Step = memo(({ app, number, step, lanes }) => {
  const names = lanes ? lanes.split("\n") : [];
  return html`<li class=${step.told ? "told" : ""}>
    <button type="button" class="when" title="go to this moment" onClick=${() => app.seek(step.time)}><span class="quiet">${number}</span> <time>${utc(step.time)}</time></button>
    <span class="lanes" aria-hidden="true">${names.map((name, n) => html`<i key=${name} class=${name === step.agent ? `lane-${n % 6}` : ""} title=${name}></i>`)}</span>
    <span class="what"><b class=${`agent lane-${names.indexOf(step.agent) % 6}`}>${step.agent ?? "world"}</b> ${step.label} ${step.about && !step.label.includes(step.about) ? html`<span class="quiet">${step.about}</span>` : null}
      ${step.changes.length > 0 && html`<span class="changes">${step.changes.join("; ")}</span>`}</span>
  </li>`;
});

export function Agents({ app }) {
  const [agents] = useSections(app.store, ["agents"], 200);
  if (agents.size === 0) return html`<p class="none">No agent is known yet.</p>`;
  return html`<div class="wide"><table class="agents"><thead><tr><th scope="col">Agent</th><th scope="col">On</th><th scope="col">State</th><th scope="col">Request</th></tr></thead>
    <tbody>${[...agents].sort(([a], [b]) => byName(a, b)).map(([name, agent]) => html`<${Agent} key=${name} app=${app} name=${name} agent=${agent} />`)}</tbody></table></div>`;
}

const Agent = memo(({ app, name, agent }) => html`<tr class=${agent.state === "has failed" ? "bad" : agent.state === "has ended" ? "quiet" : ""}>
    <th scope="row">${name}</th><td>${agent.host ?? "–"}</td><td>${agent.state}${isNumber(agent.until) && html`<${Until} app=${app} until=${agent.until} />`}</td><td>${agent.request ? html`<code>${agent.request}</code>` : "–"}</td></tr>`);

const isNumber = (value) => typeof value === "number";

/** The time until which an agent waits, and the remaining duration. */
const Until = ({ app, until }) => html`<${Ticking} clock=${app.clock} class="quiet" apply=${(element, now) => say(element, `, until ${utc(until)} (${until > now ? `in ${duration(until - now)}` : "due"})`)} />`;
