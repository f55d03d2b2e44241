/** The shapes of moving things, pointing up around the origin, and the choice of a thing's shape. */

const polygon = (points) => (path) => {
  points.forEach(([x, y], n) => (n === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  path.closePath();
};

const circle = (path, x, y, radius) => {
  path.moveTo(x + radius, y);
  path.arc(x, y, radius, 0, 2 * Math.PI);
};

const mirrored = (half) => [...half, ...half.toReversed().map(([x, y]) => [-x, y])];

/** The shapes of vehicles by the words of their kinds; the first match counts. */
const BY_KIND = [
  [/copter|rotor|quad|hexa|heli|multirotor|vtol/i, "rotorcraft"],
  [/uuv|auv|submarine|glider|rov/i, "submarine"],
  [/usv|asv|ship|boat|vessel|cutter/i, "vessel"],
  [/ugv|rover|car|truck|robot/i, "rover"],
  [/uav|uas|plane|aircraft|drone|wing/i, "aeroplane"],
];

const SHAPES = {
  aeroplane: polygon(mirrored([[0, -12], [1.8, -7], [1.8, -3], [12, 2.5], [12, 5], [1.8, 2.5], [1.3, 7.5], [4.5, 10], [4.5, 11.5], [0, 10.5]])),
  rotorcraft: (path) => {
    for (const [x, y] of [[-6.5, -6.5], [6.5, -6.5], [6.5, 6.5], [-6.5, 6.5]]) circle(path, x, y, 4);
    polygon([[0, -9], [4, 3], [0, 1], [-4, 3]])(path);
  },
  vessel: polygon(mirrored([[0, -12], [4, -5.5], [4.6, 0], [4.6, 9], [0, 10]])),
  submarine: (path) => {
    path.ellipse(0, 0, 4, 11.5, 0, 0, 2 * Math.PI);
    polygon([[-6, 6], [6, 6], [4, 11], [-4, 11]])(path);
  },
  rover: (path) => {
    polygon([[-6, -5], [0, -11], [6, -5], [6, 9], [-6, 9]])(path);
    for (const y of [-3, 4]) for (const x of [-8, 6]) path.rect(x, y, 2, 5);
  },
  arrow: polygon([[0, -11], [7.5, 9], [0, 4.5], [-7.5, 9]]),
  diamond: polygon([[0, -6.5], [6.5, 0], [0, 6.5], [-6.5, 0]]),
};

export const TRIANGLE = [[0, -10], [5, 6], [-5, 6]];

/** The shape of a kind of vehicles. */
export const shapeOfKind = (kind) => BY_KIND.find(([pattern]) => pattern.test(kind ?? ""))?.[1] ?? "arrow";

export function shapeOf({ kind, vehicle, course, source }) {
  if (vehicle) return shapeOfKind(kind);
  return /^ais/i.test(source ?? "") || (course ?? null) !== null ? "target" : "diamond";
}

const PATHS = new Map();

/** The path of a shape, `target` excepted, which is many triangles in one path. */
export function pathOf(shape) {
  if (!PATHS.has(shape)) {
    const path = new Path2D();
    SHAPES[shape](path);
    PATHS.set(shape, path);
  }
  return PATHS.get(shape);
}

/** Add polygon points to a path, turned by degrees from north and scaled. */
export function addTurned(path, points, [x, y], degrees, scale) {
  const turn = (degrees * Math.PI) / 180;
  const [sine, cosine] = [Math.sin(turn) * scale, Math.cos(turn) * scale];
  points.forEach(([east, south], n) => {
    const corner = [x + east * cosine - south * sine, y + east * sine + south * cosine];
    if (n === 0) path.moveTo(...corner);
    else path.lineTo(...corner);
  });
  path.closePath();
}
