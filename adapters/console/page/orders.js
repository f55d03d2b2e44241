/** The buttons Hold, Return and Give back of one vehicle; while the past is shown, a button to now in the same place. */
import { html, useSections, useWatched } from "./ui.js";
import { HeldButton } from "./press.js";

/** The stations that a vehicle obeys, if this one is not among them: the run refuses orders to it. */
function useOthers(app, { authority = [] }) {
  const [mission] = useSections(app.store, ["mission"], 500);
  const station = mission.get("station");
  return station && !authority.includes(station) ? authority.join(" and ") : "";
}

/** The first button comes and goes; the others keep their places. */
export function Orders({ app, name, card }) {
  const { taken, on_return: onReturn } = card;
  const act = useWatched(app.mayOrder);
  const past = useWatched(app.inPast);
  const others = useOthers(app, card);
  if (past) return html`<div class="orders"><button type="button" class="now" onClick=${app.live}>Go to now (L) to act</button></div>`;
  if (!act) return null;
  if (others) return html`<div class="orders quiet">obeys ${others}: order it there</div>`;
  const order = (which) => () => app.act({ order: { order: which, vehicle: name } }, { what: which, about: name });
  return html`<div class="orders">
    ${taken && html`<${HeldButton} key="back" label=${`Give back ${name}`} tell=${app.tell} act=${() => app.act({ give_back: { vehicle: name } }, { what: "give back", about: name })}>Give back<//>`}
    <${HeldButton} key="hold" label=${`Hold ${name}`} tell=${app.tell} act=${order("hold")}>Hold<//>
    <${HeldButton} key="return" label=${`Return ${name}${onReturn ? `, ${onReturn}` : ""}`} short=${`Return ${name}`} tell=${app.tell} act=${order("return")}>Return<//>
  </div>`;
}

/** The names behind an order to several, as the run records them. */
const MOST_LISTED = 4;
const told = (names) => (names.length > MOST_LISTED ? `${names.length} vehicles` : names.join(", "));

/** The orders to the vehicles that were chosen in the table: one order, confirmed by each vehicle. */
export function Several({ app, names, all, cards }) {
  const act = useWatched(app.mayOrder);
  if (!act) return null;
  const one = names.length === 1;
  const about = told(names);
  const order = (which) => () => app.act({ order: { order: which, vehicle: one ? names[0] : names } }, { what: which, about });
  const back = async () => {
    for (const name of names) await app.act({ give_back: { vehicle: name } }, { what: "give back", about: name });
  };
  return html`<div class="several" role="group" aria-label="Orders to several">
    <label><input type="checkbox" checked=${names.length === all.length} onChange=${(event) => app.several.set(new Set(event.currentTarget.checked ? all : []))} /> all</label>
    <span class="quiet">${names.length === 0 ? "choose vehicles to order several" : `${names.length} chosen`}</span><span class="space"></span>
    ${names.length > 0 && html`
      <${HeldButton} label=${`Give back ${about}`} tell=${app.tell} act=${back}>Give back<//>
      <${HeldButton} label=${`Hold ${about}`} tell=${app.tell} act=${order("hold")}>Hold ${names.length}<//>
      <${HeldButton} label=${`Return ${about}`} tell=${app.tell} act=${order("return")}>Return ${names.length}<//>`}
    ${names.filter((name) => cards.get(name)?.on_return).slice(0, 1).map((name) => html`<p key=${name} class="on-return"><b>Return</b>, of ${name}: ${cards.get(name).on_return}</p>`)}
  </div>`;
}

/** The side effects of orders, shown before a button is pressed. */
export function SideEffects({ app, card: { taken, ordered, on_return: onReturn }, card }) {
  const act = useWatched(app.mayOrder);
  if (useOthers(app, card) || !act) return null;
  return html`${taken && !ordered && html`<p class="on-return">Each order overrules the pilot or the fail-safe that has it.</p>`}
    ${onReturn && html`<p class="on-return"><b>Return</b> ${onReturn}</p>`}`;
}
