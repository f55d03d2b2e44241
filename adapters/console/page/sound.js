/** A sound, and the tab's title, for alarms that nobody has acknowledged. Browsers allow sound after the first gesture. */
import { standing } from "./alert.js";
import { kept } from "./ui.js";

/** Milliseconds between two sounds while an alarm stands. */
const AGAIN = 10_000;
const TONES = [[880, 0], [660, 0.18], [880, 0.36]];
const LENGTH = 0.15;

export class Sound {
  /** "on" or "off", remembered by the browser. */
  wanted = kept("sound", "on");
  #store;
  #context = null;
  #known = new Set();
  #timer = null;

  constructor(store) {
    this.#store = store;
    store.on(["alarms", "mission", "clock"], () => this.#look());
    this.wanted.on(() => this.#look());
    for (const gesture of ["pointerdown", "keydown"]) addEventListener(gesture, () => this.#wake(), { once: true, capture: true });
  }

  #wake() {
    this.#context ??= new AudioContext();
    this.#look();
  }

  /** Sound at each new alarm, and again while one stands; a past run is silent. */
  #look() {
    const alarms = this.#store.section("alarms");
    const name = this.#store.section("mission").get("name") ?? "bigactors console";
    const [, newest] = standing(alarms, this.#store.section("vehicles"))[0] ?? [];
    document.title = newest ? `(${alarms.size}) ${newest.about || newest.kind}: ${newest.kind} · ${name}` : name;
    const runs = !this.#store.section("clock").get("ended");
    const isNew = [...alarms.keys()].some((key) => !this.#known.has(key));
    this.#known = new Set(alarms.keys());
    const sounds = runs && alarms.size > 0 && this.wanted.value === "on" && this.#context !== null;
    if (sounds && (isNew || this.#timer === null)) this.#play();
    if (!sounds) this.#quiet();
  }

  #play() {
    this.#quiet();
    this.#timer = setInterval(() => this.#sound(), AGAIN);
    this.#sound();
  }

  #quiet() {
    clearInterval(this.#timer);
    this.#timer = null;
  }

  #sound() {
    const context = this.#context;
    context.resume();
    const volume = context.createGain();
    volume.gain.value = 0.2;
    volume.connect(context.destination);
    for (const [pitch, at] of TONES) {
      const tone = context.createOscillator();
      tone.frequency.value = pitch;
      tone.connect(volume);
      tone.start(context.currentTime + at);
      tone.stop(context.currentTime + at + LENGTH);
    }
  }
}
