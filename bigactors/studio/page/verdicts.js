/** The verdicts on the newest text: each property with its outcome, its counts and the ways to its runs. */
import { html, useWatched } from "/parts/ui.js";
import { counted } from "/parts/map/words.js";

export const MARKS = { holds: "✓", violated: "✗", incomplete: "?" };

/** The margin of the text: verdicts at their properties, and marks at unreached lines. */
export function marksOf({ properties, coverage }) {
  const verdicts = properties.map(({ line, verdict, name, violations }) => ({ line, sort: verdict, sign: MARKS[verdict], title: `${name}: ${violations[0]?.message ?? verdict}`, property: name }));
  const gaps = coverage?.complete ? coverage.gaps : [];
  return [...verdicts, ...gaps.map(({ line, message }) => ({ line, sort: "gap", sign: "┆", title: message }))];
}

/** The run that proves a verdict: that of a violation, else a witness; null if there is none. */
export const runOf = ({ trace, witness }) => trace ?? witness;

export function Verdicts({ app }) {
  const { state, report, refused } = useWatched(app.verdicts);
  const title = { none: "Nothing is checked yet.", running: "checking …", refused: "Not checked: the text has mistakes.", done: report && summaryOf(report) }[state];
  return html`<section class="verdicts" aria-label="Verdicts">
    <p class=${state === "done" ? "" : "quiet"} role="status">${title}</p>
    ${state === "refused" && html`<pre class="refused">${refused}</pre>`}
    ${report && state !== "refused" && html`<ul class=${state === "running" ? "old" : ""}>${worstFirst(report.properties).map((each) => html`<${Verdict} key=${each.name} app=${app} about=${each} />`)}</ul>
      ${report.coverage?.complete && report.coverage.gaps.length > 0 && html`<p class="late">┆ ${counted(report.coverage.gaps.length, "part")} of the text ${report.coverage.gaps.length === 1 ? "is" : "are"} never reached</p>`}
      ${report.notes.map((note) => html`<p class="quiet" key=${note}>${note}</p>`)}`}
  </section>`;
}

const worstFirst = (properties) => properties.toSorted((a, b) => (b.verdict === "violated") - (a.verdict === "violated"));

function summaryOf({ complete, bounds, configurations, transitions, seconds }) {
  return `${counted(configurations, "configuration")}, ${counted(transitions, "transition")}${complete ? "" : `, then stopped: ${bounds.join(", ")}`} · ${seconds.toFixed(1)} s`;
}

function Verdict({ app, about }) {
  const { name, verdict, violations, count: times, examined, note, remarks, line } = about;
  const run = runOf(about);
  const sizes = verdict === "violated" ? times > 0 && counted(times, "violation") : examined ? `examined ${examined.toLocaleString("en")}` : "";
  return html`<li class=${`verdict-${verdict}`}>
    <b class="mark" aria-label=${verdict}>${MARKS[verdict]}</b>
    <div><button type="button" class="name" disabled=${line < 1} onClick=${() => app.editor.goTo(line)}>${name}</button> <span class="quiet">${[sizes, note].filter(Boolean).join(" · ")}</span>
      ${violations.map(({ message, details }) => html`<p key=${message}>${message}${details.map((each) => html`<br />${each}`)}</p>`)}
      ${remarks.map((remark) => html`<p class="late" key=${remark}>${remark}</p>`)}</div>
    ${run && html`<button type="button" class="run" onClick=${() => app.showRun(name)}>${verdict === "violated" ? "Show how" : "Show a run"}</button>`}
  </li>`;
}
