/** The measuring tool: a way of points, with the distance and bearing of each leg. */
import { arc, bearing, distance } from "./geodesy.js";
import { Line } from "./projection.js";
import { angle, range } from "../units.js";

export class Measure {
  on = false;
  #points = [];
  #pointer = null;

  set(on) {
    Object.assign(this, { on });
    this.#points = [];
    this.#pointer = null;
  }

  /** Add a point to the way, from which the pointer's leg starts; a second click on the same point does nothing. */
  add(position) {
    if (this.#points.at(-1)?.join() !== position.join()) this.#points.push(position);
    this.#pointer = position;
  }

  /** Take back the last point. */
  undo() {
    this.#points.pop();
  }

  point(position) {
    this.#pointer = position;
  }

  /** The legs, including the one to the pointer: {from, to, metres, degrees}. */
  legs() {
    const isAway = this.#pointer && this.#points.length && this.#pointer.join() !== this.#points.at(-1).join();
    const points = isAway ? [...this.#points, this.#pointer] : this.#points;
    return points.slice(1).map((to, n) => ({ from: points[n], to, metres: distance(points[n], to), degrees: bearing(points[n], to) }));
  }

  /** The measurement in words. */
  words() {
    const legs = this.legs();
    if (!legs.length) return this.#points.length ? "Click the next point." : "Click the first point to measure from.";
    const total = legs.reduce((sum, { metres }) => sum + metres, 0);
    const last = `${range(legs.at(-1).metres)} ${angle(legs.at(-1).degrees)}`;
    return legs.length === 1 ? last : `${last}, in all ${range(total)}`;
  }

  draw({ ctx, view, palette, lettering }) {
    if (!this.on) return;
    Object.assign(ctx, { strokeStyle: palette.measure, fillStyle: palette.measure, lineWidth: 2 });
    const path = new Path2D();
    const legs = this.legs();
    for (const { from, to } of legs) view.trace(path, new Line(arc(from, to)));
    ctx.setLineDash([6, 4]);
    ctx.stroke(path);
    ctx.setLineDash([]);
    for (const position of this.#points) {
      const [x, y] = view.point(position);
      ctx.fillRect(x - 3, y - 3, 6, 6);
    }
    let total = 0;
    for (const { to, metres, degrees } of legs) {
      total += metres;
      const [x, y] = view.point(to);
      lettering.draw(ctx, `${range(metres)}  ${angle(degrees)}`, [x + 12, y - 18], "vehicle", palette.measure);
      if (total > metres) lettering.draw(ctx, `Σ ${range(total)}`, [x + 12, y - 2], "named", palette.measure);
    }
  }
}
