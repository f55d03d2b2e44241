/** The legend: the meanings of the chart's signs, folded until the operator opens it. */
import { element } from "./instruments.js";

const SVG = "http://www.w3.org/2000/svg";

/** Each sign as paths in a box of 36 by 20, `[d, stroke, fill, dashes]` by the names of the palette, and its meaning. */
const SIGNS = [
  [[["M18 2 L23 18 L18 14 L13 18 Z", "vehicleInk", "vehicle"]], "a vehicle, its nose where it heads"],
  [[["M18 2 L23 18 L18 14 L13 18 Z", "vehicleInk", "halo", "3 2"]], "hollow, dashed: its position is old"],
  [[["M18 2 L23 18 L18 14 L13 18 Z", "vehicleInk", "halo", "3 2"], ["M4 14 L32 6", "lost"]], "crossed out: lost"],
  [[["M10 17 L15 17 L12.5 5 Z", "ais", "aisFill"], ["M12.5 11 L32 3", "ais"]], "another ship; the line is its way of six minutes"],
  [[["M18 3 L25 10 L18 17 L11 10 Z", "seen", "seenFill"]], "seen, and not on its way"],
  [[["M18 4 L25 16 L11 16 Z", "watch", "watch"]], "to be watched"],
  [[["M12 4 H24 V16 H12 Z", "wrong", "wrong"]], "something is wrong with it"],
  [[["M12 4 L24 16 M24 4 L12 16", "lost"]], "lost, or taken over"],
  [[["M18 10 m-7 0 a7 7 0 1 0 14 0 a7 7 0 1 0 -14 0", "differs", null, "3 3"], ["M2 10 L10 10", "differs", null, "3 3"]], "believed elsewhere: the line comes from there"],
  [[["M18 10 m-7 0 a7 7 0 1 0 14 0 a7 7 0 1 0 -14 0", "way", null, "3 3"], ["M2 10 L10 10", "way", null, "3 3"]], "under way: believed where it was until it is there"],
  [[["M4 4 H32 V16 H4 Z", "place", "placeFill"]], "a place; dashed where it is believed to be within another one"],
  [[["M18 10 m-4.5 0 a4.5 4.5 0 1 0 9 0 a4.5 4.5 0 1 0 -9 0", "place", "halo"], ["M17 10 h2", "place"]], "a place that is a point"],
  [[["M2 6 H34 M6 6 v6 M14 6 v6 M22 6 v6 M30 6 v6", "fence"]], "a fence; its teeth are inside"],
  [[["M2 10 H34", "way", null, "10 5"]], "the way it flies; numbers are VIA points"],
  [[["M2 10 H34", "way", null, "2 5"]], "the commanded way, not accepted yet"],
  [[["M2 4 H34 V16 H2 Z", "wayFill", "wayFill"], ["M2 10 H34", "way", null, "10 5"]], "as far as it may stray from its way"],
  [[["M5 10 H31 M5 10 m-3 0 a3 3 0 1 0 6 0 a3 3 0 1 0 -6 0 M31 10 m-3 0 a3 3 0 1 0 6 0 a3 3 0 1 0 -6 0", "lost"]], "here an invariant about ways is broken"],
  [[["M18 10 m-6 0 a6 6 0 1 0 12 0 a6 6 0 1 0 -12 0 M9 10 h7 M20 10 h7 M18 1 v7 M18 12 v7", "way", "halo"]], "where it goes"],
  [[["M2 10 H34", "track"]], "where it was; older is fainter"],
  [[["M10 8 V3 H15 M21 3 H26 V8 M26 12 V17 H21 M15 17 H10 V12", "chosen"]], "chosen"],
];

const LEVELS = { watch: 1, wrong: 2, lost: 3 };
const inkOf = (palette, name) => (LEVELS[name] ? palette.levels[LEVELS[name]] : palette[name]);

export class Legend {
  element = document.createElement("details");
  #paths = [];

  constructor() {
    this.element.className = "map-legend";
    const summary = document.createElement("summary");
    summary.textContent = "Signs";
    summary.title = "the legend  I";
    const list = element("ul", "");
    list.append(...SIGNS.map(([paths, meaning]) => this.#line(paths, meaning)));
    this.element.append(summary, list);
  }

  toggle() {
    this.element.open = !this.element.open;
  }

  /** Take the chart's colours. */
  dress(palette) {
    for (const [path, stroke, fill] of this.#paths) {
      path.setAttribute("stroke", inkOf(palette, stroke));
      path.setAttribute("fill", fill ? inkOf(palette, fill) : "none");
    }
  }

  #line(paths, meaning) {
    const line = element("li", "");
    const svg = document.createElementNS(SVG, "svg");
    svg.setAttribute("viewBox", "0 0 36 20");
    svg.setAttribute("aria-hidden", "true");
    for (const [d, stroke, fill = null, dashes = ""] of paths) {
      const path = document.createElementNS(SVG, "path");
      path.setAttribute("d", d);
      path.setAttribute("stroke-dasharray", dashes);
      this.#paths.push([path, stroke, fill]);
      svg.append(path);
    }
    line.append(svg, element("span", "", meaning));
    return line;
  }
}
