/** The keyboard shortcuts, and their help sheet. */
import { html, Modal, useWatched } from "./ui.js";
import { system, SYSTEMS } from "./units.js";

const WRITES = "input:not([type=range]):not([type=checkbox]), textarea, select";

/** Every shortcut: key, description, and action. */
export function shortcuts(app) {
  return [
    ["?", "this help", () => app.help.set(!app.help.value)],
    ["Escape", "close; choose nothing", () => app.escape()],
    ["l", "live: the newest moment", () => app.live()],
    [" ", "play or pause", () => app.playOrPause()],
    ["[", "previous tick", () => app.step(-1)],
    ["]", "next tick", () => app.step(1)],
    [",", "slower", () => app.faster(-1)],
    [".", "faster", () => app.faster(1)],
    ["b", "10 s back", () => app.back(10)],
    ["B", "1 min back", () => app.back(60)],
    ["g", "go to a time that is typed", () => document.getElementById("goto")?.focus()],
    ["/", "find a vehicle, MMSI, place or event", () => app.focusFind()],
    ["j", "choose the next vehicle", () => app.chooseNext(1)],
    ["k", "choose the vehicle before", () => app.chooseNext(-1)],
    ["v", "to the chosen vehicle's card", () => app.focusCard()],
    ["a", "to the alert", () => document.querySelector(".acknowledge, .others")?.focus()],
    ["m", "to the map", () => app.focusMap()],
    ["f", "fit the map", () => app.map?.fit()],
    ["i", "the legend of the chart", () => app.map?.toggleLegend()],
    ["o", "follow the chosen, or the only one", () => app.following.set(!app.following.value)],
    ["r", "measure on the map", () => app.measuring.set(!app.measuring.value)],
    ["e", "enlarge the panel, or not", () => app.enlarged.set(!app.enlarged.value)],
    ["t", "light or dark", () => app.otherTheme()],
    ["s", "sound of alarms, or not", () => app.otherSound()],
    ...app.tabs.map(([key, title], n) => [String(n + 1), title, () => app.showTab(key)]),
  ];
}

export function listenForKeys(app) {
  const table = new Map(shortcuts(app).map(([key, , does]) => [key, does]));
  addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    const within = (selector) => event.target.closest?.(selector) && !event.target.closest("dialog:not([open])"); // a closed dialog keeps the focus until the next frame
    if (within(WRITES) && event.key !== "Escape") return;
    if (document.querySelector("dialog[open]") && !["?", "Escape"].includes(event.key)) return; // the page behind the dialog is hidden
    if (event.key === " " && within("button, summary, input:not([type=range]), a, [role=tab]")) return; // Space presses the focused control
    if (app.singleKeys.value === "off" && !["?", "Escape"].includes(event.key)) return;
    const does = table.get(event.key) ?? table.get(event.key.toLowerCase()); // the key with Shift may have its own entry
    if (!does) return;
    event.preventDefault();
    does();
  });
}

const NAMES = { " ": "Space", Escape: "Esc", B: "Shift B" };

export function Help({ app }) {
  const open = useWatched(app.help);
  const single = useWatched(app.singleKeys);
  const units = useWatched(system);
  return html`<${Modal} open=${open} class="help" aria-labelledby="help-title" closed=${() => app.help.set(false)}>
    <h2 id="help-title">Keys</h2>
    <dl>${shortcuts(app).map(([key, words]) => html`<div key=${key}><dt><kbd>${NAMES[key] ?? key.toUpperCase()}</kbd></dt><dd>${words}</dd></div>`)}</dl>
    <p>Hold, Return and Give back act when they are held for one second: by pointer, or by Enter or Space on the button. Tab goes from one thing to the next.</p>
    <p>In the picture and on the map: arrows move, + and − enlarge.</p>
    <p class="levels"><span class="level-0"><span class="mark">●</span> well</span> <span class="level-1"><span class="mark">▲</span> watch</span> <span class="level-2"><span class="mark">■</span> wrong</span> <span class="level-3"><span class="mark">✖</span> lost, taken over, broken</span> <span><span class="mark">?</span> unknown</span></p>
    <p><label>Units <select value=${units} onChange=${(event) => system.set(event.currentTarget.value)}>${Object.entries(SYSTEMS).map(([key, words]) => html`<option key=${key} value=${key}>${words}</option>`)}</select></label></p>
    <p><label><input type="checkbox" checked=${single === "on"} onChange=${(event) => app.singleKeys.set(event.currentTarget.checked ? "on" : "off")} /> single keys are shortcuts</label></p>
    <button type="button" class="close" autofocus onClick=${() => app.help.set(false)}>Close</button>
  <//>`;
}
