/** The studio: a mission's text, its verdicts, its map and bigraph, and an explorer of its runs. */
import { dress, Field, html, kept, memo, render, useEffect, useRef, useWatched, Watched } from "/parts/ui.js";
import { Bigraph } from "/parts/bigraph.js";
import { Store } from "/parts/store.js";
import { Explorer } from "./explorer.js";
import { Graph } from "./graph.js";
import { DrawingTools, Handles } from "./map_editing.js";
import { Connection } from "./connection.js";
import { marksOf, runOf, Verdicts } from "./verdicts.js";

const PAUSE = 600; // milliseconds without a change before the text is checked

const MOST_FILE = 4_000_000; // bytes of a dropped file
const MOST_RUN = 20_000_000; // bytes of the file of a run

const fragment = () => new URLSearchParams(location.hash.slice(1));
const token = () => fragment().get("token") ?? "";

class Studio {
  connection = new Connection(token());
  /** What the program sent of the mission's file, or of how a new one can begin; null before. */
  opened = new Watched(null);
  beginning = new Watched(null);
  /** Whether the text differs from the file. */
  unsaved = new Watched(false);
  /** The text of the file where another program has saved it over a text that is not saved here. */
  other = new Watched(null);
  problem = new Watched("");
  chosen = new Watched(null);
  /** The verdicts on the newest text, or on one before while it is checked: `{state, report, refused}`. */
  verdicts = new Watched({ state: "none" });
  /** The simulated flight: `{state, link}`, at its end `{state, recording}`. */
  flight = new Watched({ state: "none" });
  /** What the explorer is to show: `{run, at}`, the steps of a run, or `{trace}`, the run of a verdict; null before a text. */
  wanted = new Watched(null);
  /** The run that the explorer shows; the address has it, so that a link or a reload comes back to it. */
  shown = new Watched({ run: fragment().get("run") ?? "", at: Number(fragment().get("at") ?? 0) });
  /** The request that loads the run from a file, if there is one. */
  loaded = null;
  /** Whether the chosen entity has handles on the map. */
  drawing = new Watched(false);
  /** The kinds of the text, and what it places: `{kinds, shapes}`. */
  shapes = new Watched({ kinds: [], shapes: {} });
  /** The number of the newest text that was sent to be checked. */
  number = 0;
  look = kept("look", "");
  theme = new Watched("light");
  /** The configuration that is looked at, as the console's sections. */
  store = new Store();
  editor = null;
  map = null;

  constructor() {
    dress(this.look, this.theme);
    this.theme.on((theme) => this.map?.setTheme(theme));
    this.chosen.on((name) => {
      this.editor?.choose(name);
      this.map?.choose(name);
      this.#handle();
    });
    this.drawing.on((on) => (on ? this.#seeShapes() : this.#handle()));
    this.shapes.on(() => this.#handle());
    this.connection.connect({
      start: (frame) => this.beginning.set(frame),
      open: (frame) => this.#open(frame),
      lsp: ({ message }) => this.hears?.(JSON.stringify(message)),
      saved: ({ digest }) => this.#saved(digest),
      changed: (frame) => this.#changed(frame),
      verdicts: (frame) => this.#judged(frame),
      flown: (frame) => this.flight.set({ state: "flown", ...frame }),
      error: ({ message }) => this.problem.set(message),
    });
    addEventListener("beforeunload", (event) => this.unsaved.value && event.preventDefault());
    addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.key !== "s" || event.defaultPrevented) return;
      event.preventDefault();
      this.save();
    });
  }

  begin = (name, source) => {
    this.problem.set("");
    this.connection.send("begin", { name, source });
  };

