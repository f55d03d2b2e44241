/** The preflight checklist of a run, and its Start button: the run commands nothing before it is pressed. */
import { html, useSections, useWatched } from "./ui.js";
import { HeldButton } from "./press.js";

export function Preflight({ app }) {
  const [preflight] = useSections(app.store, ["preflight", "clock"], 200);
  const act = useWatched(app.mayAct);
  const state = preflight.get("state");
  if (!["waits", "ready"].includes(state) || app.clock.get("ended")) return null;
  const start = () => app.act({ start: true }, { what: "start", about: "the run" });
  return html`<section class="preflight" aria-labelledby="preflight-title">
    <div><h2 id="preflight-title">Before the start: nothing is commanded yet</h2>
    <ul>${(preflight.get("items") ?? []).map(({ what, done, detail }) => html`<li key=${what} class=${done ? "done" : "open"}><span aria-hidden="true">${done ? "✓" : "…"}</span> ${what}${done ? "" : html`<span class="unseen">: not yet</span>`}${detail ? html` <span class="quiet">${detail}</span>` : ""}</li>`)}</ul></div>
    ${act ? html`<${HeldButton} kind="start" label="Start the run" tell=${app.tell} disabled=${state !== "ready"} act=${start}>Start<//>` : html`<p class="quiet">Somebody who may act has to press Start.</p>`}
  </section>`;
}
