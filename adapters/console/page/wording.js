/** What the mission asks and what vehicles are told, in an operator's words; the calculus has its own panels. */

const placed = { region: "outside all named places" };

/** A place's name; the region is what no place of the mission contains. */
export const placeName = (name) => placed[name] ?? name ?? "nowhere";

const within = (name) => (name === null || name === undefined ? "nowhere" : name === "region" ? placeName(name) : `in ${name}`);

/** Where something is believed to be and where it really is: one that was sent somewhere is in no place until it is there. */
export function whereabouts(card) {
  const { believed, actual, differs, going, order, request, returning, taken } = card;
  if (returning) return `${placeName(believed)} → flies home`;
  if (!differs) return placeName(believed);
  const to = isUnderWay(order) ? order.to : going && !request && !taken ? going : null; // another station's order is not told here
  if (to) return `${placeName(believed)} → under way to ${to}`;
  return going ? `left ${placeName(believed)}, has not arrived anywhere yet` : `believed ${within(believed)}, really ${within(actual)}`;
}

/** Whether something is not where it is believed to be, and no flight explains it. */
export const isAstray = ({ differs, going, returning }) => differs && !going && !returning;

/** The way on which a vehicle is: home where it flies there, whoever sent it; else where it was told to go. */
export function wayOf({ order, returning, home }) {
  if (returning) return home ? [home] : [];
  return order?.way?.length && !OVER.includes(order.state) ? order.way : [];
}

/** What a control asks, by the words with which missions write it: a command's words, and those for who waits and who goes. */
const ASKED = [
  [/^MOVE_HOST_TO (\S+)/, "to be sent to $1", "flies to $1"],
  [/^MOVE (\S+) TO (\S+)/, "$1 to be sent to $2", "$1 goes to $2"],
  [/^PUT (\S+) IN (\S+)/, "$1 to be put in $2", "$1 goes to $2"],
  [/^HAND (\S+) TO (\S+)/, "$1 to be handed to $2", "$1 is handed to $2"],
  [/^CONNECT_HOST_TO (\S+)/, "to be connected to $1", "is being connected to $1"],
  [/^DISCONNECT_HOST_FROM (\S+)/, "to be disconnected from $1", "is being disconnected from $1"],
];
const REQUEST = /^([A-Z]+)\(([^,]+), (.*)\)$/s;

/** A pending request: what its agent waits for. */
export function requestWords({ text, agent }) {
  const [, sort, by = agent, what = text] = REQUEST.exec(text) ?? [];
  if (sort === "OBS" || sort === "READY") return `${by} looks around`;
  if (sort === "MGR") return `${by} moves to ${what}`;
  if (sort !== "CTR" && sort !== "FLY") return text;
  const [pattern, asked, going] = ASKED.find(([each]) => each.test(what)) ?? [];
  if (!pattern) return sort === "FLY" ? `${by}'s order is carried out` : `${by} waits for its order to be sent`;
  const parts = pattern.exec(what);
  return (sort === "FLY" ? going : `waits ${asked}`).replace(/\$(\d)/g, (_, rank) => parts[rank]);
}

const DEEDS = {
  GoTo: (to) => `flies to ${to}`,
  Follow: (to) => `follows ${to}`,
  Hold: () => "holds",
  Return: () => "returns home",
  HandOver: (to) => `handed to ${to}`,
};
const STATES = { asked: "asked, not sent yet", sent: "sent, not confirmed yet", accepted: "accepted", arrived: "arrived", refused: "refused" };
const ENDS = { Hold: "in effect", Return: "is home", HandOver: "done" };

const OVER = ["arrived", "refused"];

/** The name of a station or a place; a station's channel has its sort before it. */
const bare = (name) => (name ?? "").split(":").at(-1);

/** What a vehicle was told last, and what became of it; one that flies home does nothing else meanwhile. */
export function orderWords({ command, to, state, why }, returning = false) {
  const deed = DEEDS[command]?.(bare(to)) ?? [command, bare(to)].filter(Boolean).join(" to ");
  if (returning && isUnderWay({ command, to, state })) return `${deed}: not now, it flies home`;
  return `${deed}, ${(state === "arrived" && ENDS[command]) || (STATES[state] ?? state)}${why ? `: ${why}` : ""}`;
}

/** Whether an order is still to be carried out. */
export const isUnderWay = (order) => Boolean(order?.to) && ["sent", "accepted"].includes(order.state) && order.command !== "HandOver";

const FALLBACKS = { hold: "then it holds", return: "then it returns home", continue: "then it goes on waiting" };

/** What follows when a request has stood for too long. */
export const fallbackWords = (fallback) => FALLBACKS[fallback] ?? "";

const FALLEN_BACK = { hold: "vehicles were told to hold", return: "vehicles were told to return home", continue: "the mission goes on" };

/** What was found, and what the run did of itself then. */
export const findingWords = ({ message, fallback }) => [message, FALLEN_BACK[fallback]].filter(Boolean).join(" · ");

const FATES = { asked: "asked, not sent yet", sent: "sent, not confirmed yet", confirmed: "confirmed by the vehicle", refused: "refused" };
const OURS = /^(say|give back|acknowledge|start)/;

/**
 * What became of an action, in words: what no vehicle has to confirm is done, unless nothing comes of it. A vehicle is told
 * again what it has refused; an order that ended before it was confirmed never will be.
 */
export function fateOf({ what, state, vain, fates, answered }) {
  if (state === "confirmed" && OURS.test(what)) return vain ? `heard, but ${vain}` : "done";
  if (state === "refused" && isOwed({ fates, answered })) return "refused, and told again";
  if (["asked", "sent"].includes(state) && answered) return `${state}, never confirmed`;
  return FATES[state] ?? state;
}

/** Whether vehicles still have to confirm an order. */
const isOwed = ({ fates, answered }) => !answered && Object.keys(fates ?? {}).length > 0;

/** What became of an order to several vehicles, of each. */
export const eachFate = ({ fates }) => (Object.keys(fates ?? {}).length > 1 ? Object.entries(fates).map(([name, { state, why }]) => `${name}: ${FATES[state]}${why ? `: ${why}` : ""}`) : []);

/** What an operator has ordered a vehicle to do, and what became of it. */
export const orderedWords = ({ order, by, state, why }) => `to ${order}, by ${by || "someone"}: ${state === "refused" ? `refused, and told again: ${why}` : FATES[state]}`;
