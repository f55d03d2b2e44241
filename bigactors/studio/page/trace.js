/** The page of one trace: the explorer over a run inside the file, beside its map and its bigraph. */
import { html, render, useEffect, useLayoutEffect, useRef, useState } from "/parts/ui.js";
import { Drawing, picture } from "/parts/bigraph.js";
import { Explorer, isGuilty } from "/studio/explorer.js";

const data = JSON.parse(document.getElementById("run").textContent);
const causes = new Set(data.causes.flatMap(({ step, after }) => (after ? [] : [step])));
/** The date of a step: as the mission's clock has it, else in seconds since the first step. */
const dateOf = (n) => data.dates[n] ?? (data.moments.length ? `${(data.moments[n] / 1000).toFixed(1)} s` : "");
const steps = data.steps.map((deed, n) => ({ ...data.deeds[deed], date: dateOf(n), at: data.moments[n], role: data.roles[n + 1], cause: causes.has(n + 1) }));
const NOWHERE = { parts: null, values: [], pictures: [], text: "", places: "" };

/** Answer as an exploration does. */
async function ask({ at = 0 }) {
  const here = Math.max(0, Math.min(steps.length, at));
  const look = data.looks[data.order[here]] ?? NOWHERE;
  return { ...data, steps, still: true, run: "", at: here, length: steps.length, ...look, view: look };
}

/** The configuration that the address names, else the one at which the page opens. */
const named = () => ({ at: Number(/^#c(\d{1,9})$/.exec(location.hash)?.[1] ?? data.start) });

function Page() {
  const [state, setState] = useState(named);
  const [look, setLook] = useState(null);
  useEffect(() => {
    const changed = () => setState(named());
    window.addEventListener("hashchange", changed);
    return () => window.removeEventListener("hashchange", changed);
  }, []);
  const onLook = (answer) => {
    setLook(answer);
    history.replaceState(null, "", `#c${answer.at}`);
  };
  const [logical, physical, legend] = (look?.pictures ?? []).map((number) => data.pictures[number] ?? null);
  const missing = look && (!logical || !physical) && `${look.parts ? "This configuration is not drawn" : "This configuration is not"} in this file: bigactors show --step ${look.at}, with the same --trace, has it.`;
  return html`<${Explorer} ask=${ask} state=${state} onLook=${onLook} keys=${document} />
    <section class=${`stage ${look && isGuilty(look) ? "guilty" : ""}`} aria-label="One configuration">
      ${missing && html`<p class="quiet">${missing}</p>`}
      <${Drawing} svg=${physical} text=${look?.places} called="The map" caption=${() => html`<b>P</b> the physical model: reality`} lettering=${7.5} />
      <${Drawing} svg=${logical} text=${look?.text} called="The bigraph" caption=${() => html`<b>L</b> the logical model: beliefs`} lettering=${8.6} />
      <${Legend} svg=${legend} />
    </section>`;
}

function Legend({ svg }) {
  const place = useRef(null);
  useLayoutEffect(() => place.current.replaceChildren(...(svg ? [picture(svg).root] : [])), [svg]);
  return html`<div class="legend" ref=${place}></div>`;
}

const dark = matchMedia("(prefers-color-scheme: dark)");
const dress = () => (document.documentElement.dataset.theme = dark.matches ? "dark" : "light");
dark.addEventListener("change", dress);
dress();
const place = document.querySelector("main");
place.replaceChildren();
render(html`<${Page} />`, place);
