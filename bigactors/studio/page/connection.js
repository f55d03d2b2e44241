/** The websocket to the program: frames by their type, and answers by their number. */
import { Watched } from "/parts/ui.js";

const PROTOCOL = "bigactors.studio/1";

export class Connection {
  /** Whether the program hears this page: "connecting", "open" or, with a reason, "closed". */
  state = new Watched({ state: "connecting" });
  #handlers = {};
  #answers = new Map();
  #number = 0;

  constructor(token) {
    this.token = token;
  }

  /** Call handlers by the type of a frame. */
  connect(handlers) {
    this.#handlers = handlers;
    this.socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`);
    this.socket.onopen = () => {
      this.send("hello", { protocol: PROTOCOL, token: this.token });
      this.state.set({ state: "open" });
    };
    this.socket.onmessage = ({ data }) => this.#hear(JSON.parse(data));
    this.socket.onclose = ({ code, reason }) => {
      for (const { reject } of this.#answers.values()) reject(new Error("the program has ended"));
      this.#answers.clear();
      this.state.set({ state: "closed", code, reason });
    };
  }

  send(type, frame = {}) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ type, ...frame }));
  }

  /** Send a frame, and return the promise of its answer; it fails with the program's words. */
  ask(type, frame) {
    const id = ++this.#number;
    const answer = new Promise((resolve, reject) => this.#answers.set(id, { resolve, reject }));
    this.send(type, { ...frame, id });
    return answer;
  }

  #hear(frame) {
    const waiting = frame.id === undefined ? null : this.#answers.get(frame.id);
    if (!waiting) return this.#handlers[frame.type]?.(frame);
    this.#answers.delete(frame.id);
    if (frame.refused === undefined) waiting.resolve(frame.answer);
    else waiting.reject(new Error(frame.refused));
  }
}
