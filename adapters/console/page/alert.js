/** The red line with the newest alarm, until it is acknowledged. It keeps its place without alarms, so that nothing moves. */
import { html, useEffect, useSections, useState, useWatched } from "./ui.js";
import { Age } from "./clock.js";
import { findingWords } from "./wording.js";
import { utc } from "./units.js";

/** The kinds of findings that cause others: a lost link or a take-over also breaks an assumption. */
const CAUSES = ["lost link", "taken over", "failed"];

/** Seconds after a cause within which a broken assumption about the same vehicle counts as its effect. */
const FOLLOWS = 30;

/** The alarms, newest first, a cause before its effects; within one second, those about vehicles first. */
export function standing(alarms, vehicles) {
  const all = [...alarms.values()];
  const follows = (cause) => ({ kind, about, time }) => kind === "broken assumption" && about === cause.about && Math.abs(time - cause.time - FOLLOWS / 2) <= FOLLOWS / 2 + 1;
  const causes = all.filter(({ kind, about }) => CAUSES.includes(kind) && vehicles.has(about));
  const times = new Map(causes.map((cause) => [cause, Math.max(cause.time, ...all.filter(follows(cause)).map(({ time }) => time))]));
  const time = (alarm) => Math.floor(times.get(alarm) ?? alarm.time);
  const rank = ({ kind, about }) => 2 * vehicles.has(about) + CAUSES.includes(kind);
  return [...alarms].sort(([, a], [, b]) => time(b) - time(a) || rank(b) - rank(a) || b.time - a.time);
}

/** A finding's message without the name that is before it in the line. */
const unnamed = ({ message, about }) => (about && message.startsWith(`${about} `) ? message.slice(about.length + 1) : message);

/** The text that an agent waits for an operator's message; null if none waits. */
function asked(sayings, agents) {
  const saying = [...sayings.values()].find(({ awaited, left }) => awaited && left !== 0);
  if (!saying) return null;
  const until = agents.get(saying.agent)?.until;
  return `${saying.agent} waits for somebody to say “${saying.message}”${until ? `, until ${utc(until)}` : ""}. `;
}

/** The text without alarms: the vehicles to be watched, and the reason for the worst. */
function calm(vehicles, fallenBack) {
  if (fallenBack) return `The mission has fallen back: ${fallenBack}.`;
  const watched = [...vehicles].filter(([, card]) => card.level > 0);
  const [name, card] = watched.sort(([, a], [, b]) => b.level - a.level)[0] ?? [];
  if (!card) return "Nothing is wrong.";
  return `${watched.length} to be watched: ${name}${card.why ? `, ${card.why}` : ""}${watched.length > 1 ? ", ..." : "."}`;
}

/** The end of a run whose recording has no other reason. */
const UNSAID = "the run has ended";
const endOf = (why, file) => `The run has ended${why === UNSAID ? "" : `: ${why}`}.${file ? ` It is recorded in ${file}.` : ""}`;

/** Milliseconds for which an alert that replaces another cannot be acknowledged: the press was meant for the old one. */
const TO_READ = 1_000;

function Acknowledge({ app, number, about }) {
  const [read, setRead] = useState(number);
  useEffect(() => {
    const timer = setTimeout(() => setRead(number), TO_READ);
    return () => clearTimeout(timer);
  }, [number]);
  return html`<button type="button" class="acknowledge" disabled=${read !== number} onClick=${() => app.act({ acknowledge: { alert: number } }, { what: "acknowledge", about })}>Acknowledge</button>`;
}

export function Alert({ app }) {
  const [alerts, alarms, vehicles, sayings, agents, mission] = useSections(app.store, ["alerts", "alarms", "vehicles", "sayings", "agents", "mission", "clock"], 200);
  const past = useWatched(app.inPast);
  const connected = useWatched(app.link.state).state === "open";
  const act = useWatched(app.mayOrder);
  const open = useWatched(app.listing);
  const wrong = standing(alarms, vehicles);
  const [number, newest] = wrong[0] ?? [];
  const all = [...new Map([...alerts, ...alarms])].sort(([, a], [, b]) => b.time - a.time);
  const shown = open && all.length > 0;
  const broken = app.clock.get("broken_off") && app.clock.atEnd;
  const welcome = useWatched(app.link.welcome);
  const question = act ? asked(sayings, agents) : null;
  return html`<section class="alerts" aria-label="Alerts">
    <div role="alert" class=${`alert ${newest ? "standing" : ""}`} key="line">
      ${newest && html`<span class="message" key=${number} title=${newest.message} onClick=${() => app.listing.set(!open)}><span class="cause">${past && html`<span class="now-mark">NOW</span> `}<b>${newest.about ? `${newest.about}: ` : ""}</b>${unnamed(newest)}</span>${newest.consequence && html` <span class="consequence"><i aria-hidden="true">→</i> ${newest.consequence}</span>`}</span>`}
    </div>
    ${!newest && html`<span class=${`calm ${broken ? "wrong" : question ? "asked" : ""}`} key="calm">${broken ? `Unknown: ${app.clock.get("ended")}.` : app.clock.atEnd ? endOf(app.clock.get("ended"), welcome?.recording) : connected ? `${question ?? ""}${calm(vehicles, mission.get("fallen_back"))}` : "Unknown: not connected."}</span>`}
    ${all.length > 0 && html`<div class=${`alert-tools ${newest ? "standing" : ""}`} key="tools">
      ${newest && html`<span class="quiet-red when">${utc(newest.time)}${past ? " UTC" : html` · <${Age} clock=${app.clock} time=${newest.time} /> ago`}</span>`}
      ${newest && past && html`<button type="button" class="now" onClick=${app.live}>Go to now (L)</button>`}
      ${newest && act && html`<${Acknowledge} app=${app} number=${number} about=${newest.about} />`}
      <button type="button" class="others" aria-expanded=${String(shown)} onClick=${() => app.listing.set(!open)}>${wrong.length > 1 ? `${wrong.length - 1} more` : `all ${all.length}`} ▾</button>
    </div>`}
    ${shown && html`<ol class="alert-list" key="list">${all.map(([key, alert]) => html`<li key=${key} class=${alert.wrong && !alert.acknowledged ? "unread" : ""}>
      <time>${utc(alert.time)}</time> <span class="kind">${alert.kind}</span> <b>${alert.about}</b> ${findingWords(alert)}
      ${alert.verdicts?.length > 0 && html` <span class="quiet">rests on it: ${alert.verdicts.map((each) => (typeof each === "string" ? each : each.property)).join(", ")}</span>`}
      ${alert.acknowledged && html` <span class="quiet">acknowledged by ${alert.acknowledged.by || "someone"} at ${utc(alert.acknowledged.time)}</span>`}
      ${act && alert.wrong && !alert.acknowledged && html` <button type="button" onClick=${() => app.act({ acknowledge: { alert: key } }, { what: "acknowledge", about: alert.about })}>Acknowledge</button>`}
    </li>`)}</ol>`}
  </section>`;
}
