/** The dialog for the operator's name, at the beginning and before the first action: each action is recorded with a name. */
import { Field, html, Modal, useState, useWatched } from "./ui.js";

export const LONGEST_NAME = 40;

export function Who({ app }) {
  const pending = useWatched(app.pending);
  const open = useWatched(app.asking) || pending !== null;
  const [name, setName] = useState("");
  const submit = (event) => {
    event.preventDefault();
    if (name.trim()) app.actAs(name.trim());
  };
  return html`<${Modal} open=${open} class="who-asks" aria-labelledby="who-title" closed=${() => app.forgetPending()}>
    <h2 id="who-title">Who are you?</h2>
    <form onSubmit=${submit}>
      <p><label for="who-name">Each action is recorded with the name of who did it.</label></p>
      <p><${Field} id="who-name" value="" maxlength=${LONGEST_NAME} required autocomplete="name" onInput=${(event) => setName(event.currentTarget.value)} /></p>
      <div class="buttons"><button class="do">${pending ? `${pending.words.what} ${pending.words.about}` : "Act"}${name.trim() && ` as ${name.trim()}`}</button>
        <button type="button" onClick=${() => app.forgetPending()}>${pending ? "Do nothing" : "Look first"}</button></div>
    </form>
  <//>`;
}
