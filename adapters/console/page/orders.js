/** The buttons Hold, Return and Give back of one vehicle; while the past is shown, a button to now in the same place. */
import { html, useWatched } from "./ui.js";
import { HeldButton } from "./press.js";

/** The first button comes and goes; the others keep their places. */
export function Orders({ app, name, card: { taken, on_return: onReturn } }) {
  const act = useWatched(app.mayAct);
  const past = useWatched(app.inPast);
  if (past) return html`<div class="orders"><button type="button" class="now" onClick=${app.live}>Go to now (L) to act</button></div>`;
  if (!act) return null;
  const order = (which) => () => app.act({ order: { order: which, vehicle: name } }, { what: which, about: name });
  return html`<div class="orders">
    ${taken && html`<${HeldButton} key="back" label=${`Give ${name} back`} tell=${app.tell} act=${() => app.act({ give_back: { vehicle: name } }, { what: "give back", about: name })}>Give back<//>`}
    <${HeldButton} key="hold" label=${`Hold ${name}`} tell=${app.tell} act=${order("hold")}>Hold<//>
    <${HeldButton} key="return" label=${`Return ${name}${onReturn ? `, ${onReturn}` : ""}`} short=${`Return ${name}`} tell=${app.tell} act=${order("return")}>Return<//>
  </div>`;
}

/** The side effect of an order to return, shown before the button is pressed. */
export function OnReturn({ app, card }) {
  const act = useWatched(app.mayAct);
  return act && card.on_return ? html`<p class="on-return"><b>Return</b> ${card.on_return}</p>` : null;
}
