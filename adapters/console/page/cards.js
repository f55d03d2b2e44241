/** The vehicles, worst first: a card each; from three on a table, a row each, in which the chosen one opens its card. */
import { html, memo, byName, useEffect, useRef, useSections, useWatched } from "./ui.js";
import { Age, Ticking, say } from "./clock.js";
import { distance, distanceToArea } from "./map/geodesy.js";
import { fallbackWords, fateOf, isAstray, moves, orderedWords, orderWords, requestWords, wayOf, whereabouts } from "./wording.js";
import { Orders, Several, SideEffects } from "./orders.js";
import { useStillness } from "./stable_list.js";
import { angle, age, duration, metres, position, range, speed, system, utc } from "./units.js";

const MARKS = ["●", "▲", "■", "✖"];
/** The word for a vehicle without any current information. */
const UNKNOWN = "unknown";
const UNKNOWN_MARK = "?";
/** The number of vehicles from which each has a row. */
const MANY = 3;
/** Seconds for which a change of authority is marked, a finished action is shown, and a vehicle's text is not dimmed. */
const NEW = 60;
/** Seconds after which a vehicle's text disappears. */
const STALE = 900;

export const worstFirst = (vehicles) => [...vehicles].sort(([one, a], [other, b]) => b.level - a.level || byName(one, other)).map(([name]) => name);

export function Cards({ app }) {
  const [vehicles, entities] = useSections(app.store, ["vehicles", "entities"], 200);
  const chosen = useWatched(app.chosen);
  const stale = useWatched(app.stale);
  useWatched(system);
  const list = useRef(null);
  const [isStill, hand] = useStillness(list);
  const sorted = worstFirst(vehicles);
  const known = new Set(app.order);
  app.order = isStill() ? [...app.order.filter((name) => vehicles.has(name)), ...sorted.filter((name) => !known.has(name))] : sorted;
  useEffect(() => () => (app.order = []), []);

  useEffect(() => {
    if (chosen !== null) list.current?.querySelector(`[data-row="${CSS.escape(chosen)}"], [data-name="${CSS.escape(chosen)}"]`)?.scrollIntoView({ block: "nearest" });
  }, [chosen]);

  const many = vehicles.size >= MANY;
  const several = useWatched(app.several);
  return html`<section class="cards" aria-labelledby="cards-title" id="cards">
    <h2 id="cards-title">Vehicles <span class="count">${vehicles.size}</span>
      ${tallied([...vehicles.values()], stale).map(([word, { level, count }]) => html`<span key=${word} class=${`tally level-${level}`}>${markOf(word, level)} ${count} ${word}</span>`)}
    </h2>
    <div class="scroll" ref=${list} ...${hand} tabindex="-1"><div class="stack">
      ${chosen !== null && !vehicles.has(chosen) && entities.has(chosen) && html`<${Entity} key="*chosen" app=${app} name=${chosen} entity=${entities.get(chosen)} />`}
      ${vehicles.size === 0 && html`<p class="none">No vehicle is known yet.</p>`}
      ${app.order.map((name) => html`<${many ? FleetRow : Card} key=${name} app=${app} name=${name} card=${vehicles.get(name)}
        chosen=${name === chosen} several=${several.has(name)} stale=${stale} units=${system.value} />`)}
    </div></div>
    ${many && html`<${Several} key="several" app=${app} names=${app.order.filter((name) => several.has(name))} all=${app.order} cards=${vehicles} />`}
  </section>`;
}

/** A vehicle's row, above its card if it is chosen. */
const FleetRow = memo(({ app, name, card, chosen, several, stale }) => {
  const word = wordOf(card, stale);
  const pick = (event) => {
    const next = new Set(app.several.value);
    if (event.currentTarget.checked) next.add(name);
    else next.delete(name);
    app.several.set(next);
  };
  return html`<div class=${`fleet level-${card.level}`} data-row=${name}>
    <div class="row">
      <input type="checkbox" aria-label=${`choose ${name} for an order to several`} checked=${several} onChange=${pick} />
      <button type="button" class="name" aria-expanded=${String(chosen)} onClick=${() => app.chosen.set(chosen ? null : name)}><span class="mark" aria-hidden="true">${markOf(word, card.level)}</span> ${name}</button>
      <span class=${`level ${card.level || stale ? "" : "quiet"}`}>${word}</span>
      <${LinkAge} app=${app} link=${card.link} unknown=${word === UNKNOWN} />
      <span><${Battery} battery=${card.battery} /></span>
      ${!chosen && html`<span class="rest" title=${card.why}>${card.level > 0 && card.why ? html`<b>${card.why}</b>` : whereabouts(card)}</span>`}
    </div>
    ${chosen && html`<${Card} app=${app} name=${name} card=${card} chosen=${true} stale=${stale} units=${system.value} />`}
  </div>`;
});

