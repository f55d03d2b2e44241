/** Shared parts of the page: preact, hooks that watch the store, and observable values. */
import { html, render, Component, useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState } from "./parts/preact.js";
import { byName } from "./natural.js";

export { html, render, Component, useCallback, useEffect, useLayoutEffect, useMemo, useRef, useState };

/** An observable value: it calls its listeners when it changes. */
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

/** A promise of a watched value, resolved as soon as the value is not null. */
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

/** A watched value in the browser's storage, which outlives the page if the browser permits storage. */
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
 * A text input that owns its text: a drawing writes to it only if `value` has changed, and leaves the text, the caret and
 * the focus alone otherwise.
 */
export function Field({ value, ...attributes }) {
  const input = useRef(null);
  useLayoutEffect(() => {
    input.current.value = value;
  }, [value]);
  return html`<input ref=${input} autocomplete="off" ...${attributes} />`;
}

/**
 * A modal dialog. It opens and closes during the drawing itself: keys pressed before a later frame would miss the focused
 * element. `closed` is called when the user closes it.
 */
export function Modal({ open, closed, children, ...attributes }) {
  const dialog = useRef(null);
  useLayoutEffect(() => {
    if (open === dialog.current.open) return;
    if (!open) return dialog.current.close();
    dialog.current.showModal();
    dialog.current.querySelector("input[required]")?.focus(); // by touch it would not get the focus
  }, [open]);
  return html`<dialog ref=${dialog} onClose=${(event) => event.currentTarget.open || closed()} ...${attributes}>${children}</dialog>`;
}

/** The number of pending drawings of received changes; 0 once all are shown. */
export const owed = new Watched(0);

/** Return sections of the store, and render again when one has changed, at most once in `pause` milliseconds. */
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
    changed(); // changes between the first drawing and now
    return () => {
      off();
      settle();
    };
  }, [store]);
  return names.map((name) => store.section(name));
}

/** A component that is drawn anew only when one of its props or a value watched by its hooks has changed. */
export function memo(draw) {
  return class extends Component {
    shouldComponentUpdate(next) {
      const names = new Set([...Object.keys(this.props), ...Object.keys(next)]);
      return [...names].some((name) => name !== "children" && !Object.is(this.props[name], next[name]));
    }
    render(props) {
      return html`<${draw} ...${props} />`; // a component of its own: in this class, hooks would not draw it anew
    }
  };
}

export { byName };

/** Dress the page: in the chosen theme (`look`), or else in that of the system; `theme` has the one that it wears. */
export const dress = (look, theme) => {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const choose = () => theme.set(look.value || (dark.matches ? "dark" : "light"));
  const wear = () => { document.documentElement.dataset.theme = theme.value; };
  dark.addEventListener("change", choose);
  look.on(choose);
  theme.on(wear);
  choose();
  wear();
};

/** A list of tabs, `[key, title]` each; the arrow keys choose, too. `panelOf(key)` is the id of what a tab shows. */
export function Tabs({ label, tabs, chosen, choose, panelOf }) {
  const list = useRef(null);
  const go = (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    const at = tabs.findIndex(([key]) => key === chosen);
    choose(tabs[(at + step + tabs.length) % tabs.length][0]);
    requestAnimationFrame(() => list.current?.querySelector("[aria-selected=true]")?.focus());
  };
  return html`<div role="tablist" class="tabs" ref=${list} aria-label=${label} onKeyDown=${go}>
    ${tabs.map(([key, title]) => html`<button type="button" role="tab" key=${key} id=${`tab-${key}`} aria-controls=${panelOf(key)}
      aria-selected=${String(key === chosen)} tabindex=${key === chosen ? 0 : -1} onClick=${() => choose(key)}>${title}</button>`)}
  </div>`;
}
