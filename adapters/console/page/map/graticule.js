/** Parallels and meridians at round minutes, with their figures at the chart's edges. */
import { overlap } from "./labels.js";
import { mercatorX, mercatorY } from "./projection.js";
import { latitude, longitude } from "../units.js";

/** The possible steps between two lines, in minutes. */
const STEPS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800];
const APART = 110;

/** The smallest step whose lines are far enough apart if 360 degrees are `side` pixels. */
export const stepFor = (side) => STEPS.find((step) => (step / 21600) * side >= APART) ?? STEPS.at(-1);

const digitsOf = (step) => (step >= 1 ? 0 : step >= 0.1 ? 1 : 2);

/** Draw the lines, with their figures at uncovered parts of the chart's edges. */
export function drawGraticule({ ctx, view, palette, lettering }, covered) {
  const step = stepFor(view.side);
  const digits = digitsOf(step);
  const path = new Path2D();
  const figures = [];
  for (const east of meridians(view, step)) {
    const x = Math.round(view.x(mercatorX(east))) + 0.5;
    path.moveTo(x, 0);
    path.lineTo(x, view.height);
    figures.push([longitude(east, digits), (width) => [x - width / 2, 3]]);
  }
  for (const north of parallels(view, step)) {
    const y = Math.round(view.y(mercatorY(north))) + 0.5;
    path.moveTo(0, y);
    path.lineTo(view.width, y);
    figures.push([latitude(north, digits), (width) => [view.width - width - 4, y - 8]]);
  }
  Object.assign(ctx, { strokeStyle: palette.grid, lineWidth: 1 });
  ctx.stroke(path);
  for (const [text, corner] of figures) writeFigure({ ctx, view, palette, lettering }, text, corner, covered);
}

function writeFigure({ ctx, view, palette, lettering }, text, corner, covered) {
  const [width, height] = lettering.size(text, "grid");
  const [x, y] = corner(width);
  const isOfMeridian = y < 4;
  if (isOfMeridian ? x < 60 || x + width > view.width - 70 : y < 24 || y + height > view.height - 50) return;
  if (covered.some((box) => overlap(box, [x, y, x + width, y + height]))) return;
  lettering.draw(ctx, text, [x, y], "grid", palette.quiet);
}

function meridians(view, step) {
  const [first, last] = [view.left, view.left + view.width].map((x) => (x / view.side - 0.5) * 21600);
  return multiples(first, last, step);
}

function parallels(view, step) {
  const degrees = (y) => (Math.atan(Math.sinh(Math.PI * (1 - (2 * y) / view.side))) * 180) / Math.PI;
  const south = Math.max(-85, degrees(view.top + view.height));
  return multiples(south * 60, Math.min(85, degrees(view.top)) * 60, step);
}

/** The multiples of a step (in minutes) between two values, in degrees. */
function multiples(first, last, step) {
  const start = Math.ceil(first / step);
  const count = Math.max(0, Math.floor(last / step) - start + 1);
  return Array.from({ length: count }, (_, n) => ((start + n) * step) / 60);
}