const wordOf = ({ word }, stale) => (stale ? UNKNOWN : word);
const markOf = (word, level) => (word === UNKNOWN ? UNKNOWN_MARK : MARKS[level]);

/** The number of vehicles for each word, the best first: `[word, {level, count}]`. */
function tallied(cards, stale) {
  const found = new Map();
  for (const card of cards) {
    const word = wordOf(card, stale);
    const known = found.get(word) ?? { level: card.level, count: 0 };
    found.set(word, { level: Math.max(known.level, card.level), count: known.count + 1 });
  }
  return [...found].sort(([, a], [, b]) => a.level - b.level);
}

const Card = memo(({ app, name, card, chosen, stale }) => {
  const choose = () => app.chosen.set(chosen ? null : name);
  const word = wordOf(card, stale);
  return html`<article class=${`card level-${card.level} ${chosen ? "chosen" : ""}`} data-name=${name} aria-label=${name}>
    <header>
      <h3>
        <span class="mark" aria-hidden="true">${markOf(word, card.level)}</span>
        <button type="button" class="name" aria-pressed=${String(chosen)} onClick=${choose}>${name}</button>
        <span class="kind">${card.kind}</span>
        <span class=${`level ${card.level || stale ? "" : "quiet"}`}>${word}</span>
        <${LinkAge} app=${app} link=${card.link} unknown=${word === UNKNOWN} />
        <${Battery} battery=${card.battery} />
      </h3>
      <${Orders} app=${app} name=${name} card=${card} />
    </header>
    <${SideEffects} app=${app} card=${card} />
    ${card.why && html`<p class="why">${card.why}</p>`}
    <dl>
      <dt>Place</dt><dd><${Place} card=${card} /></dd>
      <dt>Request</dt><dd>${card.request ? html`<${Request} app=${app} card=${card} />` : html`<span class="quiet">none</span>`}</dd>
      ${card.flight && isCommanded(card) && html`<dt>${moves(card.kind) === "flies" ? "Flight" : "Trip"}</dt><dd><${Flight} app=${app} flight=${card.flight} /></dd>`}
      ${card.order && html`<dt>Order</dt><dd><${Order} app=${app} order=${card.order} returning=${card.returning} kind=${card.kind} /></dd>`}
      ${motion(app.store, name, card) && html`<dt>Motion</dt><dd><${Ticking} clock=${app.clock} apply=${(element) => say(element, motion(app.store, name, card))} /></dd>`}
      ${status(card) && html`<dt>Mode</dt><dd>${status(card)}</dd>`}
      <${Approach} app=${app} name=${name} />
      ${card.authority?.length > 0 && html`<dt>Authority</dt><dd><${Authority} app=${app} card=${card} /></dd>`}
      ${card.said && app.clock.now - card.said.time < STALE && html`<dt>Said</dt><dd><${Said} app=${app} said=${card.said} /></dd>`}
      ${card.ordered ? html`<dt>Ordered</dt><dd><${Ordered} app=${app} ordered=${card.ordered} /></dd>` : card.taken && html`<dt>Taken over</dt><dd class="bad">${card.taken}</dd>`}
    </dl>
    <${LastAction} app=${app} about=${name} ordered=${card.ordered} />
  </article>`;
});

/** A vehicle's own status; "" if it sent none, as in an older recording. */
function status({ mode, armed, heading, link }) {
  const parts = [mode, typeof armed === "boolean" && (armed ? "armed" : "disarmed"), isNumber(heading) && `heading ${angle(heading)}`];
  return asHeard(link, parts);
}

/** A vehicle's reported facts, marked as old if its link is lost, or the run has ended. */
function asHeard({ lost, over }, parts) {
  const told = parts.filter(Boolean).join(" · ");
  return told && (lost || over) ? `when last heard: ${told}` : told;
}

/** A vehicle's speed, height and remaining distance; "" if none is known. */
function motion(store, name, card) {
  const { height, altitude, link } = card;
  const { speed: fast } = store.section("entities").get(name) ?? {};
  const high = isNumber(height) ? `${metres(height)} above home` : isNumber(altitude) ? `${metres(altitude)} above the sea` : "";
  return asHeard(link, [isNumber(fast) ? speed(fast) : "", high, toGo(store, name, card)]);
}

