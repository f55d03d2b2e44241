/** The elements around the chart: the scale, north, the pointer's position, the sources, and the tip at the pointer. */
import { MILE } from "../units.js";

const ROUND = [1, 2, 5];

/** An element with a class and a text; a name never becomes markup. */
export function element(tag, className, text = "") {
  const made = document.createElement(tag);
  made.className = className;
  made.textContent = text;
  return made;
}

export function say(target, text) {
  if (target.textContent !== text) target.textContent = text;
  target.hidden = text === "";
}

/** The largest round number up to a limit. */
export function roundBelow(limit) {
  const power = 10 ** Math.floor(Math.log10(limit));
  return power * ROUND.findLast((digit) => digit * power <= limit * (1 + 1e-9));
}

/** Two bars, in nautical miles (metres below a tenth) and in kilometres. */
export class Scale {
  element = element("div", "map-scale");
  #bars = ["nm", "km"].map((unit) => element("div", `scale-bar ${unit}`));

  constructor() {
    this.element.append(...this.#bars);
    this.element.setAttribute("role", "img");
  }

  /** Show the scale for a number of metres in a pixel. */
  show(metres) {
    const longest = 130 * metres;
    const texts = [this.#bar(0, longest, MILE, "nm"), this.#bar(1, longest, 1000, "km")];
    this.element.setAttribute("aria-label", `Scale: a bar is ${texts[0]}`);
  }

  #bar(rank, longest, unit, name) {
    const isSmall = name === "km" && longest < 1000;
    const value = roundBelow(longest / (isSmall ? 1 : unit));
    const text = `${Number(value.toPrecision(3))} ${isSmall ? "m" : name}`;
    const pixels = (value * (isSmall ? 1 : unit) * 130) / longest;
    this.#bars[rank].style.width = `${pixels.toFixed(1)}px`;
    say(this.#bars[rank], text);
    return text;
  }
}

const NORTH = "M12 1 L18 21 L12 17 L6 21 Z";

/** The arrow of north, which is always up. */
export function northArrow() {
  const made = element("div", "map-north");
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  svg.setAttribute("viewBox", "0 0 24 24");
  path.setAttribute("d", NORTH);
  svg.append(path);
  svg.setAttribute("aria-hidden", "true");
  made.append(svg, element("b", "", "N"));
  made.title = "True north is up";
  return made;
}
