/** The screen for a missing or wrong token, which asks for it. */
import { html, useRef } from "./ui.js";

export function Door({ app, why, asks }) {
  const field = useRef(null);
  const enter = (event) => {
    event.preventDefault();
    app.admit(field.current.value.trim());
  };
  return html`<main class="door offline" role="status"><h1>bigactors console</h1>
    <p><b>Not admitted:</b> ${why}</p>
    ${asks && html`<form onSubmit=${enter}><label for="token">Token</label> <input id="token" ref=${field} type="password" autocomplete="off" required /> <button>Connect</button></form>
    <p class="quiet">It stands behind <code>#token=</code> in the link, and changes with each start of the console.</p>`}
  </main>`;
}
