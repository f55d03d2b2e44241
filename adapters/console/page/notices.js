/** Notices: the state of each action that this page asked for, until it is final, and short messages that disappear. */
import { html, useWatched, Watched } from "./ui.js";
import { fateOf } from "./wording.js";

const SHOWN = 6000;
/** Notices at once: refusals stay until they are closed. */
const MOST = 5;
/** Milliseconds after which the notice of an unconfirmed action is closed; the vehicle's card still shows it. */
const PATIENCE = 60_000;

export class Notices {
  list = new Watched([]);
  #actions;
  #number = 0;

  constructor(store) {
    this.#actions = store.section("actions");
    store.on(["actions"], () => this.#follow());
  }

  /** Show a message for a few seconds, in place of an earlier one. */
  tell = (text) => {
    this.list.set(this.list.value.filter(({ passing }) => !passing));
    this.#fade(this.#put({ text, state: "told", passing: true }));
  };

  /** Show that an action was asked for; returns the notice, for `answered`. */
  asked({ what, about }, by) {
    const notice = { action: { what, about, by }, state: "asked", known: new Set(this.#actions.keys()) };
    return this.#put({ ...notice, text: textOf(notice.action, "asked") });
  }

  /** Show the run's answer; it settles an action that is not recorded. */
  answered(number, { refusal, left_out: leftOut, notes }, isRecorded) {
    const more = [...Object.entries(leftOut ?? {}).map(([name, why]) => `not ${name}: ${why}`), ...(notes ?? [])];
    const state = refusal ? "refused" : isRecorded ? "asked" : "confirmed";
    this.#change(number, (notice) => ({ ...notice, state, more, text: textOf(notice.action, state, refusal, more) }));
    if (state === "refused") return; // until somebody closes it
    if (state === "confirmed") return this.#fade(number);
    this.#change(number, (notice) => ({ ...notice, follows: true }));
    setTimeout(() => this.#leave(number), PATIENCE);
    this.#follow();
  }

  close = (number) => this.list.set(this.list.value.filter((notice) => notice.number !== number));

  /** Update the notices of accepted actions from the recording, until their states are final. */
  #follow() {
    for (const { number, action, known, more, key: mine } of this.list.value.filter((notice) => notice.follows)) {
      const key = mine ?? [...this.#actions].find(([each, said]) => !known.has(each) && ["what", "about", "by"].every((part) => said[part] === action[part]))?.[0];
      const said = this.#actions.get(key);
      if (!said) continue;
      for (const other of this.list.value) other.known?.add(key); // two equal actions have a record each
      this.#change(number, (notice) => ({ ...notice, key, state: said.state, follows: !said.answered, text: textOf(said, said.state, said.why, more) }));
      if (said.answered && said.state !== "refused") this.#fade(number);
    }
  }

  /** Close the notice of an unconfirmed action; a refusal stays until it is closed, or the vehicle obeys. */
  #leave(number) {
    if (this.list.value.find((notice) => notice.number === number)?.state !== "refused") this.close(number);
  }

  #put(notice) {
    const number = ++this.#number;
    this.list.set([...this.list.value.slice(1 - MOST), { ...notice, number }]);
    return number;
  }

  #change(number, change) {
    this.list.set(this.list.value.map((notice) => (notice.number === number ? change(notice) : notice)));
  }

  #fade(number) {
    setTimeout(() => this.close(number), SHOWN);
  }
}

function textOf(action, state, why = "", more = []) {
  return [`${action.what} ${action.about}: ${fateOf({ ...action, state })}${why ? `: ${why}` : ""}`, ...more].join("; ");
}

export function NoticeList({ app }) {
  const notices = useWatched(app.notices.list);
  return html`<div class="notices" role="status">${notices.map(({ number, text, state }) => html`<p key=${number} class=${`notice ${state}`}><span>${text}</span>
    <button type="button" aria-label="close this notice" onClick=${() => app.notices.close(number)}>×</button></p>`)}</div>`;
}