  #open(frame) {
    this.digest = frame.digest;
    this.inFile = frame.text;
    document.title = `${frame.name}: bigactors studio`;
    this.beginning.set(null);
    this.problem.set("");
    if (frame.given) this.loaded = { ask: "load", given: true };
    this.opened.set(frame);
  }

  async openEditor(element) {
    const { Editor } = await import("./editor.js");
    const lsp = {
      send: (text) => this.connection.send("lsp", { message: JSON.parse(text) }),
      subscribe: (hears) => (this.hears = hears),
      unsubscribe: () => (this.hears = null),
    };
    const { text, uri, types, grammar } = this.opened.value;
    this.editor = new Editor(element, { text, uri, types, grammar, lsp, changed: () => this.#edited(), named: (name) => this.chosen.set(name), save: () => this.save(), pressed: ({ property }) => property && this.showRun(property) });
    this.#send();
  }

  #edited() {
    this.unsaved.set(this.editor.text !== this.inFile);
    this.number++; // verdicts on the text before are out of date
    this.verdicts.set({ ...this.verdicts.value, state: "running" });
    clearTimeout(this.pausing);
    this.pausing = setTimeout(() => this.#send(), PAUSE);
  }

  /** Have the text checked and explored as it is now. */
  #send() {
    this.connection.send("text", { text: this.editor.text, number: ++this.number });
    this.verdicts.set({ ...this.verdicts.value, state: "running" });
    this.wanted.set(this.number === 1 && this.loaded && !this.shown.value.run ? { given: true } : { ...this.shown.value });
    if (this.drawing.value) this.#seeShapes();
  }

  /** Ask the exploration of the newest text; where a run is none of it any more, show its beginning. */
  ask = async (request) => {
    if (request.file?.size > MOST_RUN) return { error: `${request.file.name} is over 20 MB: bigactors studio FILE --trace ${request.file.name} shows it` };
    const asked = request.file ? { ask: "load", content: await base64(request.file) } : request;
    const answer = await this.#explore(asked);
    if (asked.ask === "load" && !answer.error) this.loaded = asked;
    const kept = asked.ask === "run" && answer.error && asked.run === this.shown.value.run && asked.run !== "";
    return kept ? this.#explore({ ask: "run", run: "" }) : answer;
  };

  /** Ask the exploration; a new one takes the run from a file first, if the asked run begins with its steps. */
  async #explore(request) {
    const ask = (each) => this.connection.ask("explore", { request: each });
    const answer = await ask(request);
    if (!answer.error || !request.run?.startsWith("~") || !this.loaded) return answer;
    const again = await ask(this.loaded);
    return again.error ? again : ask(request);
  }

  /** Show the configuration that the explorer looks at, and have the address name it. */
  looked = ({ view, run, at }) => {
    this.show(view);
    this.shown.set({ run, at });
    history.replaceState(null, "", `#${new URLSearchParams({ token: token(), ...(run ? { run, at } : {}) })}`);
  };

  /** Show a configuration on the map and as a bigraph. */
  show = (view) => this.store.apply({ type: "snapshot", state: view });

  async openMap(element) {
    const { createMap } = await import("/parts/map/map.js");
    this.map = createMap(element, this.store, { select: (name) => this.chosen.set(name), fetchJson: this.#fetchJson, covers: () => document.querySelectorAll(".map-tools button") });
    this.map.setTheme(this.theme.value);
    this.handles = new Handles(this.map.leaflet, (points, radius) => this.#edit({ edit: "reshape", name: this.chosen.value, points, radius }));
    element.addEventListener("dragover", (event) => event.preventDefault());
    element.addEventListener("drop", (event) => {
      event.preventDefault();
      this.drop(event.dataTransfer.files);
    });
  }

  // --- the world on the map

  async #seeShapes() {
    const { text } = this.editor;
    const shapes = await this.connection.ask("world", { text }).catch(() => null);
    if (shapes && text === this.editor.text) this.shapes.set(shapes);
  }

  #handle() {
    const { value } = this.chosen;
    this.handles?.show(value, this.drawing.value ? this.shapes.value.shapes[value] : null);
  }

  add = (kind, shape) => {
    const { leaflet } = this.map;
    const { lat, lng } = leaflet.getCenter();
    const bounds = leaflet.getBounds();
    this.#edit({ edit: "add", kind, shape, at: [lat, lng], size: leaflet.distance(bounds.getNorthWest(), bounds.getSouthEast()) / 8 });
  };

  /** Change the text as an edit on the map asks for. */
  #edit = (edit) => this.#change("world", { edit });

  async #change(type, frame) {
    const { text } = this.editor;
    try {
      const { changes, name } = await this.connection.ask(type, { text, ...frame });
      if (text !== this.editor.text) throw new Error("the text has changed meanwhile: try again");
      if (changes.length) this.editor.edit(changes);
      await this.#seeShapes();
      if (name) this.chosen.set(name);
    } catch (problem) {
      this.problem.set(problem.message);
      this.#handle();
    }
  }

  /** Save dropped files of places beside the mission, and take them into the world. */
  drop = async (files) => {
    for (const file of files) {
      if (file.size > MOST_FILE) this.problem.set(`${file.name} is over 4 MB: too large to be dropped here`);
      else await this.#change("drop", { name: file.name, content: await base64(file) });
    }
  };

  /** Get JSON from the program that serves this page, with the token. */
  #fetchJson = async (path) => {
    const answer = await fetch(path, { headers: { Authorization: `Bearer ${token()}` } });
    if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
    return answer.json();
  };

  #judged({ number, report, refused }) {
    if (number !== this.number) return;
    this.verdicts.set(report ? { state: "done", report } : { state: "refused", refused, report: this.verdicts.value.report });
    this.editor.mark(report ? marksOf(report) : []);
  }

  /** Fly the mission's file with simulated vehicles; the console opens in a page of its own. */
  fly = async () => {
    this.flight.set({ state: "starting" });
    try {
      this.flight.set({ state: "flying", link: await this.connection.ask("fly", {}) });
    } catch (problem) {
      this.flight.set({ state: "none" });
      this.problem.set(problem.message);
    }
  };

  /** Have the explorer show the run that proves a verdict. */
  showRun = (name) => {
    const found = this.verdicts.value.report?.properties.find((each) => each.name === name);
    const trace = found && runOf(found);
    if (!trace) return;
    this.wanted.set({ trace });
    document.querySelector(".exploring").scrollIntoView({ block: "nearest" }); // on a phone it is below
  };

  save = () => {
    if (!this.editor || this.other.value !== null) return; // the page asks which text is kept
    this.saving = this.editor.text;
    this.connection.send("save", { text: this.saving, over: this.digest });
  };

  #saved(digest) {
    this.digest = digest;
    this.inFile = this.saving;
    this.problem.set("");
    this.unsaved.set(this.editor.text !== this.inFile);
  }

  /** Take the text that another program has saved; ask where that would lose what was written here. */
  #changed({ text, digest }) {
    this.digest = digest;
    this.inFile = text;
    if (!this.editor) return;
    if (this.unsaved.value && this.editor.text !== text) this.other.set(text);
    else this.takeOther(text);
  }

  takeOther(text) {
    this.other.set(null);
    this.editor.replace(text);
    this.unsaved.set(false);
  }

  keepMine() {
    this.other.set(null);
    this.unsaved.set(this.editor.text !== this.inFile);
  }

  otherTheme = () => this.look.set(this.theme.value === "dark" ? "light" : "dark");
}

