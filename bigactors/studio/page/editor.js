/** The editor of a mission's text, over the language server of `bigactors lsp`. */
import {
  autocompletion, bracketMatching, closeBrackets, closeBracketsKeymap, codeFolding, completionKeymap, defaultKeymap, drawSelection, EditorState, EditorView, findReferencesKeymap, formatKeymap,
  gutter, GutterMarker, highlightActiveLine, highlightActiveLineGutter, highlightSpecialChars, history, historyKeymap, hoverTooltips, indentOnInput, indentWithTab, jumpToDefinitionKeymap, keymap, lineNumbers,
  lintGutter, lintKeymap, LSPClient, LSPPlugin, renameKeymap, searchKeymap, search, serverCompletion, setDiagnostics, StateEffect, StateField, Transaction,
} from "/parts/parts/codemirror.js";
import { missionLanguage, names, namesOf, setChosen, setNames } from "./highlighting.js";

const SETTLES = 250; // milliseconds without a change before the language server reads the text
const PATIENCE = 60_000; // milliseconds for an answer of the language server, which starts with the page
const MOST_FIXED = 30; // diagnostics that are asked for quick fixes
const SEVERITIES = { 1: "error", 2: "warning", 3: "info", 4: "hint" };
const PLAIN = new Set(["P", "PRE", "CODE", "EM", "STRONG", "UL", "OL", "LI", "BR", "HR", "SPAN", "TABLE", "THEAD", "TBODY", "TR", "TH", "TD", "H1", "H2", "H3", "H4"]);

/**
 * An editor in an element. It calls `changed()` after each change of the text, `named(name)` when the cursor enters a name,
 * `save()` for the key of saving, and `pressed(mark)` for a mark in the margin that is pressed. `lsp` is the way to the language server: `{send, subscribe, unsubscribe}`.
 */
