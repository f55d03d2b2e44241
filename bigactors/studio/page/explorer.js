/**
 * The explorer: a run step by step, the steps that are possible next, and what is true here.
 *
 * `ask(request)` returns a promise of an answer of `bigactors.studio.exploration`, or of a run inside a file. `state` is
 * what to show: `{run, at}`, `{trace}` or `{given}`; another object shows another run. `onLook(answer)` gets each answer that is
 * shown: `view` has the sections that the shared map and bigraph draw, `run` and `at` are for the address of the page.
 * `graph` is a view of all runs, beside which the lanes are a tab.
 */
import { html, Tabs, useEffect, useLayoutEffect, useRef, useState } from "/parts/ui.js";
import { counted } from "/parts/map/words.js";

const MOST_ROWS = 400;
const PAUSE = 1100; // milliseconds between two steps of a playing run
const GAP = { least: 18, most: 120 }; // pixels of the shortest and of the longest time between two steps
const NOTHING = {};

export function Explorer({ ask, state = NOTHING, onLook = () => {}, keys = null, graph = null }) {
  const [look, setLook] = useState(null);
  const [problem, setProblem] = useState("");
  const [playing, setPlaying] = useState(false);
  const asked = useRef(0);
  const wanted = useRef(0);
  const root = useRef(null);

  const send = async (request) => {
    const number = ++asked.current;
    const answer = await ask(request).catch((error) => ({ error: error.message }));
    if (number !== asked.current) return null; // another request was made meanwhile
    setProblem(answer.error ?? "");
    if (!answer.error && answer.view) {
      wanted.current = answer.at;
      setLook(answer);
      onLook(answer);
    }
    return answer.error ? null : answer;
  };
  const last = look?.length ?? 0;
  const go = (at) => {
    wanted.current = Math.max(0, Math.min(last, at));
    return send({ ask: "run", run: look.run, at: wanted.current });
  };
  const move = (by) => go(wanted.current + by);
  const take = (token) => {
    if (look.next === token) return move(1);
    return send({ ask: "run", run: [look.here, token].filter(Boolean).join(".") });
  };
  const play = () => {
    if (!playing && wanted.current === last) go(0);
    setPlaying(!playing);
  };

  useEffect(() => {
    const { trace, given, run = "", at } = state;
    send(trace ? { ask: "load", trace } : given ? { ask: "load", given } : { ask: "run", run, at });
  }, [state]);
  useEffect(() => {
    if (!playing) return undefined;
    const timer = setInterval(() => {
      if (wanted.current < last) move(1);
      else if (look.loop !== null && look.loop < last) go(look.loop);
      else setPlaying(false);
    }, PAUSE);
    return () => clearInterval(timer);
  }, [playing, look]);
  useEffect(() => {
    const does = { ArrowRight: () => move(1), ArrowLeft: () => move(-1), Home: () => go(0), End: () => go(last), " ": play, "/": () => root.current.querySelector("input[type=search]").focus() };
    const press = (event) => {
      const theirs = "input, textarea, select, .frame, [contenteditable]" + (event.key === " " ? ", button, summary" : "");
      if (!look || !(event.key in does) || event.ctrlKey || event.metaKey || event.altKey || event.target.closest(theirs)) return;
      event.preventDefault();
      if (event.key !== " ") setPlaying(false);
      does[event.key]();
    };
    const place = keys ?? root.current;
    place.addEventListener("keydown", press);
    return () => place.removeEventListener("keydown", press);
  });

  return html`<div class="explorer" ref=${root}>
    ${problem ? html`<p class="problem" role="alert">${problem}</p>` : !look && html`<p class="quiet">The beginning of the mission is computed …</p>`}
    ${look && html`
      <${Story} look=${look} go=${go} />
      <${Controls} look=${look} go=${go} move=${move} playing=${playing} play=${play} />
      ${!look.still && html`<${Wishes} look=${look} send=${send} />`}
      <div class=${graph ? "columns" : "column"}>
        <div class="possible">
          ${look.choices && html`<${Choices} key=${`${look.run} ${look.at}`} look=${look} take=${take} />`}
          <${Values} values=${look.values} />
          ${graph && html`<${Parts} parts=${look.parts} />`}
        </div>
        <${Runs} look=${look} go=${go} graph=${graph} />
      </div>
      ${!graph && html`<${Parts} parts=${look.parts} />`}`}
  </div>`;
}

