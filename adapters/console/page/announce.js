/** Announces changes to people who cannot see the screen, in at most one sentence every few seconds. */
import { fateOf } from "./wording.js";

const PAUSE = 3000;
const MOST = 4;

export class Announcer {
  #element;
  #levels = new Map();
  #authority = new Map();
  #fates = new Map();
  #waiting = new Map();
  #timer = null;

  constructor(app, element) {
    element.className = "unseen";
    element.setAttribute("aria-live", "polite");
    this.#element = element;
    app.store.on(["vehicles"], ({ vehicles }) => this.#vehicles(vehicles, app.store.section("vehicles")));
    app.store.on(["actions"], ({ actions }) => this.#actions(actions, app.store.section("actions")));
    app.link.state.on(({ state }) => this.#say("*link", state === "open" ? "connected" : "not connected"));
  }

  #vehicles(keys, section) {
    for (const name of keys) {
      const card = section.get(name);
      const words = card ? `${card.word}${card.why ? `: ${card.why}` : ""}` : "gone";
      this.#obeys(name, card?.authority?.join(", ") ?? "");
      const before = this.#levels.get(name);
      this.#levels.set(name, card?.word);
      if (before !== card?.word && (before !== undefined || card?.level > 0)) this.#say(name, `${name} ${words}`);
    }
  }

  #obeys(name, now) {
    const before = this.#authority.get(name);
    this.#authority.set(name, now);
    if (before !== undefined && before !== now) this.#sayFirst(`authority ${name}`, `${name} is under ${now || "nobody"} now, before ${before || "nobody"}`);
  }

  #actions(keys, section) {
    for (const key of keys) {
      const action = section.get(key);
      if (!action || this.#fates.get(key) === action.state) continue;
      const known = this.#fates.has(key);
      this.#fates.set(key, action.state);
      if (known) this.#sayFirst(`action ${key}`, `${action.what} ${action.about ?? ""} ${fateOf(action)}`);
    }
  }

  #say(about, words) {
    this.#waiting.set(about, words);
    this.#timer ??= setTimeout(() => this.#tell(), PAUSE);
  }

  /** Announce first, so that this sentence is not among those that are only counted. */
  #sayFirst(about, words) {
    this.#waiting = new Map([[about, words], ...this.#waiting]);
    this.#say(about, words);
  }

  #tell() {
    const said = [...this.#waiting.values()];
    const more = said.length > MOST ? `; and ${said.length - MOST} more` : "";
    this.#element.textContent = said.slice(0, MOST).join("; ") + more;
    this.#waiting.clear();
    this.#timer = null;
  }
}
