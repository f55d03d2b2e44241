/** Descriptions of the chart in words, for screen readers and for the tip at the pointer; at the time 0 nothing is heard. */
import { ageClass, FRESH } from "./ages.js";
import { isAstray, orderWords, whereabouts } from "../wording.js";
import { byName } from "../natural.js";
import { age, angle, position, speed } from "../units.js";
import { counted, drawable, plain } from "./words.js";

/** The lines about one thing: its name, its kind, its motion, its age, and its believed place. */
export function describe(name, store, now) {
  const entity = store.section("entities").get(name);
  if (entity) return describeEntity(name, entity, store.section("vehicles").get(name), now);
  const place = store.section("places").get(name);
  if (!place) return [];
  const within = place.parent ? ` in ${drawable(place.parent)}` : "";
  const band = place.altitude ? [`${place.altitude.join(" to ")} m high`] : [];
  return [drawable(name), `${place.kind ?? "place"}${within}`, ...band, ...(place.differs ? ["believed to be within something else than it is"] : [])].map(String);
}

function describeEntity(name, entity, card, now) {
  const heard = now === 0 ? "" : (entity.seen ?? null) === null ? "never heard, where the mission has it" : `heard ${age(entity.seen, now)} ago`;
  const old = ageClass(entity, now) === FRESH ? "" : ", old";
  const facts = [drawable(name), String(entity.kind ?? ""), position(entity.at), motion(entity), `${heard}${old}`];
  const place = entity.differs ? whereabouts({ ...card, ...entity }) : "";
  const order = card?.order ? orderWords(card.order, card.returning, entity.kind) : "";
  return [...facts, plain(place), plain(order), card?.why ?? ""].filter((line) => line !== "");
}

function motion({ course, speed: fast }) {
  const parts = [fast == null ? "" : speed(fast), course == null ? "" : angle(course)];
  return parts.filter((part) => part !== "").join(" ");
}

/** The whole chart in a few sentences. */
export function summary(store, now, centre) {
  const entities = [...store.section("entities")].sort(([a], [b]) => byName(a, b));
  const vehicles = entities.filter(([, { vehicle }]) => vehicle);
  const differing = entities.filter(([name, entity]) => isAstray({ ...store.section("vehicles").get(name), ...entity })).map(([name]) => drawable(name));
  const said = vehicles.slice(0, 20).map(([name]) => describe(name, store, now).slice(0, 5).join(", "));
  return [
    `Chart around ${position(centre)}.`,
    `${counted(vehicles.length, "vehicle")}, ${counted(entities.length - vehicles.length, "other target")}, ${counted(store.section("places").size, "place")}.`,
    ...said.map((each) => `${each}.`),
    ...(differing.length ? [`Believed to be elsewhere: ${differing.slice(0, 20).join(", ")}.`] : []),
  ].join(" ");
}