/** The run in lanes, or the graph of all runs. */
function Runs({ look, go, graph }) {
  const [tab, setTab] = useState("lanes");
  const lanes = html`<${Lanes} look=${look} go=${go} />`;
  if (!graph) return lanes;
  return html`<div class="runs"><${Tabs} label="Runs" tabs=${[["lanes", "Run"], ["graph", "Graph"]]} chosen=${tab} choose=${setTab} panelOf=${() => "runs"} />
    <div role="tabpanel" id="runs" aria-labelledby=${`tab-${tab}`}>${tab === "graph" ? graph : lanes}</div></div>`;
}

/** The causes of what the run ends in, each with a link to its step. */
export function Story({ look, go }) {
  if (look.causes.length === 0) return null;
  return html`<ol class="story">${look.causes.map(({ step, text, after }, n) => html`<li key=${n}><a href=${`#c${step}`} aria-current=${step === look.at ? "step" : null} onClick=${(event) => (event.preventDefault(), go(step))}>
    ${text} <span class="at">${after ? "after" : "at"} ${numberOf(look, step)}</span></a></li>`)}</ol>`;
}

/** The step to a configuration, of how many, and its date. */
const numberOf = (look, at, of = "") => `step ${at}${of}${look.steps[at - 1]?.date ? ` · ${look.steps[at - 1].date}` : ""}`;

function Controls({ look, go, move, playing, play }) {
  const button = (sign, says, does) => html`<button type="button" title=${says} aria-label=${says} onClick=${does}>${sign}</button>`;
  return html`<div class="controls">
    <button type="button" aria-pressed=${String(playing)} title="play (space)" onClick=${play}>${playing ? "Pause" : "Play"}</button>
    ${button("⇤", "first configuration (Home)", () => go(0))}${button("←", "one step back (left arrow)", () => move(-1))}
    ${button("→", "one step on (right arrow)", () => move(1))}${button("⇥", "last configuration (End)", () => go(look.length))}
    <input type="range" min="0" max=${look.length} step="1" value=${look.at} aria-label="configuration" aria-valuetext=${`${numberOf(look, look.at)}: ${wordsOf(look)}`} onInput=${(event) => go(Number(event.currentTarget.value))} />
    <output>${numberOf(look, look.at, ` of ${look.length}`)}</output>
  </div>
  <p class=${`caption ${isGuilty(look) ? "guilty" : ""}`} aria-live="polite">${wordsOf(look)}</p>`;
}

/** Whether the story is about the configuration that is shown. */
export const isGuilty = (look) => look.causes.some(({ step }) => step === look.at);

const wordsOf = (look) => look.steps[look.at - 1]?.words ?? "the beginning";

/** What an exploration does at a wish: a walk at random, a search, and traces. */
function Wishes({ look, send }) {
  const [where, setWhere] = useState("");
  const [count, setCount] = useState(10);
  const seek = (event) => {
    event.preventDefault();
    send({ ask: "goto", run: look.here, where });
  };
  const walk = () => send({ ask: "random", run: look.here, count, seed: Math.floor(Math.random() * 2 ** 31) });
  const save = async () => {
    const answer = await send({ ask: "save", run: look.run });
    if (!answer) return;
    const link = Object.assign(document.createElement("a"), { download: "trace.json", href: URL.createObjectURL(new Blob([JSON.stringify(answer.trace, null, 1)], { type: "application/json" })) });
    link.click();
    URL.revokeObjectURL(link.href);
  };
  const load = (event) => {
    const [file] = event.currentTarget.files;
    if (file) send({ ask: "load", file });
  };
  return html`<div class="wishes">
    <form onSubmit=${seek}><input type="text" required value=${where} placeholder="uav0 in gate0" aria-label="go to where this is true" onInput=${(event) => setWhere(event.currentTarget.value)} /><button type="submit">Go to where</button></form>
    <span><input type="number" min="1" max="1000" value=${count} aria-label="steps at random" onInput=${(event) => setCount(Number(event.currentTarget.value))} /><button type="button" onClick=${walk}>Steps at random</button></span>
    <span><button type="button" onClick=${save}>Save the trace</button><label class="button" title="a trace in JSON, or a recording">Open a run<input type="file" accept=".json,.mcap" onChange=${load} /></label></span>
  </div>`;
}

