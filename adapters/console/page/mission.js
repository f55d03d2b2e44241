/** The top line: the mission, its verification, the shown moment, the connection. */
import { html, useSections, useWatched } from "./ui.js";
import { Ticking, say } from "./clock.js";
import { day, duration, since, utc } from "./units.js";

export function Mission({ app }) {
  const [mission, clock, alerts] = useSections(app.store, ["mission", "clock", "alerts"], 200);
  const [name, digest, verified, verdicts, scheduler, station] = ["name", "digest", "verified", "verdicts", "scheduler", "station"].map((key) => mission.get(key) ?? null);
  const [begin, live, ended] = ["begin", "live", "ended"].map((key) => clock.get(key) ?? null);
  const welcome = useWatched(app.link.welcome);
  const theme = useWatched(app.theme);
  const sound = useWatched(app.sound.wanted);
  return html`<header class="top">
    <h1>${name ?? "bigactors"}</h1>
    ${name !== null && html`<${Verdict} verified=${verified} verdicts=${verdicts ?? []} doubted=${doubtedBy(alerts)} digest=${digest} scheduler=${scheduler} />`}
    <span class="role">${station && html`<span class="station">station ${station} · </span>`}${welcome && (welcome.role === "act" ? "you may act" : "you watch")}</span>
    <span class="space"></span>
    <${Rate} rate=${clock.get("rate")} />
    <${Presence} app=${app} />
    ${clock.size > 0 && html`<span class="clock"><${State} app=${app} live=${live} ended=${app.clock.atEnd && ended} clock=${clock} />
      <${Ticking} clock=${app.clock} class="time" apply=${(element, now) => say(element, utc(now))} /><span class="zone">UTC</span>
      <${Ticking} clock=${app.clock} class="quiet" apply=${(element, now) => say(element, begin === null ? day(now) : `${since(now - begin)} · ${day(now)}`)} /></span>`}
    <button type="button" class="icon" title="sound of alarms  S" aria-label="sound of alarms" aria-pressed=${String(sound === "on")} onClick=${app.otherSound}><svg class="sign" viewBox="0 0 16 16" aria-hidden="true"><path d="M8 2a4 4 0 0 0-4 4v4l-1.5 2h11L12 10V6a4 4 0 0 0-4-4zM6.5 14h3" />${sound === "on" ? null : html`<path d="M2 2l12 12" />`}</svg></button>
    <button type="button" class="icon" title="light or dark  T" aria-label=${`the ${theme === "dark" ? "light" : "dark"} look`} onClick=${app.otherTheme}>${theme === "dark" ? "☀" : "☾"}</button>
    <button type="button" class="icon" title="the keys  ?" aria-label="help and keys" onClick=${() => app.help.set(true)}>?</button>
  </header>`;
}

/** A badge for simulated time, with its speed; a null rate means as fast as possible. */
function Rate({ rate }) {
  if (rate === undefined || rate === 1) return null;
  return html`<span class="badge simulated" title=${`time is simulated: ${rate === null ? "as fast as it can be computed" : `${rate} s pass in one`}`}>simulated${rate === null ? "" : ` ${rate}×`}</span>`;
}

function State({ app, live, ended, clock }) {
  const connected = useWatched(app.link.state).state === "open";
  if (clock.get("broken_off") && (ended || !connected)) return html`<b class="badge broken" title=${clock.get("ended")}>BROKEN OFF</b>`;
  if ((!connected || clock.get("unread")) && !ended) return html`<b class="badge past">OLD</b>`;
  if (ended) return html`<b class="badge ended" title=${ended}>ENDED</b>`;
  if (live) return html`<b class="badge live">LIVE</b>`;
  return html`<b class="badge past">${clock.get("playing") ? `PAST ${clock.get("speed") ?? 1}×` : "PAST, PAUSED"}</b>`;
}

/** The properties whose verdicts rest on broken assumptions. */
function doubtedBy(alerts) {
  return new Set([...alerts.values()].flatMap((alert) => alert.verdicts ?? []).map((each) => (typeof each === "string" ? each : each.property)));
}

