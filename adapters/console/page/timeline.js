/** The timeline: ticks for events, a slider, and the speed. */
import { html, useEffect, useLayoutEffect, useRef, useSections, useState, useWatched } from "./ui.js";
import { Ticking, say } from "./clock.js";
import { momentOf, since, utc } from "./units.js";

export const SPEEDS = [0.5, 1, 2, 5, 10, 20, 50, 100];
export const SORTS = ["world", "control", "say", "finding", "action", "note"];
const PAUSE = 80;

/** The moment of the nearest tick before or after `now` whose sort is shown, null if there is none. */
export function neighbour(ticks, now, direction, hidden) {
  const margin = 0.05; // the shown moment may lie a little after the requested tick
  const times = [...ticks.values()].filter(([, sort]) => !hidden.has(sort)).map(([time]) => time);
  const beyond = times.filter((time) => (direction < 0 ? time < now - margin : time > now + margin));
  return beyond.length ? (direction < 0 ? Math.max(...beyond) : Math.min(...beyond)) : null;
}

export function Timeline({ app }) {
  const [clock, ticks] = useSections(app.store, ["clock", "ticks"], 200);
  const hidden = useWatched(app.hiddenSorts);
  const [dragged, setDragged] = useState(null);
  const speed = useWatched(app.speed);
  const [begin, head, live, playing, ended] = ["begin", "head", "live", "playing", "ended"].map((key) => clock.get(key) ?? null);
  const moves = playing || (live && !ended);
  const known = begin !== null && head !== null;
  const sent = useRef({ at: -Infinity });

  const seek = (time) => {
    setDragged(time);
    app.clock.hold(time);
    clearTimeout(app.seeking);
    clearTimeout(released.current);
    const go = () => {
      sent.current.at = performance.now();
      app.seek(time);
    };
    app.seeking = setTimeout(go, Math.max(0, sent.current.at + PAUSE - performance.now()));
  };
  const input = useRef(null);
  useLayoutEffect(() => {
    if (!known || !input.current) return;
    input.current.max = String(Math.max(0.1, head - begin));
    if (dragged === null && app.clock.now !== null) input.current.value = String(Math.min(head, app.clock.now) - begin);
  });
  useEffect(() => app.clock.each((now) => {
    if (!input.current || !known || input.current === document.activeElement && dragged !== null) return;
    if (dragged === null) input.current.value = String(Math.min(head, now) - begin);
    input.current.setAttribute("aria-valuetext", `${utc(now)} UTC, ${since(now - begin)} from the beginning`);
  }), [known, begin, head, dragged]);
  const released = useRef(null);
  const release = () => {
    clearTimeout(released.current);
    released.current = setTimeout(() => { // until the requested moment has come
      setDragged(null);
      app.clock.hold(null);
    }, 300);
  };

  const counts = {};
  for (const [, sort] of ticks.values()) counts[sort] = (counts[sort] ?? 0) + 1;
  const toggle = (sort) => {
    const next = new Set(hidden);
    if (!next.delete(sort)) next.add(sort);
    app.hiddenSorts.set(next);
  };
  return html`<section class="timeline" aria-label="Timeline">
    <div class="transport">
      <button type="button" onClick=${() => app.step(-1)} aria-label="previous tick" title="previous tick  ["><${Sign} shape="M4 3v10M13 3L6 8l7 5z" /></button>
      <button type="button" class="play" onClick=${app.playOrPause} aria-label=${moves ? "pause" : "play"} title="play or pause  Space"><${Sign} shape=${moves ? "M4 3h3v10H4zM9 3h3v10H9z" : "M4 2l9 6-9 6z"} /></button>
      <button type="button" onClick=${() => app.step(1)} aria-label="next tick" title="next tick  ]"><${Sign} shape="M12 3v10M3 3l7 5-7 5z" /></button>
      <label class="unseen" for="speed">speed</label>
      <select id="speed" value=${String(speed)} onChange=${(event) => app.setSpeed(Number(event.currentTarget.value))} title="how fast the past is played  , and .">
        ${SPEEDS.map((each) => html`<option key=${each} value=${String(each)}>${each}×</option>`)}
      </select>
      <button type="button" class="back" onClick=${() => app.back(60)} title="1 minute back  Shift B">−1 min</button>
      <button type="button" class="back" onClick=${() => app.back(10)} title="10 seconds back  B">−10 s</button>
      <${GoTo} app=${app} begin=${begin} head=${head} />
      <button type="button" class=${`golive ${live ? "on" : ""}`} aria-pressed=${String(Boolean(live))} onClick=${app.live} title="the newest moment  L">${ended ? "End" : "Live"}</button>
    </div>
    <div class="track">
      <${Ticks} app=${app} begin=${begin} head=${head} ticks=${ticks} size=${ticks.size} hidden=${hidden} />
      <input ref=${input} type="range" aria-label="the moment shown" min="0" step="any" disabled=${!known}
        onInput=${(event) => seek(begin + Number(event.currentTarget.value))} onChange=${release} onKeyUp=${release} />
      <div class="ends">
        <span>${known ? `${utc(begin)}` : ""}</span>
        ${dragged !== null ? html`<span class="shown" key="dragged">${utc(dragged)} UTC · ${since(dragged - begin)}</span>`
          : html`<${Ticking} key="shown" clock=${app.clock} class="shown" apply=${(element, now) => say(element, `${utc(now)} UTC${known ? ` · ${since(now - begin)}` : ""}`)} />`}
        <span>${known ? utc(head) : ""}</span>
      </div>
    </div>
    <div class="legend" role="group" aria-label="Which ticks are shown">${SORTS.map((sort) => html`<button type="button" key=${sort} class=${`sort ${sort}`} aria-pressed=${String(!hidden.has(sort))} onClick=${() => toggle(sort)}><i></i>${sort} <span class="quiet">${counts[sort] ?? 0}</span></button>`)}</div>
  </section>`;
}

