/** The websocket: it sends hello, puts frames into the store, and reconnects after a loss, with ever longer pauses. */
import { Watched } from "./ui.js";

export const PROTOCOL = "bigactors.console/1";
const FIRST_PAUSE = 0.5;
const LONGEST_PAUSE = 10;
const NOT_ADMITTED = 4401;
const NO_NAME = 4402;
const REFUSED = {
  4400: "this page is of another version than the program that serves it: load it anew",
  [NOT_ADMITTED]: "the token is not accepted: open the link that the program printed",
};

export class Link {
  /** `{state: "connecting"|"early"|"open"|"waiting"|"refused", since, retry, why}`; `early`: the run has not begun. */
  state = new Watched({ state: "connecting", since: Date.now() / 1000 });
  /** The server's welcome, null before the first. */
  welcome = new Watched(null);
  /** The server's complaint about a message that it could not read. */
  error = new Watched("");
  #store;
  #socket = null;
  #pause = FIRST_PAUSE;
  #timer = null;
  #asked = new Map();
  #number = 0;
  /** The number of the newest frame in the store; 0 before the first. */
  frame = 0;

  /** `nameless` is called when the server refuses the name as invalid. */
  constructor(store, { token, name, nameless }) {
    this.#store = store;
    this.nameless = nameless;
    this.token = token;
    this.name = name;
    addEventListener("online", () => this.#timer !== null && this.connect());
  }

  connect() {
    clearTimeout(this.#timer);
    this.#timer = null;
    this.#drop();
    this.#state({ state: "connecting" });
    const address = new URL("/ws", location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    address.hash = "";
    const socket = (this.#socket = new WebSocket(address));
    socket.onopen = () => socket.send(JSON.stringify({ type: "hello", protocol: PROTOCOL, token: this.token, name: this.name }));
    socket.onmessage = ({ data }) => this.#hear(JSON.parse(data));
    socket.onclose = ({ code, reason }) => this.#lose(code, reason);
  }

  /** Send a message that has no answer; it is lost without a connection. */
  send(message) {
    if (this.state.value.state === "open") this.#socket.send(JSON.stringify(message));
  }

  /** Ask for an action; resolves to the answer, whose `refusal` is "" if it was not refused. */
  act(action) {
    if (this.state.value.state !== "open") return Promise.resolve({ refusal: "there is no connection" });
    const id = String(++this.#number);
    this.send({ type: "act", id, action });
    return new Promise((resolve) => this.#asked.set(id, resolve));
  }

  #hear(frame) {
    if (frame.type === "welcome") {
      this.#pause = FIRST_PAUSE;
      this.welcome.set(frame);
    } else if (frame.type === "waiting") this.#state({ state: "early", why: frame.message });
    else if (frame.type === "snapshot") {
      this.#take(frame);
      this.#state({ state: "open" });
    } else if (frame.type === "changes") {
      if (frame.n !== this.frame + 1) return this.connect(); // a frame was lost: a new connection brings a snapshot
      this.#take(frame);
    } else if (frame.type === "answer") this.#answer(frame.id, frame);
    else if (frame.type === "error") this.error.set(frame.message);
  }

  #take(frame) {
    this.frame = frame.n;
    this.#store.apply(frame);
  }

  #answer(id, answer) {
    this.#asked.get(id)?.(answer);
    this.#asked.delete(id);
  }

  #lose(code, reason) {
    this.#socket = null;
    for (const id of [...this.#asked.keys()]) this.#answer(id, { refusal: "the connection was lost before an answer: look whether it was done" });
    if (code === NO_NAME) return this.nameless();
    if (REFUSED[code]) return this.#state({ state: "refused", why: REFUSED[code], asks: code === NOT_ADMITTED });
    const pause = this.#pause * (0.75 + Math.random() / 2);
    this.#pause = Math.min(LONGEST_PAUSE, this.#pause * 2);
    this.#timer = setTimeout(() => this.connect(), pause * 1000);
    this.#state({ state: "waiting", retry: Date.now() / 1000 + pause, why: reason });
  }

  #drop() {
    if (!this.#socket) return;
    this.#socket.onclose = this.#socket.onmessage = this.#socket.onopen = null;
    this.#socket.close();
    this.#socket = null;
    for (const id of [...this.#asked.keys()]) this.#answer(id, { refusal: "the connection was made anew before an answer: look whether it was done" });
  }

  /** Change the state; `since` stays the time of the loss through all attempts to reconnect. */
  #state(state) {
    const before = this.state.value;
    const lost = state.state !== "open" && before.state !== "open";
    this.state.set({ ...state, since: lost ? before.since : Date.now() / 1000 });
  }
}
