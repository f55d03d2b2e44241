/** What became of each action that this page asked for, until it is over; and short words that go by themselves. */
import { html, useWatched, Watched } from "./ui.js";
import { fateOf } from "./plainly.js";

const SHOWN = 6000;
/** Milliseconds after which an action that nobody has confirmed is left to its card. */
const PATIENCE = 60_000;
const OVER = ["confirmed", "refused"];

export class Notices {
  list = new Watched([]);
  #actions;
  #number = 0;

  constructor(store) {
    this.#actions = store.section("actions");
    store.on(["actions"], () => this.#follow());
  }

  /** Say something that is over in a few seconds, instead of what was said so before. */
  tell = (text) => {
    this.list.set(this.list.value.filter(({ passing }) => !passing));
    this.#fade(this.#put({ text, state: "told", passing: true }));
  };

  /** Say that an action was asked for; returns the notice, for `answered`. */
  asked({ what, about }, by) {
    const notice = { action: { what, about, by }, state: "asked", known: new Set(this.#actions.keys()) };
    return this.#put({ ...notice, text: textOf(notice.action, "asked") });
  }

  /** Say what the run has answered; what is not recorded as an action is done with it. */
  answered(number, { refusal, left_out: leftOut, notes }, isRecorded) {
    const more = [...Object.entries(leftOut ?? {}).map(([name, why]) => `not ${name}: ${why}`), ...(notes ?? [])];
    const state = refusal ? "refused" : isRecorded ? "sent" : "confirmed";
    this.#change(number, (notice) => ({ ...notice, state, more, text: textOf(notice.action, state, refusal, more) }));
    if (state !== "sent") return this.#fade(number);
    setTimeout(() => this.close(number), PATIENCE);
    this.#follow();
  }

  close = (number) => this.list.set(this.list.value.filter((notice) => notice.number !== number));

  /** Take over what the recording says of the actions that were sent. */
  #follow() {
    for (const { number, action, state, known, more } of this.list.value.filter((notice) => notice.known)) {
      if (state !== "sent") continue;
      const found = [...this.#actions].find(([key, each]) => !known.has(key) && ["what", "about", "by"].every((part) => each[part] === action[part]));
      if (!found || !OVER.includes(found[1].state)) continue;
      for (const other of this.list.value) other.known?.add(found[0]); // two equal actions have a record each
      this.#change(number, (notice) => ({ ...notice, state: found[1].state, text: textOf({ ...action, vain: found[1].vain }, found[1].state, found[1].why, more) }));
      this.#fade(number);
    }
  }

  #put(notice) {
    const number = ++this.#number;
    this.list.set([...this.list.value, { ...notice, number }]);
    return number;
  }

  #change(number, change) {
    this.list.set(this.list.value.map((notice) => (notice.number === number ? change(notice) : notice)));
  }

  #fade(number) {
    setTimeout(() => this.close(number), SHOWN);
  }
}

function textOf({ what, about, vain }, state, why = "", more = []) {
  return [`${what} ${about}: ${fateOf({ what, state, vain })}${why ? `, ${why}` : ""}`, ...more].join("; ");
}

export function NoticeList({ app }) {
  const notices = useWatched(app.notices.list);
  return html`<ul class="notices" role="status">${notices.map(({ number, text, state }) => html`<li key=${number} class=${`notice ${state}`}><span>${text}</span>
    <button type="button" aria-label="close this notice" onClick=${() => app.notices.close(number)}>×</button></li>`)}</ul>`;
}