/** A vehicle's remaining distance in a straight line, to the edge of its destination, not to its middle. */
function toGo(store, name, card, brief = false) {
  const { at, speed: fast } = store.section("entities").get(name) ?? {};
  const goal = wayOf(card).at(-1);
  if (!at || !goal) return "";
  const ring = card.returning ? [] : store.section("places").get(card.order.to)?.ring ?? [];
  const left = ring.length > 2 ? distanceToArea(at, ring) : distance(at, goal);
  const where = card.returning ? "home" : ring.length > 2 && !brief ? `to the edge of ${card.order.to}` : "to go";
  return left > 0 ? `${range(left)} ${where}${fast > 1 ? `, ${duration(left / fast)} or more` : ""}` : `in ${card.order.to}`;
}

/** A vehicle in two lines, for a phone's map: the reason why it needs an operator precedes its motion. */
export function Brief({ app, name, card }) {
  const { height, mode, link } = card;
  const facts = asHeard(link, [mode, isNumber(height) && metres(height), toGo(app.store, name, card, true)]);
  const word = wordOf(card, useWatched(app.stale));
  return html`<span class="level">${word}</span> <${Battery} battery=${card.battery} /> <${LinkAge} app=${app} link=${card.link} unknown=${word === UNKNOWN} />
    ${card.level > 0 && html`<span class="why" title=${card.why}>${card.why}</span>`} <span class="quiet">${facts}</span>`;
}

/** Whether the mission commands a vehicle now; its time limits do not count for other flights. */
const isCommanded = ({ taken, returning, request }) => !taken && !returning && !request?.given_up;

const isNumber = (value) => typeof value === "number";

function Place({ card }) {
  return html`<span class=${`place ${isAstray(card) ? "differs" : ""}`}>${whereabouts(card)}</span>`;
}

/** The age of a vehicle's last message, marked when it is old; its time of day once the run has stopped listening. */
export function LinkAge({ app, link, unknown }) {
  if ((unknown || link.over) && link.heard !== null) return html`<span class=${`link ${unknown || link.lost ? "bad" : "quiet"}`}>last heard ${utc(link.heard)}</span>`;
  if (link.lost) return html`<span class="link bad">link lost${link.heard !== null && html` <${Age} clock=${app.clock} time=${link.heard} />`}</span>`;
  if (link.heard === null) return html`<span class="link quiet">not heard</span>`;
  const apply = (element, now) => {
    say(element, `link ${age(link.heard, now)}`);
    element.className = now - link.heard > 5 ? "link late" : "link";
  };
  return html`<${Ticking} clock=${app.clock} apply=${apply} class="link" />`;
}

export function Battery({ battery }) {
  if (!battery || !isNumber(battery.percent)) return null;
  const low = battery.percent < 25;
  return html`<span class=${`battery ${low ? "bad" : ""}`} title=${isNumber(battery.volts) ? `battery, ${battery.volts.toFixed(1)} V` : "battery"}>
    <span class="cell" aria-hidden="true"><i style=${{ width: `${Math.max(0, Math.min(100, battery.percent))}%` }}></i></span>
    <span class="unseen">battery </span>${Math.round(battery.percent)} %</span>`;
}

/**
 * A request with its waiting time, its time limit and its fallback; the title has the mission's own words.
 * The fallback is omitted for a vehicle that the mission does not command now: it would not receive that order.
 */
function Request({ app, card: { request, taken, returning, kind } }) {
  const { since, limit, fallback, given_up: givenUp } = request;
  if (givenUp) return html`<span class="request" title=${request.text}>given up: ${requestWords(request, kind)}</span>`;
  const stood = (now) => Math.max(0, now - since);
  const then = limit && !taken && fallbackWords(fallback) ? `, ${fallbackWords(fallback)}` : "";
  const words = (element, now) => say(element, limit ? `${duration(stood(now))} of ${duration(limit)}${then}` : `for ${duration(stood(now))}`);
  const bar = (element, now) => {
    const part = stood(now) / limit;
    element.style.setProperty("--part", Math.min(1, part).toFixed(3));
    element.className = `bar ${part > 1 ? "over" : part > 0.5 ? "half" : ""}`;
  };
  return html`<span class="request" title=${request.text}><span>${taken || returning ? "not now: " : ""}${requestWords(request, kind)}</span> <${Ticking} clock=${app.clock} apply=${words} class="stood" />
    ${limit ? html`<${Ticking} clock=${app.clock} apply=${bar} class="bar" aria-hidden="true" />` : null}</span>`;
}

