/** The shown moment, which goes on between frames, and texts that update themselves each tick. */
import { html, useEffect, useLayoutEffect, useRef } from "./ui.js";
import { age } from "./units.js";

const TICK = 250;

/** Milliseconds after which an unanswered request is given up. */
const ANSWERED = 5_000;

export class Clock {
  #texts = new Set();
  #store;
  #anchor = { now: null, at: 0 };
  #connected = true;
  #held = false;
  /** The last requested mode, until the server shows it: `{live, playing, speed}`. */
  #asked = null;

  constructor(store) {
    this.#store = store;
    store.on(["clock"], ({ clock }) => this.#hear(clock));
    setInterval(() => this.tick(), TICK);
  }

  get(key) {
    return this.#store.section("clock").get(key) ?? null;
  }

  /** Without a connection the shown moment stands still. */
  set connected(connected) {
    if (connected === this.#connected) return;
    this.#anchor = { now: this.now, at: performance.now() };
    this.#connected = connected;
  }

  /** Show a requested moment, until the answer has the real one. */
  expect(time) {
    this.#anchor = { now: time, at: performance.now() };
  }

  /** Assume a requested mode, until the server shows it. */
  ask({ live = false, playing = false, speed = this.get("speed") }) {
    this.#asked = { live, playing, speed, until: performance.now() + ANSWERED };
  }

  /** The mode, as requested last: `{live, playing, speed}`. */
  get wanted() {
    return this.#asked && performance.now() < this.#asked.until ? this.#asked : this.#shown;
  }

  get #shown() {
    return { live: Boolean(this.get("live")), playing: Boolean(this.get("playing")), speed: this.get("speed") };
  }

  /** Seconds of the shown time per second of wall time. */
  get rate() {
    if (!this.#connected || this.#held) return 0;
    if (this.get("live")) return this.get("ended") ? 0 : this.get("rate") ?? 1;
    return this.get("playing") ? this.get("speed") ?? 1 : 0;
  }

  /** Hold one moment, as while a slider is moved; null lets time go on from the shown moment. */
  hold(time) {
    this.#anchor = { now: time ?? this.now, at: performance.now() };
    this.#held = time !== null;
    this.tick();
  }

  /** The shown moment; in replay it stays within the recording. */
  get now() {
    const { now, at } = this.#anchor;
    if (now === null) return null;
    const moved = now + (this.rate * (performance.now() - at)) / 1000;
    return this.get("live") ? moved : Math.min(moved, this.get("head") ?? moved);
  }

  /** Whether the run has ended and its end is shown. */
  get atEnd() {
    return Boolean(this.get("ended")) && !this.get("playing") && (this.get("live") || this.get("now") >= this.get("head"));
  }

  /** Seconds without a new message, while the run goes on. */
  get silence() {
    return this.get("live") && !this.get("ended") ? (performance.now() - this.#anchor.at) / 1000 : 0;
  }

  /** Call `apply(now)` at every tick; returns a function that ends the calls. */
  each(apply) {
    this.#texts.add(apply);
    return () => this.#texts.delete(apply);
  }

  tick() {
    const now = this.now;
    if (now !== null) for (const apply of this.#texts) apply(now);
  }

  #hear(keys) {
    const moved = ["now", "live", "playing", "speed"].some((key) => keys.has(key));
    if (moved && !this.#held) this.#anchor = { now: this.get("now"), at: performance.now() };
    const { live, playing, speed } = this.#shown;
    const asked = this.#asked;
    if (asked?.live === live && asked.playing === playing && (!playing || asked.speed === speed)) this.#asked = null;
  }
}

/** An element whose look depends on the time alone: `apply(element, now)` at every tick, without a rendering. */
export function Ticking({ clock, apply, children, ...attributes }) {
  const element = useRef(null);
  const latest = useRef(apply);
  latest.current = apply;
  useLayoutEffect(() => {
    if (clock.now !== null) latest.current(element.current, clock.now);
  });
  useEffect(() => clock.each((now) => latest.current(element.current, now)), [clock]);
  return html`<span ref=${element} ...${attributes}>${children}</span>`;
}

/** The age of a time: "12 s". */
export function Age({ clock, time, ...attributes }) {
  return html`<${Ticking} clock=${clock} apply=${(element, now) => say(element, age(time, now))} ...${attributes} />`;
}

export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
