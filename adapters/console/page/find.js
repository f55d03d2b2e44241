/** One input that finds vehicles, targets, places, and moments: findings, actions, notes and steps. */
import { html, byName, useEffect, useRef, useState } from "./ui.js";
import { utc } from "./units.js";

const MOST = 10;
const THINGS = ["vehicles", "entities", "places"];

/** The best matches of a text in the store: `{key, words, kind, name}` for a thing, `{key, words, kind, time}` for a moment. */
export function matches(store, text) {
  const wanted = text.trim().toLowerCase();
  return wanted === "" ? [] : [...things(store, wanted), ...moments(store, wanted)].slice(0, MOST);
}

function things(store, wanted) {
  const kinds = new Map(THINGS.toReversed().flatMap((section) => [...store.section(section)].map(([name, { kind }]) => [name, kind ?? ""])));
  const rank = (name) => (name.toLowerCase() === wanted ? 0 : name.toLowerCase().startsWith(wanted) ? 1 : 2) - 3 * store.section("vehicles").has(name);
  const found = [...kinds].filter(([name, kind]) => `${name} ${kind}`.toLowerCase().includes(wanted));
  return found.sort(([a], [b]) => rank(a) - rank(b) || byName(a, b)).map(([name, kind]) => ({ key: `thing ${name}`, words: name, kind, name }));
}

function moments(store, wanted) {
  const all = [
    ...[...store.section("alerts")].map(([key, { time, kind, about, message }]) => ({ key: `alert ${key}`, time, kind, words: [about, message].filter(Boolean).join(": ") })),
    ...[...store.section("actions")].map(([key, { time, by, what, about }]) => ({ key: `action ${key}`, time, kind: by || "someone", words: `${what} ${about ?? ""}` })),
    ...[...store.section("steps")].map(([key, { time, label, changes }]) => ({ key: `step ${key}`, time, kind: `step ${key}`, words: [label, ...changes].join("; ") })),
  ];
  return all.filter(({ words, kind }) => `${words} ${kind}`.toLowerCase().includes(wanted)).sort((a, b) => b.time - a.time);
}

export function Find({ app }) {
  const [text, setText] = useState("");
  const [at, setAt] = useState(0);
  const input = useRef(null);
  const found = matches(app.store, text);
  const clear = () => {
    input.current.value = "";
    setText("");
  };
  const leave = () => {
    clear();
    input.current.blur();
  };
  const go = (match, typed) => {
    if (!match) return app.tell(`Nothing here is called “${typed}”, and no event mentions it.`);
    if (match.name !== undefined) app.find(match.name);
    else app.goTo(match.time);
    leave();
  };
  const keys = (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step && found.length > 0) setAt((at + step + found.length) % found.length);
    else if (event.key === "Escape") leave();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  useEffect(() => setAt(0), [text]);
  const submit = (event) => {
    event.preventDefault();
    const typed = input.current.value; // the last key may not be drawn yet
    if (typed.trim()) go(matches(app.store, typed)[typed === text ? at : 0], typed);
  };
  return html`<form class="find" role="search" onSubmit=${submit}>
    <input id="find" ref=${input} role="combobox" aria-label="find a vehicle, MMSI, place or event" aria-expanded=${String(found.length > 0)} aria-controls="found" aria-autocomplete="list"
      aria-activedescendant=${found.length ? `found-${at}` : undefined} placeholder="Find  /" title="find a vehicle, MMSI, place or event  /" autocomplete="off" spellcheck=${false}
      onInput=${(event) => setText(event.currentTarget.value)} onKeyDown=${keys} onBlur=${(event) => event.relatedTarget?.closest?.("#found") || clear()} />
    <ul id="found" role="listbox" aria-label="What was found" hidden=${found.length === 0}>${found.map((match, n) => html`<li key=${match.key} id=${`found-${n}`} role="option" aria-selected=${String(n === at)}
      onPointerDown=${(event) => event.preventDefault()} onClick=${() => go(match)}>${match.time === undefined ? "" : html`<time>${utc(match.time)}</time> `}<b>${match.words}</b> <span class="quiet">${match.kind}</span></li>`)}</ul>
  </form>`;
}
