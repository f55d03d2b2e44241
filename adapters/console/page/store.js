/**
 * The last state from the server: sections of keys and values (protocol bigactors.console/1).
 *
 * A value is replaced as a whole and never changed in place, so that `===` detects a change.
 */
export class Store {
  #sections = new Map();
  #listeners = new Set();

  /** The section's values by key; it is always the same Map, so that callers may keep it. */
  section(name) {
    let found = this.#sections.get(name);
    if (!found) this.#sections.set(name, (found = new Map()));
    return found;
  }

  /**
   * Call `listener({section: Set of keys})` after each frame that changed one of the named sections, with only those
   * sections. Returns a function that unsubscribes.
   */
  on(names, listener) {
    const entry = { names, listener };
    this.#listeners.add(entry);
    return () => this.#listeners.delete(entry);
  }

  /** Take in a `snapshot` or `changes`. */
  apply(frame) {
    const changed = {};
    if (frame.type === "snapshot") this.#replace(frame.state, changed);
    else this.#change(frame.set ?? {}, frame.gone ?? {}, changed);
    this.#tell(changed);
  }

  #replace(state, changed) {
    for (const name of new Set([...this.#sections.keys(), ...Object.keys(state)])) {
      const section = this.section(name);
      const values = state[name] ?? {};
      for (const key of [...section.keys()]) if (!Object.hasOwn(values, key)) this.#drop(name, key, changed);
      for (const [key, value] of Object.entries(values)) this.#put(name, key, value, changed);
    }
  }

  #change(set, gone, changed) {
    for (const [name, keys] of Object.entries(gone)) for (const key of keys) this.#drop(name, key, changed);
    for (const [name, values] of Object.entries(set))
      for (const [key, value] of Object.entries(values)) this.#put(name, key, value, changed);
  }

  #put(name, key, value, changed) {
    this.section(name).set(key, value);
    (changed[name] ??= new Set()).add(key);
  }

  #drop(name, key, changed) {
    if (this.section(name).delete(key)) (changed[name] ??= new Set()).add(key);
  }

  #tell(changed) {
    for (const { names, listener } of [...this.#listeners]) {
      const theirs = Object.fromEntries(Object.entries(changed).filter(([name]) => names.includes(name)));
      if (Object.keys(theirs).length) listener(theirs);
    }
  }
}
