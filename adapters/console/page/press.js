/** A button that acts after a press of one second, by pointer or by Enter or Space. */
import { html, useEffect, useRef, useState } from "./ui.js";

export const HOLD = 1000;
const CONFIRM = 5000;

/**
 * `label` describes the whole effect, `short` names it. `act` is called once for each press of full length. A short press
 * only shows a hint. Assistive technology presses without a duration: there, a second press within five seconds confirms.
 */
export function HeldButton({ act, children, disabled, tell, label, short = label, kind = "", ...attributes }) {
  const [pressed, setPressed] = useState(false);
  const timer = useRef(null);
  const armed = useRef(-Infinity);
  const began = useRef(0);
  const latest = useRef(act);
  latest.current = act;

  const cancel = () => {
    clearTimeout(timer.current);
    timer.current = null;
    setPressed(false);
  };
  const lasted = () => {
    timer.current = "done"; // until the release
    setPressed(false);
    latest.current();
  };
  const begin = (event) => {
    if (disabled || timer.current !== null) return;
    setPressed(true);
    began.current = event.timeStamp;
    timer.current = setTimeout(lasted, HOLD);
  };
  /** End a press; its duration is from the events' own times, since a busy page may receive both late. */
  const end = (event) => {
    if (timer.current !== null && timer.current !== "done") {
      clearTimeout(timer.current);
      if (event.timeStamp - began.current >= HOLD) lasted();
      else tell(`Not sent: keep ${short} pressed for one second.`);
    }
    cancel();
  };
  useEffect(() => cancel, []);
  useEffect(() => {
    if (disabled) cancel();
  }, [disabled]);

  const isKey = (event) => event.key === "Enter" || event.key === " ";
  const down = (event) => {
    if (!isKey(event)) return;
    event.preventDefault(); // no click, no scrolling, no shortcut of the page
    if (!event.repeat) begin(event);
  };
  const up = (event) => {
    if (!isKey(event)) return;
    event.preventDefault();
    end(event);
  };
  const click = (event) => {
    if (event.detail !== 0 || disabled) return;
    if (performance.now() - armed.current < CONFIRM) {
      armed.current = -Infinity;
      latest.current();
    } else {
      armed.current = performance.now();
      tell(`Press ${short} again within five seconds to confirm.`);
    }
  };
  const point = (event) => {
    if (event.button !== 0) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    begin(event);
  };
  const leave = (event) => {
    const box = event.currentTarget.getBoundingClientRect();
    const inside = event.clientX >= box.left && event.clientX <= box.right && event.clientY >= box.top && event.clientY <= box.bottom;
    if (!inside && timer.current !== null) cancel();
  };
  return html`<button type="button" class=${`held ${kind} ${pressed ? "pressed" : ""}`} disabled=${disabled} aria-label=${`${label} (hold for one second)`}
    onPointerDown=${point} onPointerUp=${end} onPointerMove=${leave} onPointerCancel=${cancel} onBlur=${cancel}
    onKeyDown=${down} onKeyUp=${up} onClick=${click} onContextMenu=${(event) => event.preventDefault()} ...${attributes}>
    <svg class="ring" viewBox="0 0 20 20" aria-hidden="true"><circle class="track" cx="10" cy="10" r="7.5" /><circle class="fill" cx="10" cy="10" r="7.5" /></svg>
    <span>${children}</span>
  </button>`;
}