/** A file's bytes in base 64. */
async function base64(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  let text = "";
  for (let at = 0; at < bytes.length; at += 32_768) text += String.fromCharCode(...bytes.subarray(at, at + 32_768));
  return btoa(text);
}

function Page({ app }) {
  const opened = useWatched(app.opened);
  const beginning = useWatched(app.beginning);
  return html`<div class="studio">
    <${Top} app=${app} />
    <${Trouble} app=${app} />
    ${beginning && html`<${Begin} app=${app} ...${beginning} />`}
    ${opened && html`<main>
      <section class="text" aria-label="Text"><${EditorElement} app=${app} key=${opened.uri} /><${Verdicts} app=${app} /></section>
      <section class="map-area" aria-label="Map"><${MapElement} app=${app} /><${MapTools} app=${app} /></section>
      <section class="picture" aria-label="Bigraph"><${Bigraph} app=${app} /></section>
      <section class="exploring" aria-label="Explorer"><${Exploring} app=${app} /></section>
    </main>`}
  </div>`;
}

function Top({ app }) {
  const opened = useWatched(app.opened);
  const unsaved = useWatched(app.unsaved);
  useWatched(app.theme);
  return html`<header class="top">
    <h1>${opened?.name ?? "bigactors studio"}</h1>
    ${opened && html`<button type="button" class="save" disabled=${!unsaved} title="Ctrl-S" onClick=${app.save}>Save</button>
      <span class=${unsaved ? "late" : "quiet"} role="status">${unsaved ? "not saved" : "saved"}</span>`}
    <span class="space"></span>
    ${opened && html`<${Flight} app=${app} unsaved=${unsaved} />`}
    <button type="button" class="icon" aria-label="light or dark" title="light or dark" onClick=${app.otherTheme}>◐</button>
  </header>`;
}

function whyNotFlown(state, report, unsaved) {
  if (state === "refused") return "Fly: mend the mistakes of the text first.";
  if (state === "done" && report.exit_code !== 0) return "Fly: everything has to hold first.";
  if (unsaved) return "Fly: save the text first.";
  return state === "done" ? "" : "Fly: the verdicts are awaited.";
}

