/** Web Mercator: the earth is a square from 0 to 1, seen through a window of pixels. */

const HIGHEST = 85.0511287798;

export const mercatorX = (longitude) => longitude / 360 + 0.5;

export function mercatorY(latitude) {
  const sine = Math.sin((Math.max(-HIGHEST, Math.min(HIGHEST, latitude)) * Math.PI) / 180);
  return 0.5 - Math.log((1 + sine) / (1 - sine)) / (4 * Math.PI);
}

/**
 * A line of positions on the square. Each point follows the one before on the shorter way round the earth, so a line
 * across the antimeridian stays whole.
 */
export class Line {
  constructor(points) {
    this.xs = new Float64Array(points.length);
    this.ys = new Float64Array(points.length);
    points.forEach(([latitude, longitude], n) => {
      const x = mercatorX(longitude);
      this.xs[n] = n === 0 ? x : x - Math.round(x - this.xs[n - 1]);
      this.ys[n] = mercatorY(latitude);
    });
    const least = (values, pick, none) => values.reduce((found, each) => pick(found, each), none);
    this.west = least(this.xs, Math.min, Infinity);
    this.east = least(this.xs, Math.max, -Infinity);
    this.top = least(this.ys, Math.min, Infinity);
    this.bottom = least(this.ys, Math.max, -Infinity);
  }
}

const LINES = new WeakMap();

/** The line of a list of positions that is never changed in place. */
export function lineOf(points) {
  let line = LINES.get(points);
  if (!line) LINES.set(points, (line = new Line(points)));
  return line;
}

/** The visible part of the square: `left` and `top` in pixels of the square, which is `side` pixels long. */
export class View {
  constructor({ left, top, side, width, height }) {
    Object.assign(this, { left, top, side, width, height });
    this.middle = (left + width / 2) / side;
  }

  /** The number of turns around the earth that brings a thing at `x` nearest to the middle. */
  turns(x) {
    return Math.round(this.middle - x);
  }

  x(x) {
    return x * this.side - this.left;
  }

  y(y) {
    return y * this.side - this.top;
  }

  /** The pixel of a position. */
  point([latitude, longitude]) {
    const x = mercatorX(longitude);
    return [this.x(x + this.turns(x)), this.y(mercatorY(latitude))];
  }

  sees([x, y], margin = 0) {
    return x >= -margin && y >= -margin && x <= this.width + margin && y <= this.height + margin;
  }

  /** The width and height of a line, in pixels. */
  box(line) {
    const turns = this.turns((line.west + line.east) / 2);
    return [this.x(line.west + turns), this.y(line.top), this.x(line.east + turns), this.y(line.bottom)];
  }

  seesLine(line, margin = 20) {
    const [left, top, right, bottom] = this.box(line);
    return right >= -margin && bottom >= -margin && left <= this.width + margin && top <= this.height + margin;
  }

  /** Add a line to a path; a point closer than `apart` pixels to the one before is left out. */
  trace(path, line, apart = 0) {
    const turns = this.turns((line.west + line.east) / 2);
    const last = line.xs.length - 1;
    let [beforeX, beforeY] = [NaN, NaN];
    for (let n = 0; n <= last; n++) {
      const [x, y] = [this.x(line.xs[n] + turns), this.y(line.ys[n])];
      if (n === 0) path.moveTo(x, y);
      else if (n < last && Math.abs(x - beforeX) < apart && Math.abs(y - beforeY) < apart) continue;
      else path.lineTo(x, y);
      [beforeX, beforeY] = [x, y];
    }
  }

  pixels(line) {
    const turns = this.turns((line.west + line.east) / 2);
    return Array.from(line.xs, (x, n) => [this.x(x + turns), this.y(line.ys[n])]);
  }
}

/** Whether a point of pixels is in a ring of pixels. */
export function isInside([x, y], ring) {
  let inside = false;
  for (let n = 0, before = ring.length - 1; n < ring.length; before = n++) {
    const [[x1, y1], [x2, y2]] = [ring[n], ring[before]];
    if (y1 > y !== y2 > y && x < ((x2 - x1) * (y - y1)) / (y2 - y1) + x1) inside = !inside;
  }
  return inside;
}

export function areaOf(ring) {
  return Math.abs(ring.reduce((sum, [x, y], n) => {
    const [x2, y2] = ring[(n + 1) % ring.length];
    return sum + x * y2 - x2 * y;
  }, 0)) / 2;
}
