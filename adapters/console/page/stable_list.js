/** A list that stands still under a hand: its items keep their order while someone is about to press a button there. */
import { useLayoutEffect, useRef, useState } from "./ui.js";

/** Milliseconds after the last pointer motion or key until the order may change; on a button it never changes. */
const STILL = 5000;
const BUTTON = ".held";
const HOVERS = matchMedia("(hover: hover)"); // a finger leaves a hover behind

/**
 * Return whether a list has to stand still, and the handlers of pointer and key events. The item under the hand keeps its
 * place on the screen even when an item above it grows or shrinks: the list scrolls by the difference.
 */
export function useStillness(list) {
  const [, again] = useState(0);
  const touched = useRef(-Infinity);
  const timer = useRef(null);
  const held = useRef(null);

  const isOnButton = () => {
    const busy = [`${BUTTON}:focus-visible`, `${BUTTON}.pressed`, ...(HOVERS.matches ? [`${BUTTON}:hover`] : [])];
    return Boolean(list.current?.querySelector(busy.join()));
  };
  const isStill = () => isOnButton() || performance.now() - touched.current < STILL;
  const hold = (element) => (held.current = element && { element, top: topOf(list.current, element) });
  /** Check again later whether the hand has gone. */
  const wait = () => {
    clearTimeout(timer.current);
    timer.current = setTimeout(() => (isStill() ? wait() : release()), STILL);
  };
  const touch = (event) => {
    touched.current = performance.now();
    hold(event.target.closest?.(".card, .fleet"));
    wait();
  };
  const release = () => {
    touched.current = -Infinity;
    if (isOnButton()) return wait();
    clearTimeout(timer.current);
    hold(null);
    Object.assign(list.current.style, { paddingTop: "", paddingBottom: "" });
    again((n) => n + 1);
  };
  useLayoutEffect(() => {
    const observer = new ResizeObserver(() => held.current?.element.isConnected && keep(list.current, held.current));
    observer.observe(list.current.firstElementChild);
    return () => {
      observer.disconnect();
      clearTimeout(timer.current);
    };
  }, []);
  const scrolled = () => held.current && hold(held.current.element);
  const hand = { onPointerMove: touch, onPointerDown: touch, onKeyDown: touch, onFocusIn: touch, onPointerLeave: ({ pointerType }) => (pointerType === "mouse" ? release() : wait()), onFocusOut: wait, onScroll: scrolled };
  return [isStill, hand];
}

const topOf = (list, element) => element.getBoundingClientRect().top - list.getBoundingClientRect().top;

/** Scroll a list so that an element keeps its place on the screen; add room below if the list is too short. */
function keep(list, { element, top }) {
  const moved = () => topOf(list, element) - top;
  if (Math.abs(moved()) < 1) return;
  list.style.paddingBottom = `${list.clientHeight}px`;
  list.scrollTop += moved();
  const missing = -moved();
  if (missing >= 1) list.style.paddingTop = `${Number.parseFloat(getComputedStyle(list).paddingTop) + missing}px`;
}
