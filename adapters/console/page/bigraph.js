/** The picture of L, which can be moved and enlarged, and its text form. */
import { html, useEffect, useLayoutEffect, useRef, useSections, useState, useWatched } from "./ui.js";

const SVG = "http://www.w3.org/2000/svg";
const ELEMENTS = new Set(["svg", "g", "path", "text", "tspan", "use", "defs", "clipPath", "rect", "circle", "ellipse", "line", "polygon", "polyline", "title"]);
const ATTRIBUTES = new Set(["d", "x", "y", "x1", "x2", "y1", "y2", "dx", "dy", "width", "height", "transform", "clip-path", "id", "r", "cx", "cy", "rx", "ry", "points",
  "viewBox", "fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linecap", "stroke-linejoin", "opacity", "fill-opacity", "stroke-opacity", "fill-rule", "paint-order",
  "font-family", "font-size", "font-weight", "font-style", "text-anchor", "textLength", "lengthAdjust", "class", "xml:space"]);
/** A reference to something outside the picture. */
const ELSEWHERE = /url\s*\((?!\s*['"]?#)/i;
const LARGEST = 12;
/** The least height in pixels of the lettering of a whole picture, and the height if only a part would be readable. */
const [LEAST, READABLE] = [8, 11];

/**
 * Convert a picture to elements of this page: shapes and text only. Script sets its styles, since the page's policy refuses
 * `style` attributes. References to anything outside the picture are removed.
 */
export function picture(text) {
  // Without this the browser reports each style attribute as refused when it parses the picture.
  const renamed = text.replaceAll(' style="', ' data-style="').replace(/<style[\s\S]*?<\/style>/g, "");
  const root = new DOMParser().parseFromString(renamed, "image/svg+xml").documentElement;
  if (root.localName !== "svg" || root.namespaceURI !== SVG) return null;
  const styles = [];
  for (const element of [root, ...root.querySelectorAll("*")]) {
    if (element.namespaceURI !== SVG || !ELEMENTS.has(element.localName)) {
      element.remove();
      continue;
    }
    const style = element.getAttribute("data-style");
    if (style && !ELSEWHERE.test(style)) styles.push([element, style]);
    for (const { name, value } of [...element.attributes]) if (!kept(name, value)) element.removeAttribute(name);
  }
  const size = sizeOf(root);
  document.adoptNode(root);
  for (const [element, style] of styles) element.style.cssText = style;
  root.removeAttribute("width");
  root.removeAttribute("height");
  return { root, size };
}

function kept(name, value) {
  if (name === "href" || name === "xlink:href") return value.startsWith("#");
  return ATTRIBUTES.has(name) && !ELSEWHERE.test(value);
}

function sizeOf(root) {
  const box = (root.getAttribute("viewBox") ?? "").trim().split(/[\s,]+/).map(Number);
  if (box.length === 4 && box.every(Number.isFinite) && box[2] > 0 && box[3] > 0) return box;
  const [width, height] = ["width", "height"].map((name) => Number.parseFloat(root.getAttribute(name)) || 100);
  return [0, 0, width, height];
}

/** The boxes of a picture's nodes by their names: the first text in a box, and in none within it. */
function nodesOf(root) {
  const boxes = [...root.querySelectorAll("rect")].map((rect) => ({ rect, at: rect.getBoundingClientRect() })).sort((a, b) => sizeOfBox(a) - sizeOfBox(b));
  const found = new Map();
  const taken = new Set();
  for (const text of root.querySelectorAll("text")) {
    const { left, right, top, bottom } = text.getBoundingClientRect();
    const box = boxes.find(({ at }) => covers(at, (left + right) / 2, (top + bottom) / 2));
    if (!box || taken.has(box)) continue;
    taken.add(box);
    found.set(text.textContent, box);
  }
  return found;
}

const sizeOfBox = ({ at }) => at.width * at.height;
const covers = ({ left, right, top, bottom }, x, y) => left <= x && x <= right && top <= y && y <= bottom;

/** The names of the nodes at a point of the window, the smallest first. */
function nodesAt(root, x, y) {
  const there = [...nodesOf(root)].filter(([, { at }]) => covers(at, x, y));
  return there.sort(([, a], [, b]) => sizeOfBox(a) - sizeOfBox(b)).map(([name]) => name);
}

/** The caption with the picture's step, which may be earlier than the moment's: L is drawn at most once a second. */
function captionOf(pictured, step) {
  if (pictured === null) return "the logical model";
  const later = step !== null && step !== pictured ? `; the moment shown is after step ${step}, which is not drawn yet` : "";
  return `the logical model, after step ${pictured}${later}`;
}

export function Bigraph({ app }) {
  const [bigraph] = useSections(app.store, ["bigraph"], 200);
  const [svg, text, step, drawn] = ["svg", "text", "step", "drawn"].map((key) => bigraph.get(key) ?? null);
  const chosen = useWatched(app.chosen);
  const known = (name) => ["entities", "places"].some((section) => app.store.section(section).has(name));
  return html`<${Drawing} svg=${svg} text=${text} called="The bigraph" chosen=${chosen} choose=${(names) => app.chosen.set(names.find(known) ?? null)} caption=${(words) => captionOf(words || !svg ? step : drawn, step)} />`;
}

/**
 * A picture that can be moved and enlarged, and its text form. At first it is whole, unless its lettering (`lettering` high
 * in its own units) would then be too small to read. The node named `chosen` is marked; `choose(names)` is called with the
 * nodes at a point that is pressed, the smallest first.
 */
export function Drawing({ svg, text, called, caption, lettering = 0, chosen = null, choose = () => {} }) {
  const frame = useRef(null);
  const view = useRef({ box: null, whole: null });
  const [words, setWords] = useState(false);
  const [isPart, setIsPart] = useState(false);
  const pressed = useRef(null);

  const show = () => {
    const { box, whole } = view.current;
    frame.current?.firstElementChild?.setAttribute("viewBox", box.join(" "));
    setIsPart([0, 1].some((side) => box[side] > whole[side] + 1 || box[side] + box[side + 2] < whole[side] + whole[side + 2] - 1));
  };
  /** Show the whole picture, or its middle part if the lettering of the whole would be too small to read. */
  const fit = () => {
    if (!view.current.whole) return;
    const [x, y, width, height] = view.current.whole;
    const { clientWidth, clientHeight } = frame.current;
    const scale = Math.min(clientWidth / width, clientHeight / height) || 1;
    const part = scale * lettering < LEAST ? Math.min(1, (scale * lettering) / READABLE || 1) : 1;
    view.current.box = [x + (width * (1 - part)) / 2, y + (height * (1 - part)) / 2, width * part, height * part];
    show();
  };
  /** Enlarge around a point, given in fractions of the frame. */
  const zoom = (factor, across = 0.5, down = 0.5) => {
    const { box, whole } = view.current;
    if (!whole) return;
    const width = Math.min(whole[2] * 2, Math.max(whole[2] / LARGEST, box[2] / factor));
    const height = (width * box[3]) / box[2];
    view.current.box = [box[0] + (box[2] - width) * across, box[1] + (box[3] - height) * down, width, height];
    show();
  };
  const move = (across, down) => {
    const { box } = view.current;
    if (!box) return;
    view.current.box = [box[0] + across * box[2], box[1] + down * box[3], box[2], box[3]];
    show();
  };

  useLayoutEffect(() => {
    if (words || !svg || !frame.current) return;
    const drawn = picture(svg);
    frame.current.replaceChildren(...(drawn ? [drawn.root] : []));
    if (!drawn) return;
    drawn.root.setAttribute("aria-hidden", "true"); // readers of the screen get the text
    const same = view.current.whole?.join() === drawn.size.join();
    view.current = { whole: drawn.size, box: view.current.box };
    if (same) show();
    else fit();
  }, [svg, words]);

  useLayoutEffect(() => {
    const root = frame.current?.firstElementChild;
    if (!root) return;
    const mark = chosen === null ? null : nodesOf(root).get(chosen)?.rect;
    for (const rect of root.querySelectorAll("rect")) rect.classList.toggle("chosen", rect === mark);
  }, [svg, words, chosen]);

  /** Choose the node that is pressed, unless the picture was moved. */
  const press = ({ clientX, clientY }) => (pressed.current = [clientX, clientY]);
  const click = ({ clientX, clientY }) => {
    const [x, y] = pressed.current ?? [NaN, NaN];
    if (Math.hypot(clientX - x, clientY - y) <= 4) choose(nodesAt(frame.current.firstElementChild, x, y));
  };

  useEffect(() => {
    const element = frame.current;
    if (!element) return;
    const wheel = (event) => {
      event.preventDefault();
      const box = element.getBoundingClientRect();
      zoom(Math.exp(-event.deltaY / 400), (event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    };
    element.addEventListener("wheel", wheel, { passive: false });
    return () => element.removeEventListener("wheel", wheel);
  }, [words, svg === null]);

  const drag = (event) => {
    if (!(event.buttons & 1)) return;
    const box = event.currentTarget.getBoundingClientRect();
    move(-event.movementX / box.width, -event.movementY / box.height);
  };
  const keys = (event) => {
    const does = { "+": () => zoom(1.25), "=": () => zoom(1.25), "-": () => zoom(0.8), 0: fit, ArrowLeft: () => move(-0.1, 0), ArrowRight: () => move(0.1, 0), ArrowUp: () => move(0, -0.1), ArrowDown: () => move(0, 0.1) }[event.key];
    if (!does || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    does();
  };

  if (!svg && !text) return html`<p class="none">No picture yet.</p>`;
  return html`<div class="bigraph">
    <p class="tools">
      <button type="button" onClick=${() => zoom(1.25)} disabled=${words} aria-label="enlarge">+</button>
      <button type="button" onClick=${() => zoom(0.8)} disabled=${words} aria-label="make smaller">−</button>
      <button type="button" onClick=${fit} disabled=${words}>Fit</button>
      <button type="button" aria-pressed=${String(words)} onClick=${() => setWords(!words)}>Text</button>
      <span class="quiet">${caption(words)}${isPart && !words && svg && html`<span class="part">, a part of it: drag it, or − for more</span>`}</span></p>
    ${words || !svg
      ? html`<pre tabindex="0" key="text">${text}</pre>`
      : html`<div key="picture" class="frame" ref=${frame} tabindex="0" role="img" aria-label=${`${called}: ${text ?? "see the picture"}`} onPointerMove=${drag} onKeyDown=${keys}
          onPointerDown=${(event) => (event.currentTarget.setPointerCapture(event.pointerId), press(event))} onClick=${click} onDblClick=${fit}></div>`}
  </div>`;
}