/** The steps that are possible now, by agent and environment. */
function Choices({ look, take }) {
  const agents = [...new Set(look.choices.map(({ agent }) => agent))];
  return html`<section class="choices" aria-label="Possible steps">
    ${look.choices.length === 0 && html`<p class="none">${look.nothing}</p>`}
    ${agents.map((agent) => html`<div key=${agent ?? ""}><h2>${agent ?? "environment"}</h2>
      <ul>${look.choices.filter((each) => each.agent === agent).map((each) => html`<${Choice} key=${each.step} choice=${each} take=${take} />`)}</ul></div>`)}
  </section>`;
}

function Choice({ choice, take }) {
  const { step, words, label, from, to, ticks, tick } = choice;
  const [at, setAt] = useState(ticks?.[0]);
  const many = ticks && ticks[0] !== ticks[1];
  const interval = from === undefined ? "" : to === null ? `from ${from}` : from === to ? `at ${from}` : `${from} to ${to}`;
  return html`<li><button type="button" title=${label} onClick=${() => take(ticks && at !== ticks[0] ? `${step}@${at}` : String(step))}>${words}</button>
    ${interval && html`<span class="interval">${interval}</span>`}
    ${many && html`<label class="moment">at <input type="number" min=${(ticks[0] * tick) / 1000} max=${ticks[1] === null ? null : (ticks[1] * tick) / 1000} step=${tick / 1000} value=${(at * tick) / 1000} aria-label=${`seconds at which: ${words}`} onInput=${(event) => setAt(Math.round((Number(event.currentTarget.value) * 1000) / tick))} /> s</label>`}</li>`;
}

/** Each property's value in this configuration. */
function Values({ values }) {
  if (!values?.length) return null;
  const sign = ({ value, bad }) => (value === null ? "·" : value ? "✓" : bad ? "✗" : "○");
  return html`<ul class="values" aria-label="Properties here">${values.map((each) => html`<li key=${each.name} class=${each.bad ? "bad" : each.value ? "good" : ""} title=${each.formula}>
    <b>${sign(each)}</b> ${each.name} <span class="quiet">${each.words}</span></li>`)}</ul>`;
}

// --- lanes -------------------------------------------------------------------------------------------------------

/** The rows of a run: steps, and folds of steps that only repeat others unless they are unfolded. */
function rowsOf(look, open) {
  const rows = [];
  const folds = new Map((look.folds ?? []).map((fold) => [fold[0], fold]));
  for (let number = 1; number <= look.length; number++) {
    const fold = folds.get(number);
    if (fold) rows.push({ first: fold[0], last: fold[1], about: fold[2] });
    if (fold && !open.has(number)) number = fold[1];
    else rows.push({ number });
  }
  return rows;
}