/** The elapsed time of a flight, and the remaining time by the mission's times. */
function Flight({ app, flight: { since, least, most } }) {
  const timed = most !== null;
  const words = (element, now) => {
    const gone = Math.max(0, now - since);
    const [soonest, latest] = [least - gone, most - gone];
    element.className = timed && latest < 0 ? "bad" : "";
    const left =
      timed && latest < 0 ? `${duration(latest)} longer than it may take`
      : timed ? `${soonest > 0 ? `${duration(soonest)} to ` : "at most "}${duration(latest)} to go`
      : soonest > 0 ? `${duration(soonest)} or more to go`
      : "it may take any time";
    say(element, `for ${duration(gone)}, ${left}`);
  };
  return html`<${Ticking} clock=${app.clock} apply=${words} />`;
}

function Order({ app, order, returning, kind }) {
  return html`<span class=${order.state === "refused" ? "bad" : ""}>${orderWords(order, returning, kind)} · <${Age} clock=${app.clock} time=${order.since} /> ago</span>`;
}

/** An operator's order: asked, sent, confirmed or refused; only a confirmed one is done. */
function Ordered({ app, ordered }) {
  return html`<span class=${`ordered ${ordered.state} ${ordered.why ? "bad" : ""}`}>${orderedWords(ordered)} · <${Age} clock=${app.clock} time=${ordered.since} /> ago</span>`;
}

/** The controlling stations of a vehicle; a change is marked for a minute. */
function Authority({ app, card: { authority, handed } }) {
  const told = handed && ((element, now) => {
    const isNew = now - handed.time < NEW;
    say(element, isNew ? ` changed ${age(handed.time, now)} ago, was ${handed.from.join(", ") || "nobody"}` : "");
    element.className = isNew ? "changed" : "";
  });
  return html`${authority.join(", ")}${told && html`<${Ticking} clock=${app.clock} apply=${told} />`}`;
}

/** The closest approach (CPA) of a vehicle and a target, if both keep course and speed. */
function Approach({ app, name }) {
  const [approaches] = useSections(app.store, ["approaches"], 500);
  const found = [...approaches.values()].filter(({ vehicle, target }) => name === vehicle || name === target).sort((a, b) => a.distance - b.distance)[0];
  if (!found) return null;
  const { vehicle, target, distance: least, range: far, at } = found;
  const words = (element, now) => say(element, at > now ? ` in ${duration(at - now)}, now ${range(far)}` : " now: then they part");
  return html`<dt title="closest point of approach, if both keep course and speed">CPA</dt><dd><button type="button" class="name plain" onClick=${() => app.find(name === vehicle ? target : vehicle)}>${name === vehicle ? target : vehicle}</button> ${range(least)}<${Ticking} clock=${app.clock} apply=${words} /></dd>`;
}

/** A vehicle's last text, dimmed when it is old. */
function Said({ app, said }) {
  const dim = (element, now) => (element.className = now - said.time > NEW ? "said quiet" : "said");
  return html`<${Ticking} clock=${app.clock} apply=${dim} class="said">“${said.text}” <${Age} clock=${app.clock} time=${said.time} class="quiet" /><span class="quiet"> ago</span><//>`;
}

/** The state of the last action on this vehicle, unless the order above shows it; a finished action is shown for a minute. */
function LastAction({ app, about, ordered }) {
  const [actions] = useSections(app.store, ["actions"], 200);
  const last = [...actions.values()].filter((action) => action.about === about).sort((a, b) => b.time - a.time)[0];
  if (!last || last.time === ordered?.since) return null;
  if (last.state !== "refused" && last.answered && app.clock.now - last.answered > NEW) return null;
  return html`<p class=${`fate ${last.state}`}><b>${last.what}</b> by ${last.by || "someone"}: ${fateOf(last)}${last.why ? `: ${last.why}` : ""}</p>`;
}

/** An entity chosen on the map that is not a vehicle of the mission. */
const Entity = memo(({ app, name, entity }) => html`<article class="card entity chosen" data-name=${name} aria-label=${name}>
    <h3><button type="button" class="name" aria-pressed="true" onClick=${() => app.chosen.set(null)}>${name}</button> <span class="kind">${entity.kind}</span>
      <span class="quiet">${entity.source}</span></h3>
    <dl><dt>Place</dt><dd><${Place} card=${entity} /></dd>
      <dt>Position</dt><dd>${position(entity.at)}</dd>
      <dt>Motion</dt><dd>${isNumber(entity.course) ? `course ${angle(entity.course)}` : "course not reported"} · ${isNumber(entity.speed) ? speed(entity.speed) : "speed not reported"}</dd>
      <dt>Seen</dt><dd><${Age} clock=${app.clock} time=${entity.seen} /> ago</dd><${Approach} app=${app} name=${name} /></dl>
  </article>`);