export class Editor {
  constructor(element, { text, uri, types, grammar, lsp, changed, named, save, pressed }) {
    this.types = types;
    this.uri = uri;
    this.options = { changed, named };
    this.client = new LSPClient({ timeout: PATIENCE, sanitizeHTML: plain, extensions: [serverCompletion(), hoverTooltips(), { notificationHandlers: { "textDocument/publishDiagnostics": (_, params) => this.#diagnose(params) } }] });
    this.client.connect(lsp);
    const keys = [{ key: "Mod-s", preventDefault: true, run: () => (save(), true) }, ...closeBracketsKeymap, ...lintKeymap, ...completionKeymap, ...formatKeymap, ...renameKeymap, ...jumpToDefinitionKeymap, ...findReferencesKeymap];
    const view = [lineNumbers(), margin(pressed), lintGutter(), highlightSpecialChars(), drawSelection(), highlightActiveLine(), highlightActiveLineGutter(), bracketMatching(), LOOK, EditorView.lineWrapping];
    const editing = [history(), indentOnInput(), closeBrackets(), autocompletion(), search({ top: true }), keymap.of([...keys, ...searchKeymap, ...historyKeymap, ...defaultKeymap, indentWithTab])];
    const about = EditorView.contentAttributes.of({ tabindex: "0", "aria-label": "The mission's text. Escape and Tab leave it.", spellcheck: "false" });
    const listening = EditorView.updateListener.of((update) => this.#hear(update));
    const state = EditorState.create({ doc: text, extensions: [view, editing, about, names, missionLanguage(grammar), this.client.plugin(uri, "mission"), listening] });
    const root = element.attachShadow({ mode: "open" }); // its style sheets need no exception from the page's policy
    this.view = new EditorView({ state, parent: root, root });
    this.#nameSoon(0);
  }

  get text() {
    return this.view.state.doc.toString();
  }

  /** Replace the text, as when another program has saved it; what is the same stays where it is. */
  replace(text) {
    const now = this.text;
    let from = 0;
    while (from < Math.min(now.length, text.length) && now[from] === text[from]) from++;
    let left = 0;
    while (left < Math.min(now.length, text.length) - from && now.at(-1 - left) === text.at(-1 - left)) left++;
    this.view.dispatch({ changes: { from, to: now.length - left, insert: text.slice(from, text.length - left) }, userEvent: "input.outside" });
  }

  /** Apply changes `{from, to, insert}` as one step of the history, and bring the first into view. */
  edit(changes) {
    this.view.dispatch({ changes, userEvent: "input.world", annotations: Transaction.addToHistory.of(true), effects: EditorView.scrollIntoView(changes[0].from, { y: "nearest", yMargin: 40 }) });
  }

  /** Mark a name that was chosen elsewhere, and bring its first place into view unless one is there. */
  choose(name) {
    const effects = [setChosen.of(name)];
    const { all, chosen } = this.view.state.field(names);
    if (name === chosen) return;
    const places = all.filter(({ from, to }) => this.view.state.sliceDoc(from, to) === name);
    const { head } = this.view.state.selection.main;
    const at = places.some(({ from, to }) => from <= head && head <= to);
    if (places.length && !at) effects.push(EditorView.scrollIntoView(places[0].from, { y: "center" }));
    this.view.dispatch({ effects });
  }

  /** Put the cursor at the beginning of a line. */
  goTo(line) {
    const { from } = this.view.state.doc.line(Math.min(Math.max(1, line), this.view.state.doc.lines));
    this.view.dispatch({ selection: { anchor: from }, effects: EditorView.scrollIntoView(from, { y: "center" }) });
    this.view.focus();
  }

  /** Show marks in the margin: `{line, sign, sort, title}`; the text keeps them at their lines. */
  mark(marks) {
    const { doc } = this.view.state;
    this.view.dispatch({ effects: setMarks.of(marks.filter(({ line }) => line > 0 && line <= doc.lines).map((each) => ({ ...each, at: doc.line(each.line).from }))) });
  }

  destroy() {
    clearTimeout(this.naming);
    this.client.disconnect();
    this.view.destroy();
  }

  #hear(update) {
    if (update.docChanged) {
      this.#nameSoon(SETTLES);
      this.options.changed();
    }
    const { all } = update.state.field(names);
    const arrive = all !== update.startState.field(names).all;
    if (update.docChanged || !(update.selectionSet || (arrive && this.early))) return;
    this.early = all.length === 0; // the cursor was put somewhere before the language server knew the names
    const { head } = update.state.selection.main;
    const found = all.find(({ from, to }) => from <= head && head <= to);
    if (found) this.options.named(update.state.sliceDoc(found.from, found.to));
  }

  /** Send the text to the language server after a moment, and colour the names. */
  #nameSoon(pause) {
    clearTimeout(this.naming);
    this.naming = setTimeout(async () => {
      const found = await this.#tokens().catch(() => null); // the page says when the server has ended
      const { doc } = this.view.state;
      if (found?.doc === doc) this.view.dispatch({ effects: setNames.of(namesOf(found.tokens, this.types, doc)) });
    }, pause);
  }

  async #tokens() {
    await this.client.initializing;
    this.client.sync();
    const { doc } = this.view.state;
    return { doc, tokens: await this.client.request("textDocument/semanticTokens/full", { textDocument: { uri: this.uri } }) };
  }

  /** Show diagnostics, each with the quick fixes that the server has for it. */
  #diagnose({ uri, version, diagnostics }) {
    const file = this.client.workspace.getFile(uri);
    const plugin = LSPPlugin.get(this.view);
    if (!file || !plugin || (version != null && version !== file.version)) return false;
    const offset = (position) => plugin.unsyncedChanges.mapPos(plugin.fromPosition(position, plugin.syncedDoc));
    const found = diagnostics.map(({ range, severity, message, code }, n) => ({
      from: offset(range.start), to: offset(range.end), severity: SEVERITIES[severity] ?? "error", source: code ?? "", message,
      actions: n < MOST_FIXED && severity === 1 ? [] : undefined, range,
    }));
    this.view.dispatch(setDiagnostics(this.view.state, found));
    this.#addFixes(found.filter(({ actions }) => actions), found);
    return true;
  }

  async #addFixes(fixable, all) {
    const { doc } = this.view.state;
    const answers = await Promise.all(fixable.map(({ range }) => this.client.request("textDocument/codeAction", { textDocument: { uri: this.uri }, range, context: { diagnostics: [] } }).catch(() => [])));
    if (doc !== this.view.state.doc || !answers.some((each) => each?.length)) return;
    fixable.forEach((diagnostic, n) => {
      diagnostic.actions = (answers[n] ?? []).map(({ title, edit }) => ({ name: title, apply: (view) => this.#apply(view, edit.changes[this.uri]) }));
    });
    this.view.dispatch(setDiagnostics(this.view.state, all));
  }

  #apply(view, edits) {
    const plugin = LSPPlugin.get(view);
    view.dispatch({ changes: edits.map(({ range, newText }) => ({ from: plugin.fromPosition(range.start), to: plugin.fromPosition(range.end), insert: newText })), userEvent: "input.fix" });
  }
}

/** Markup without anything but text structure: a mission's words may stand in it. */
function plain(markup) {
  const { body } = new DOMParser().parseFromString(markup, "text/html");
  for (const element of [...body.querySelectorAll("*")]) {
    if (!PLAIN.has(element.tagName)) element.replaceWith(element.textContent);
    else for (const { name } of [...element.attributes]) if (name !== "class") element.removeAttribute(name);
  }
  return body.innerHTML;
}

// --- the margin: verdicts at their properties, and what is never reached

const setMarks = StateEffect.define();

const marks = StateField.define({
  create: () => [],
  update(value, transaction) {
    for (const effect of transaction.effects) if (effect.is(setMarks)) return effect.value;
    return transaction.docChanged ? value.map((mark) => ({ ...mark, at: transaction.changes.mapPos(mark.at, 1) })) : value;
  },
});

class Sign extends GutterMarker {
  constructor(mark) {
    super();
    this.mark = mark;
    this.elementClass = `sign-${mark.sort}`;
  }
  eq({ mark }) {
    return mark.sign === this.mark.sign && mark.title === this.mark.title;
  }
  toDOM() {
    const shown = document.createElement("span");
    Object.assign(shown, { textContent: this.mark.sign, title: this.mark.title });
    return shown;
  }
}

function margin(pressed) {
  const at = (view, line) => view.state.field(marks).find((mark) => mark.at >= line.from && mark.at <= line.to);
  return [marks, gutter({
    class: "cm-margin",
    lineMarker: (view, line) => { const mark = at(view, line); return mark ? new Sign(mark) : null; },
    lineMarkerChange: (update) => update.state.field(marks) !== update.startState.field(marks),
    initialSpacer: () => new Sign({ sign: "✓", sort: "none", title: "" }),
    domEventHandlers: { click: (view, line) => { const mark = at(view, line); if (mark) pressed(mark); return Boolean(mark); } },
  })];
}

const LOOK = EditorView.theme({
  "&": { height: "100%", backgroundColor: "var(--surface)", color: "var(--ink)", fontSize: "13px" },
  "&.cm-focused": { outline: "none" },
  ".cm-scroller": { fontFamily: 'ui-monospace, "SFMono-Regular", Menlo, Consolas, "DejaVu Sans Mono", monospace', lineHeight: "1.5" },
  ".cm-content": { caretColor: "var(--ink)" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  ".cm-gutters": { backgroundColor: "var(--raised)", color: "var(--quiet)", borderRight: "1px solid var(--line)" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "color-mix(in srgb, var(--accent) 8%, transparent)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "color-mix(in srgb, var(--accent) 28%, transparent) !important" },
  ".cm-tooltip, .cm-panels, .cm-panel": { backgroundColor: "var(--raised)", color: "var(--ink)", border: "1px solid var(--line)" },
  ".cm-tooltip": { maxWidth: "46em" },
  ".cm-lsp-hover-tooltip, .cm-lsp-documentation": { padding: "4px 8px" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "var(--accent)", color: "var(--on-accent)" },
  ".cm-diagnostic": { whiteSpace: "pre-wrap" },
  ".cm-diagnosticAction": { backgroundColor: "var(--accent)", color: "var(--on-accent)", font: "inherit", padding: "2px 8px", cursor: "pointer" },
  ".cm-textfield, .cm-button": { backgroundColor: "var(--surface)", backgroundImage: "none", color: "var(--ink)", border: "1px solid var(--line)" },
  ".cm-chosen-name": { backgroundColor: "color-mix(in srgb, var(--accent) 22%, transparent)", outline: "1px solid var(--accent)", borderRadius: "2px" },
  ".cm-name-class": { color: "var(--lane-4)" },
  ".cm-name-enumMember, .cm-name-enumMember span": { color: "var(--ink)" },
  ".cm-name-type": { color: "var(--lane-3)" },
  ".cm-name-event": { color: "var(--lane-1)" },
  ".cm-margin .cm-gutterElement": { width: "16px", textAlign: "center", cursor: "default" },
  ".sign-holds": { color: "var(--well)" },
  ".sign-violated": { color: "var(--wrong)", cursor: "pointer !important" },
  ".sign-incomplete": { color: "var(--watch)" },
  ".sign-gap": { color: "var(--watch)", backgroundColor: "color-mix(in srgb, var(--watch) 18%, transparent)" },
});
