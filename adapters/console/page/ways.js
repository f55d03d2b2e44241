/** The invariants about ways, which the run holds against what is seen: each with its figure. */
import { html, byName, useSections } from "./ui.js";

export function Ways({ app }) {
  const [invariants] = useSections(app.store, ["invariants"], 200);
  if (invariants.size === 0) return null;
  const worstFirst = [...invariants].sort(([a, one], [b, other]) => one.holds - other.holds || byName(a, b));
  return html`<section class="ways" aria-label="Ways"><ul>${worstFirst.map(([name, { holds, figure }]) => html`<li key=${name} class=${holds ? "" : "bad"}>
    <b>${holds ? "✓" : "✖"} ${name}:</b> <span class=${holds ? "quiet" : ""}>${figure || (holds ? "holds" : "is broken")}</span></li>`)}</ul></section>`;
}
