/** The operator's words for requests, orders and their states; other panels show the terms of the calculus. */
import { shapeOfKind } from "./map/symbols.js";
import { byName } from "./natural.js";

const MOVES = { vessel: "sails", submarine: "sails", rover: "drives" };

/** How a kind of vehicles moves: boats sail. */
export const moves = (kind) => MOVES[shapeOfKind(kind)] ?? "flies";

const placed = { region: "outside all named places" };

/** A place's name; `region` is the area outside all places of the mission. */
export const placeName = (name) => placed[name] ?? name ?? "nowhere";

const within = (name) => (name === null || name === undefined ? "nowhere" : name === "region" ? placeName(name) : `in ${name}`);

/** The believed and the actual place of a vehicle or an entity; a vehicle under way is in no place until it arrives. */
export function whereabouts(card) {
  const { believed, actual, differs, going, order, request, returning, taken, kind, armed } = card;
  if (returning) return `${placeName(believed)} → ${moves(kind)} home`;
  if (!differs) return placeName(believed);
  const to = isUnderWay(order) ? order.to : going && !request && !taken ? going : null; // this station does not see another's order
  if (to && armed === false && order?.state !== "accepted") return `${placeName(believed)} → has not set out to ${to}`;
  if (to) return `${placeName(believed)} → under way to ${to}`;
  return going ? `left ${placeName(believed)}, has not arrived anywhere yet` : `believed ${within(believed)}, really ${within(actual)}`;
}

/** Whether the believed and the actual place differ without a flight that explains it. */
export const isAstray = ({ differs, going, returning }) => differs && !going && !returning;

/** The waypoints of a vehicle's way: home if it returns, whoever ordered it; else those of its order. */
export function wayOf({ order, returning, home }) {
  if (returning) return home ? [home] : [];
  return order?.way?.length && !OVER.includes(order.state) ? order.way : [];
}

/** For each command of missions: its form, the words for a waiting agent, and the words for the flight. */
const ASKED = [
  [/^MOVE_HOST_TO (\S+)/, "to be sent to $1", "$moves to $1"],
  [/^MOVE (\S+) TO (\S+)/, "$1 to be sent to $2", "$1 goes to $2"],
  [/^PUT (\S+) IN (\S+)/, "$1 to be put in $2", "$1 goes to $2"],
  [/^HAND (\S+) TO (\S+)/, "$1 to be handed to $2", "$1 is handed to $2"],
  [/^CONNECT_HOST_TO (\S+)/, "to be connected to $1", "is being connected to $1"],
  [/^DISCONNECT_HOST_FROM (\S+)/, "to be disconnected from $1", "is being disconnected from $1"],
];
const REQUEST = /^([A-Z]+)\(([^,]+), (.*)\)$/s;

/** The words for a pending request. */
export function requestWords({ text, agent }, kind) {
  const [, sort, by = agent, what = text] = REQUEST.exec(text) ?? [];
  if (sort === "OBS" || sort === "READY") return `${by} looks around`;
  if (sort === "MGR") return `${by} moves to ${what}`;
  if (sort !== "CTR" && sort !== "FLY") return text;
  const [pattern, asked, going] = ASKED.find(([each]) => each.test(what)) ?? [];
  if (!pattern) return sort === "FLY" ? `${by}'s order is carried out` : `${by} waits for its order to be sent`;
  const parts = pattern.exec(what);
  return (sort === "FLY" ? going : `waits ${asked}`).replace("$moves", moves(kind)).replace(/\$(\d)/g, (_, rank) => parts[rank]);
}

const DEEDS = {
  GoTo: (to, kind) => `${moves(kind)} to ${to}`,
  Follow: (to) => `follows ${to}`,
  Hold: () => "holds",
  Return: () => "returns home",
  HandOver: (to) => `handed to ${to}`,
};
const STATES = { asked: "asked, not sent yet", sent: "sent, not confirmed yet", accepted: "accepted", arrived: "arrived", refused: "refused" };
const ENDS = { Hold: "in effect", Return: "is home", HandOver: "done" };

const OVER = ["arrived", "refused"];

/** The name of a station or a place, without the prefix of a station's channel. */
const bare = (name) => (name ?? "").split(":").at(-1);

/** A vehicle's last order and its state; while the vehicle flies home, it carries out no other order. */
export function orderWords({ command, to, state, why }, returning = false, kind = "") {
  const deed = DEEDS[command]?.(bare(to), kind) ?? [command, bare(to)].filter(Boolean).join(" to ");
  if (returning && isUnderWay({ command, to, state })) return `${deed}: not now, it ${moves(kind)} home`;
  return `${deed}, ${(state === "arrived" && ENDS[command]) || (STATES[state] ?? state)}${why ? `: ${why}` : ""}`;
}

/** Whether a vehicle still carries out an order of movement. */
export const isUnderWay = (order) => Boolean(order?.to) && ["sent", "accepted"].includes(order.state) && order.command !== "HandOver";

const FALLBACKS = { hold: "then it holds", return: "then it returns home", continue: "then it goes on waiting" };

/** The words for the fallback after a request's time limit. */
export const fallbackWords = (fallback) => FALLBACKS[fallback] ?? "";

const FALLEN_BACK = { hold: "vehicles were commanded to hold", return: "vehicles were commanded to return home", continue: "the mission goes on" };

/** A finding, and the run's fallback after it. */
export const findingWords = ({ message, fallback }) => [message, FALLEN_BACK[fallback]].filter(Boolean).join(" · ");

const FATES = { asked: "asked, not sent yet", sent: "sent, not confirmed yet", confirmed: "confirmed by the vehicle", refused: "refused" };
const OURS = /^(say|give back|acknowledge|start|note)/;

/**
 * The words for an action's state. An accepted action that no vehicle confirms is done, unless it has no effect. The run
 * repeats a refused order. An order that ended unconfirmed is never confirmed.
 */
export function fateOf({ what, state, vain, fates, answered }) {
  if (state === "confirmed" && OURS.test(what)) return vain ? `heard, but ${vain}` : "done";
  if (state === "refused" && isOwed({ fates, answered })) return "refused, and repeated";
  if (["asked", "sent"].includes(state) && answered) return `${state}, never confirmed`;
  return FATES[state] ?? state;
}

/** Whether vehicles still have to confirm an order. */
const isOwed = ({ fates, answered }) => !answered && Object.keys(fates ?? {}).length > 0;

/** The state of an order to several vehicles, for each vehicle. */
export const eachFate = ({ fates }) => (Object.keys(fates ?? {}).length > 1 ? Object.entries(fates).sort(([a], [b]) => byName(a, b)).map(([name, { state, why }]) => `${name}: ${FATES[state]}${why ? `: ${why}` : ""}`) : []);

/** An operator's order to a vehicle, and its state. */
export const orderedWords = ({ order, by, state, why }) => `to ${order}, by ${by || "someone"}: ${state === "refused" ? `refused, and repeated: ${why}` : FATES[state]}`;