/** The way to a simulated flight: only of a saved text of which everything holds. */
function Flight({ app, unsaved }) {
  const { state, report } = useWatched(app.verdicts);
  const flight = useWatched(app.flight);
  const why = whyNotFlown(state, report, unsaved);
  return html`${flight.state === "flying" && html`<a href=${flight.link} target="_blank" rel="noreferrer">Open the console of the flight</a>`}
    ${flight.state === "flown" && html`<span class="quiet" role="status">The flight has ended: Open a run takes ${flight.recording}</span>`}
    <span class="quiet unflown">${why}</span>
    <button type="button" class="fly" disabled=${why !== "" || flight.state === "starting"} title=${why || "with simulated vehicles, ten times as fast, in the operator's console"} onClick=${app.fly}>${flight.state === "starting" ? "Starting …" : "Fly"}</button>`;
}

/** The last error, with its remedy. */
function Trouble({ app }) {
  const problem = useWatched(app.problem);
  const other = useWatched(app.other);
  const { state, code, reason } = useWatched(app.connection.state);
  const closed = code === 4401 ? "This link's token is not that of the program: open the link that it printed." : reason || "The program has ended. Your text is still here: copy it before you close this page.";
  return html`<div role="alert">
    ${state === "closed" && html`<p class="trouble">${closed}</p>`}
    ${other !== null && html`<p class="trouble">Another program has saved this file, and your text is not saved.
      <button type="button" onClick=${() => app.takeOther(other)}>Take its text (Undo brings yours back)</button>
      <button type="button" onClick=${() => app.keepMine()}>Keep mine</button></p>`}
    ${problem && html`<p class="trouble">${problem} <button type="button" aria-label="close" onClick=${() => app.problem.set("")}>×</button></p>`}
  </div>`;
}

/** How a mission begins that has no file yet. */
function Begin({ app, name, source, folder, shipped }) {
  const begin = (event) => {
    event.preventDefault();
    const given = new FormData(event.target);
    app.begin(given.get("name"), given.get("source"));
  };
  return html`<div role="main"><form class="begin" onSubmit=${begin}>
    <h2>A new mission</h2>
    <label>Name <${Field} name="name" value=${name || source} required=${true} maxlength="100" placeholder="patrol" /></label>
    <label>Begin with <select name="source">
      <option value="" selected=${!source}>the template: a small first mission with comments</option>
      ${shipped.map((each) => html`<option key=${each} value=${each} selected=${each === source}>${each}, which ships</option>`)}
    </select></label>
    <button type="submit">Begin</button>
    <p class="quiet">NAME.mission is written into ${folder}. To open another file: bigactors studio FILE.</p>
  </form></div>`;
}

/** The editor's element, which preact draws once. */
const EditorElement = memo(({ app }) => {
  const element = useRef(null);
  useEffect(() => {
    app.openEditor(element.current).catch((problem) => app.problem.set(`There is no editor: ${problem.message}`));
    return () => app.editor?.destroy();
  }, []);
  return html`<div class="editor" ref=${element}></div>`;
});

/** The map's element, which preact draws once: the map itself draws its content. */
const MapElement = memo(({ app }) => {
  const element = useRef(null);
  useEffect(() => {
    app.openMap(element.current).catch((problem) => app.problem.set(`There is no map: ${problem.message}`));
    return () => app.map?.destroy();
  }, []);
  return html`<div id="map" ref=${element}></div>`;
});

function Exploring({ app }) {
  const wanted = useWatched(app.wanted);
  const { run, at } = useWatched(app.shown);
  return wanted && html`<h2 class="unseen">Explorer</h2>
    <${Explorer} ask=${app.ask} state=${wanted} onLook=${app.looked}
      graph=${html`<${Graph} ask=${app.ask} run=${run} at=${at} onGo=${(there) => app.wanted.set({ run: there })} />`} />`;
}

function MapTools({ app }) {
  const chosen = useWatched(app.chosen);
  return html`<div class="map-tools" role="toolbar" aria-label="Map">
    <button type="button" title="show all places and entities" onClick=${() => app.map?.fit()}>Fit</button>
    <${DrawingTools} app=${app} />
    ${chosen !== null && html`<button type="button" class="chosen-name" title="choose nothing" onClick=${() => app.chosen.set(null)}>${chosen} ×</button>`}
  </div>`;
}

const app = new Studio();
globalThis.studio = app; // for programs that drive this page
const place = document.getElementById("app");
place.replaceChildren();
render(html`<${Page} app=${app} />`, place);
