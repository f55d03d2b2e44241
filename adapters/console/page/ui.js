/** What the page's parts share: preact, hooks that watch the store, and values that are the page's own. */
import { html, render, Component, useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState } from "./parts/preact.js";

export { html, render, Component, useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState };

/** A value of the page's own, which tells who watches it that it has changed. */
export class Watched {
  #listeners = new Set();
  constructor(value) {
    this.value = value;
  }
  set(value) {
    if (Object.is(value, this.value)) return;
    this.value = value;
    for (const listener of [...this.#listeners]) listener(value);
  }
  on(listener) {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }
}

/** The value of something watched, as soon as it is not null. */
export function first(watched) {
  if (watched.value !== null) return Promise.resolve(watched.value);
  return new Promise((resolve) => {
    const off = watched.on((value) => {
      if (value === null) return;
      off();
      resolve(value);
    });
  });
}

/** A value that outlives the page, where the browser lets it. */
export function kept(key, fallback) {
  const watched = new Watched(fallback);
  try {
    watched.set(localStorage.getItem(`bigactors.${key}`) ?? fallback);
    watched.on((value) => localStorage.setItem(`bigactors.${key}`, value));
  } catch {
    // Storage is refused in some private windows: the value lasts as long as the page.
  }
  return watched;
}

export function useWatched(watched) {
  const [value, set] = useState(watched.value);
  useLayoutEffect(() => {
    set(watched.value);
    return watched.on(set);
  }, [watched]);
  return value;
}

/**
 * An input of text, which owns what is typed: a drawing writes into it only another `value` from outside, and leaves the
 * text, the caret and the focus alone.
 */
export function Field({ value, ...attributes }) {
  const input = useRef(null);
  useLayoutEffect(() => {
    input.current.value = value;
  }, [value]);
  return html`<input ref=${input} autocomplete="off" ...${attributes} />`;
}

/**
 * A modal dialog. It opens and closes with the drawing that says so: keys that are pressed until a later frame would go to
 * what has no focus any more. `closed` is called when its user has closed it.
 */
export function Modal({ open, closed, children, ...attributes }) {
  const dialog = useRef(null);
  useLayoutEffect(() => {
    if (open === dialog.current.open) return;
    if (!open) return dialog.current.close();
    dialog.current.showModal();
    dialog.current.querySelector("input[required]")?.focus(); // by touch it would not have it
  }, [open]);
  return html`<dialog ref=${dialog} onClose=${(event) => event.currentTarget.open || closed()} ...${attributes}>${children}</dialog>`;
}

/** How many drawings are owed for what has come: 0 where all of it is shown. */
export const owed = new Watched(0);

/** Render again when one of the sections has changed, at most once in `pause` milliseconds. */
export function useSections(store, names, pause = 100) {
  const [, again] = useState(0);
  useLayoutEffect(() => {
    let timer = null;
    let last = -Infinity;
    const settle = () => {
      if (timer === null) return;
      clearTimeout(timer);
      timer = null;
      owed.set(owed.value - 1);
    };
    const draw = () => {
      last = performance.now();
      again((n) => n + 1);
      settle();
    };
    const changed = () => {
      if (timer !== null) return;
      timer = setTimeout(draw, Math.max(0, last + pause - performance.now()));
      owed.set(owed.value + 1);
    };
    const off = store.on(names, changed);
    changed(); // what came between the first drawing and now
    return () => {
      off();
      settle();
    };
  }, [store]);
  return names.map((name) => store.section(name));
}

/** A component that is drawn anew only when one of its props is another value, or what its own hooks watch. */
export function memo(draw) {
  return class extends Component {
    shouldComponentUpdate(next) {
      const names = new Set([...Object.keys(this.props), ...Object.keys(next)]);
      return [...names].some((name) => name !== "children" && !Object.is(this.props[name], next[name]));
    }
    render(props) {
      return html`<${draw} ...${props} />`; // one of its own: in this class, hooks would not draw it anew
    }
  };
}

const NATURAL = new Intl.Collator("en", { numeric: true });
export const byName = (a, b) => NATURAL.compare(a, b);