/** The run, with a lane for each agent and one for the environment. */
export function Lanes({ look, go }) {
  const [open, setOpen] = useState(new Set());
  const [wish, setWish] = useState("");
  const pane = useRef(null);
  const rows = rowsOf(look, open);
  const current = rows.findIndex(({ number, first, last }) => number === look.at || (first <= look.at && look.at <= last && !open.has(first)));
  const begin = Math.max(0, Math.min(current - MOST_ROWS / 2, rows.length - MOST_ROWS));
  const shown = rows.slice(begin, begin + MOST_ROWS);
  const lapses = lapsesOf(look);
  const longest = lapses.reduce((most, lapse) => Math.max(most, lapse), 1);
  const hits = wish ? look.steps.flatMap((step, n) => (`${step.words} ${step.label} step ${n + 1}`.toLowerCase().includes(wish) ? [n + 1] : [])) : [];
  const found = new Set(hits);
  const seek = (event) => {
    if (event.key !== "Enter" || hits.length === 0) return;
    go(event.shiftKey ? hits.findLast((n) => n < look.at) ?? hits.at(-1) : hits.find((n) => n > look.at) ?? hits[0]);
  };
  const toggle = (first) => setOpen(new Set(open.has(first) ? [...open].filter((each) => each !== first) : [...open, first]));
  useLayoutEffect(() => {
    const row = pane.current?.querySelector("[aria-current=step]");
    if (!row) return;
    const [outer, inner, head] = [pane.current.getBoundingClientRect(), row.getBoundingClientRect(), pane.current.querySelector("thead").offsetHeight];
    const above = inner.top - outer.top - head - 8;
    pane.current.scrollTop += above < 0 ? above : Math.max(0, inner.bottom - outer.bottom + 8);
    const box = row.querySelector(".step")?.getBoundingClientRect();
    if (box && (box.left < outer.left || box.right > outer.right)) pane.current.scrollLeft += box.left - outer.left - 80;
  }, [look.run, look.at, open]);
  const gapOf = (lapse) => (lapse > 0 ? { style: { "--gap": `${Math.max(GAP.least, Math.round((GAP.most * lapse) / longest))}px` } } : {});
  const cell = (row) => {
    if (row.first) return html`<td class="several" colspan=${look.lanes.length}><button type="button" aria-expanded=${String(open.has(row.first))} onClick=${() => toggle(row.first)}>${open.has(row.first) ? "fold" : "unfold"}</button> ↻ steps ${row.first} to ${row.last}: ${row.about}</td>`;
    const step = look.steps[row.number - 1];
    return look.lanes.map((name, lane) => html`<td key=${name}>${lane === step.lane && html`<${Step} step=${step} />`}</td>`);
  };
  return html`<section class="lanes-pane" aria-label="The run, a lane for each agent">
    <input type="search" placeholder="find in the steps" aria-label="find in the steps; Enter goes on" onInput=${(event) => setWish(event.currentTarget.value.trim().toLowerCase())} onKeyDown=${seek} />
    <output class="quiet">${wish ? `${hits.length} found` : ""}</output>
    <div class="scroll" ref=${pane} tabindex="0"><table style=${{ minWidth: `${5 + 9 * look.lanes.length}em` }}>
      <thead><tr><th scope="col">step</th>${look.lanes.map((name, lane) => html`<th scope="col" key=${name}>${look.hosts[lane]}</th>`)}</tr></thead>
      <tbody>
        ${begin === 0 && html`<tr aria-current=${look.at === 0 ? "step" : null} onClick=${() => go(0)}><th scope="row"><button type="button">0</button></th>${look.lanes.map((name) => html`<td key=${name}></td>`)}</tr>`}
        ${begin > 0 && html`<tr><td class="several" colspan=${look.lanes.length + 1}>⋯ ${counted(begin, "row")} before</td></tr>`}
        ${shown.map((row) => html`<tr key=${row.number ?? `f${row.first}`} data-step=${row.number} ...${gapOf(lapses[row.number - 1] ?? 0)}
          class=${[found.has(row.number) ? "match" : "", look.steps[row.number - 1]?.cause ? "guilty" : "", lapses[row.number - 1] > 0 ? "later" : ""].join(" ")}
          aria-current=${row === rows[current] ? "step" : null} onClick=${(event) => row.number && !event.target.closest("td button") && go(row.number)}>
          <th scope="row" data-lapse=${lapseWords(lapses[row.number - 1])}>${row.number && html`<button type="button">${row.number}</button><small>${look.steps[row.number - 1].date ?? ""}</small>`}</th>${cell(row)}</tr>`)}
        ${begin + MOST_ROWS < rows.length && html`<tr><td class="several" colspan=${look.lanes.length + 1}>⋯ ${counted(rows.length - begin - MOST_ROWS, "row")} after</td></tr>`}
      </tbody></table>${look.end && html`<p class="loop"><button type="button" onClick=${() => go(look.loop)}>${look.end}</button></p>`}</div>
  </section>`;
}

/** The time before each step, in milliseconds; zeros without dates. */
const lapsesOf = ({ steps }) => steps.map(({ at }, n) => (at ?? 0) - (n > 0 ? steps[n - 1].at ?? 0 : 0));

const lapseWords = (lapse = 0) => (lapse < 120_000 ? `+ ${Math.round(lapse / 100) / 10} s` : `+ ${Math.round(lapse / 6000) / 10} min`);

const Step = ({ step }) => html`<div class=${`step ${step.sort}`} title=${step.label}>
  ${(step.role || step.cause) && html`<strong class="role">${step.role ?? "cause"}</strong>`}
  <div>${step.words} <small class="quiet">${step.rule}</small></div>
  ${step.changes.length > 0 && html`<ul>${step.changes.map(([part, text], n) => html`<li key=${n}><span class="part">${part}</span> ${text}</li>`)}</ul>`}</div>`;

/** The agents and the pending requests; new ones are marked. */
function Parts({ parts }) {
  if (!parts) return null;
  const list = (sign, gloss, lines) => html`<div><h2>${sign} <small>${gloss}</small></h2><ul>${lines.length === 0 ? html`<li>∅</li>` : lines.map(([text, isNew], n) => html`<li key=${n} class=${isNew ? "new" : ""}>${text}</li>`)}</ul></div>`;
  return html`<div class="parts">${list("α", "agents", parts.agents)}${list("η", "pending requests", parts.requests)}</div>`;
}