function Verdict({ verified, verdicts, doubted, digest, scheduler }) {
  const wrong = verdicts.filter(({ property }) => doubted.has(property)).length;
  return html`<details class=${`verdict ${!verified ? "not" : wrong ? "doubted" : "ok"}`}><summary><span aria-hidden="true">${verified ? "✓" : "✗"}</span><span class="word"> ${verified ? "verified" : "not verified"}</span>${verdicts.length > 0 && html`<span class="many"> · ${verdicts.length} ${verdicts.length === 1 ? "property" : "properties"}${wrong ? `, ${wrong} on a broken assumption` : ""}</span>`}</summary>
    <div class="sheet">
      <table><thead><tr><th scope="col">Property</th><th scope="col">Verdict</th><th scope="col">Rests on</th></tr></thead>
      <tbody>${verdicts.map((each) => html`<tr key=${each.property}><th scope="row">${each.property}</th><td>${each.verdict}${doubted.has(each.property) ? ", but rests on a broken assumption" : ""}</td>
        <td>${each.rests_on.length ? html`<ul>${each.rests_on.map((text) => html`<li key=${text}>${text}</li>`)}</ul>` : html`<span class="quiet">nothing assumed</span>`}</td></tr>`)}</tbody></table>
      <p class="quiet">${scheduler && `scheduler ${scheduler}`}${digest && html` · mission <code>${digest.slice(0, 16)}</code>`}</p>
    </div></details>`;
}

/** Seconds of silence after which a run may have been killed: a running one would have recorded something. */
const KILLED = 15;

/** Whether the page is connected, and whether its data is current. */
function Presence({ app }) {
  const state = useWatched(app.link.state);
  if (state.state === "open") {
    const apply = (element) => {
      const silent = app.clock.silence > 3;
      const quiet = app.clock.silence > KILLED ? ": was the run killed?" : "";
      say(element, silent ? `nothing recorded for ${duration(app.clock.silence)}${quiet}` : "connected");
      element.className = silent ? "presence late" : "presence ok";
    };
    return html`<${Ticking} key="open" clock=${app.clock} class="presence" apply=${apply} />`;
  }
  return null;
}

const forHowLong = (since) => (element) => say(element, duration(Date.now() / 1000 - since));

/** A line across the whole page while it is not connected and its data is old. */
export function NotConnected({ app }) {
  const state = useWatched(app.link.state);
  const seen = useWatched(app.link.welcome);
  const [clock] = useSections(app.store, ["clock"], 200);
  const unread = clock.get("unread");
  if (state.state === "open" && unread) return html`<div role="status" class="offline"><b>This view is old</b>, of ${utc(clock.get("head"))} UTC: the recording cannot be read any further (${unread}). The run may go on, and receives your orders.</div>`;
  if (state.state === "open" || (state.state === "connecting" && !seen && Date.now() / 1000 - state.since < 1)) return html`<div role="status"></div>`;
  if (state.state === "early") return html`<div role="status" class="offline"><b>Connected, and waiting:</b> ${state.why}.</div>`;
  const ended = app.clock.get("ended");
  if (state.state === "refused") return html`<div role="status" class="offline"><b>This view is old</b>, of ${utc(app.clock.now)} UTC: another console is at this address now. The link that its program has printed opens it.</div>`;
  if (ended && app.clock.get("broken_off")) return html`<div role="status" class="offline"><b>The run broke off, and this console with it:</b> ${ended}. This view is of ${utc(app.clock.now)} UTC.</div>`;
  if (ended) return html`<div role="status" class="offline"><b>The run has ended, and this console with it</b> (${ended}). <code>bigactors console</code> shows its recording again.</div>`;
  return html`<div role="status" class="offline"><b>Not connected</b> for <${Ticking} clock=${app.clock} apply=${forHowLong(state.since)} />: ${app.clock.now === null ? "is the program running?" : `this view is of ${utc(app.clock.now)} UTC.`} Trying again.
    <button type="button" onClick=${() => app.link.connect()}>Try now</button></div>`;
}
