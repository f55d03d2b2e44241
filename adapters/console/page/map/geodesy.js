/** Distances and bearings on the WGS84 ellipsoid, between points [latitude, longitude] in degrees. */

const EQUATOR = 6378137.0;
const FLATTENING = 1 / 298.257223563;
const RADIANS = Math.PI / 180;

const reduced = (latitude) => Math.atan((1 - FLATTENING) * Math.tan(latitude * RADIANS));

/** The angle between two points of a sphere, exact even for close points. */
function angleBetween([latitude, longitude], [latitude2, longitude2]) {
  const half = Math.sin((latitude2 - latitude) / 2) ** 2;
  const other = Math.cos(latitude) * Math.cos(latitude2) * Math.sin((longitude2 - longitude) / 2) ** 2;
  return 2 * Math.asin(Math.min(1, Math.sqrt(half + other)));
}

/**
 * Metres along the shortest way, by Lambert's formula for long lines; its error is some ten metres in thousands of
 * kilometres. Between antipodes the formula has no value, and the distance on the sphere is returned.
 */
export function distance(a, b) {
  const [p, q] = [[reduced(a[0]), a[1] * RADIANS], [reduced(b[0]), b[1] * RADIANS]];
  const angle = angleBetween(p, q);
  if (angle === 0) return 0;
  const [sum, half] = [(p[0] + q[0]) / 2, (q[0] - p[0]) / 2];
  const x = ((angle - Math.sin(angle)) * Math.sin(sum) ** 2 * Math.cos(half) ** 2) / Math.cos(angle / 2) ** 2;
  const y = ((angle + Math.sin(angle)) * Math.cos(sum) ** 2 * Math.sin(half) ** 2) / Math.sin(angle / 2) ** 2;
  const correction = (FLATTENING / 2) * (x + y);
  return EQUATOR * (Math.abs(correction) < 0.01 ? angle - correction : angle);
}

/**
 * Metres to the nearest point of an area's border, 0 within it; its edges are straight in latitude and longitude. The
 * nearest point is computed in the plane around `at`, which is accurate enough within some hundred kilometres.
 */
export function distanceToArea(at, ring) {
  const shrink = Math.cos(at[0] * RADIANS);
  const plane = ring.map(([north, east]) => [wrapped(east - at[1]) * shrink, north - at[0]]);
  let nearest = null;
  let inside = false;
  plane.forEach(([x, y], n) => {
    const [x2, y2] = plane[(n + 1) % plane.length];
    if (y > 0 !== y2 > 0 && (x2 - x) * (-y / (y2 - y)) + x > 0) inside = !inside;
    const length = (x2 - x) ** 2 + (y2 - y) ** 2;
    const part = length === 0 ? 0 : Math.max(0, Math.min(1, -(x * (x2 - x) + y * (y2 - y)) / length));
    const point = [x + part * (x2 - x), y + part * (y2 - y)];
    if (nearest === null || Math.hypot(...point) < Math.hypot(...nearest)) nearest = point;
  });
  return inside ? 0 : distance(at, [at[0] + nearest[1], at[1] + nearest[0] / shrink]);
}

/** The initial bearing of the shortest way, in degrees from true north, on the sphere of reduced latitudes. */
export function bearing(a, b) {
  const [north, north2, east] = [reduced(a[0]), reduced(b[0]), (b[1] - a[1]) * RADIANS];
  const x = Math.cos(north) * Math.sin(north2) - Math.sin(north) * Math.cos(north2) * Math.cos(east);
  return (Math.atan2(Math.sin(east) * Math.cos(north2), x) / RADIANS + 360) % 360;
}

/** Points of the great circle between two points, so that a long line is drawn along its real course. */
export function arc(a, b) {
  const vectors = [a, b].map(([latitude, longitude]) => {
    const [north, east] = [latitude * RADIANS, longitude * RADIANS];
    return [Math.cos(north) * Math.cos(east), Math.cos(north) * Math.sin(east), Math.sin(north)];
  });
  const angle = angleBetween([a[0] * RADIANS, a[1] * RADIANS], [b[0] * RADIANS, b[1] * RADIANS]);
  const parts = Math.min(64, Math.ceil(angle / RADIANS));
  if (parts < 2 || angle > Math.PI - 1e-6) return [a, b];
  return Array.from({ length: parts + 1 }, (_, n) => between(vectors, angle, n / parts));
}

function between([a, b], angle, part) {
  const [before, after] = [Math.sin((1 - part) * angle), Math.sin(part * angle)];
  const [x, y, z] = a.map((value, axis) => before * value + after * b[axis]);
  return [Math.atan2(z, Math.hypot(x, y)) / RADIANS, Math.atan2(y, x) / RADIANS];
}

/** A longitude between -180 and 180. */
export const wrapped = (longitude) => ((((longitude + 180) % 360) + 360) % 360) - 180;

/**
 * The smallest window [south, west, north, east] around all points, null without points. Its east is beyond 180 if the
 * points lie on both sides of the antimeridian.
 */
export function boundsOf(points) {
  if (points.length === 0) return null;
  const norths = points.map(([latitude]) => latitude);
  const easts = points.map(([, longitude]) => wrapped(longitude)).sort((a, b) => a - b);
  const gaps = easts.map((east, n) => (n + 1 < easts.length ? easts[n + 1] : easts[0] + 360) - east);
  const widest = gaps.reduce((best, gap, n) => (gap > gaps[best] ? n : best), gaps.length - 1);
  const west = easts[(widest + 1) % easts.length];
  const east = easts[widest];
  const least = (all, pick) => all.reduce((found, each) => pick(found, each));
  return [least(norths, Math.min), west, least(norths, Math.max), east < west ? east + 360 : east];
}