/** An input for a time of day; Enter goes there. */
function GoTo({ app, begin, head }) {
  const go = (event) => {
    event.preventDefault();
    const field = event.currentTarget.querySelector("input");
    const time = begin === null ? null : momentOf(field.value, begin, head);
    if (time === null) return app.tell(`“${field.value}” is no time from ${utc(begin ?? 0)} to ${utc(head ?? 0)} UTC, like 09:05 or 09:05:30.`);
    app.goTo(time);
    field.value = "";
    field.blur();
  };
  return html`<form class="goto" onSubmit=${go}><input id="goto" size="8" maxlength="8" placeholder="HH:MM:SS" aria-label="go to a time of day, UTC" title="go to a time of day, UTC  G" autocomplete="off" /></form>`;
}

/** A sign that looks the same with all fonts. */
const Sign = ({ shape }) => html`<svg class="sign" viewBox="0 0 16 16" aria-hidden="true"><path d=${shape} /></svg>`;

/** The ticks, a row for each sort, on a canvas. */
function Ticks({ app, begin, head, ticks, size, hidden }) {
  const canvas = useRef(null);
  const theme = useWatched(app.theme);
  const [width, setWidth] = useState(0);
  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => setWidth(entry.contentRect.width));
    observer.observe(canvas.current);
    return () => observer.disconnect();
  }, []);
  useLayoutEffect(() => {
    if (begin === null || !width) return;
    const height = canvas.current.clientHeight;
    const scale = devicePixelRatio;
    canvas.current.width = width * scale;
    canvas.current.height = height * scale;
    const pen = canvas.current.getContext("2d");
    pen.scale(scale, scale);
    const look = getComputedStyle(canvas.current);
    const row = height / SORTS.length;
    const across = (time) => ((time - begin) / Math.max(0.1, head - begin)) * (width - 16) + 8; // 8: half of the slider's knob
    SORTS.forEach((sort, n) => {
      pen.fillStyle = look.getPropertyValue(`--${sort}`);
      if (!hidden.has(sort)) for (const [time, its] of ticks.values()) if (its === sort) pen.fillRect(across(time) - 1, n * row + 1, 2, row - 1);
    });
  }, [begin, head, size, hidden, width, theme]);
  return html`<canvas ref=${canvas} aria-hidden="true"></canvas>`;
}
