/** The colours of a mission's text: words by the generated TextMate grammar, names by the language server. */
import { Decoration, EditorView, HighlightStyle, StateEffect, StateField, StreamLanguage, syntaxHighlighting, tags } from "/parts/parts/codemirror.js";

/** The tag for the beginning of a TextMate scope, the longest first. */
const SCOPES = [
  ["comment", "lineComment"],
  ["string", "string"],
  ["constant.numeric", "number"],
  ["constant.language", "bool"],
  ["storage", "definitionKeyword"],
  ["keyword.operator.word", "operatorKeyword"],
  ["keyword.operator", "operator"],
  ["keyword", "keyword"],
  ["support.constant.property", "annotation"],
  ["support", "operatorKeyword"],
  ["entity.name.type", "typeName"],
  ["entity.name.class", "className"],
  ["entity.name", "labelName"],
  ["variable", "propertyName"],
];
const COLOURS = HighlightStyle.define([
  { tag: tags.lineComment, color: "var(--quiet)", fontStyle: "italic" },
  { tag: tags.string, color: "var(--lane-1)" },
  { tag: [tags.number, tags.bool], color: "var(--lane-5)" },
  { tag: [tags.definitionKeyword, tags.keyword], color: "var(--lane-0)", fontWeight: "600" },
  { tag: tags.operatorKeyword, color: "var(--lane-3)" },
  { tag: tags.annotation, color: "var(--lane-2)", fontWeight: "600" },
  { tag: tags.typeName, color: "var(--lane-3)" },
  { tag: tags.propertyName, color: "var(--lane-1)" },
]);

/** The language of missions by the patterns of a TextMate grammar, each a regular expression tried in order. */
export function missionLanguage(grammar) {
  const rules = JSON.parse(grammar).patterns.map(({ name, match, captures }) => ({ match: expression(match), scopes: name ? [name] : ["1", "2"].map((each) => captures[each].name) }));
  const word = expression("\\w+|\\s+|.");
  const parser = {
    name: "mission",
    startState: () => ({ left: [] }),
    copyState: ({ left }) => ({ left: [...left] }),
    token(stream, state) {
      const planned = state.left.shift();
      if (planned) {
        stream.pos += planned[0];
        return planned[1];
      }
      for (const { match, scopes } of rules) {
        match.lastIndex = stream.pos;
        const found = match.exec(stream.string);
        if (!found?.[0]) continue;
        if (scopes.length === 1) {
          stream.pos += found[0].length;
          return tagOf(scopes[0]);
        }
        const [whole, first, second] = found; // a word that declares, spaces, and the name
        state.left = [[whole.length - first.length - second.length, null], [second.length, tagOf(scopes[1])]];
        stream.pos += first.length;
        return tagOf(scopes[0]);
      }
      word.lastIndex = stream.pos;
      stream.pos += word.exec(stream.string)[0].length;
      return null;
    },
    languageData: { commentTokens: { line: "//" }, closeBrackets: { brackets: ["(", "[", "{", '"'] }, indentOnInput: /^\s*\}$/ },
    indent: ({ indentation }, after, context) => indentation === undefined ? null : indentOf(after, context),
  };
  return [StreamLanguage.define(parser), syntaxHighlighting(COLOURS)];
}

/** Two spaces more after an opening brace, two less before a closing one. */
function indentOf(after, context) {
  const before = context.lineAt(Math.max(0, context.pos - 1), -1).text;
  const deeper = /[{(]\s*$/.test(before) ? 2 : 0;
  return Math.max(0, /^\s*/.exec(before)[0].length + deeper - (/^\s*[})]/.test(after) ? 2 : 0));
}

/** An expression of the grammar with letters of all alphabets, which matches where it is tried alone. */
function expression(text) {
  return new RegExp(text.replaceAll("[^\\W\\d_]", "\\p{L}").replaceAll("[^\\W\\d]", "[\\p{L}_]").replaceAll("\\w", "[\\p{L}\\p{N}_]"), "yu");
}

function tagOf(scope) {
  return SCOPES.find(([beginning]) => scope.startsWith(beginning))?.[1] ?? null;
}

// --- names

/** The names of the text by the language server: `{from, to, type}` in order. */
export const setNames = StateEffect.define();
/** The name that is chosen in the text, on the map and in the bigraph; null for none. */
export const setChosen = StateEffect.define();

const CHOSEN = Decoration.mark({ class: "cm-chosen-name" });

export const names = StateField.define({
  create: () => ({ all: [], chosen: null, marks: Decoration.none }),
  update(value, transaction) {
    let { all, chosen } = value;
    if (transaction.docChanged) all = all.map((name) => ({ ...name, from: transaction.changes.mapPos(name.from, -1), to: transaction.changes.mapPos(name.to, 1) })).filter(({ from, to }) => from < to);
    for (const effect of transaction.effects) {
      if (effect.is(setNames)) all = effect.value.filter(({ to }) => to <= transaction.newDoc.length);
      if (effect.is(setChosen)) chosen = effect.value;
    }
    if (all === value.all && chosen === value.chosen) return value;
    const ranges = all.flatMap(({ from, to, type }) => [Decoration.mark({ class: `cm-name-${type}` }).range(from, to), ...(transaction.newDoc.sliceString(from, to) === chosen ? [CHOSEN.range(from, to)] : [])]);
    return { all, chosen, marks: Decoration.set(ranges, true) };
  },
  provide: (field) => EditorView.decorations.from(field, ({ marks }) => marks),
});

/** The names in the answer of the language server, whose positions are relative to the one before. */
export function namesOf({ data }, types, doc) {
  const found = [];
  let line = 0;
  let character = 0;
  for (let at = 0; at < data.length; at += 5) {
    if (data[at] > 0) character = 0;
    line += data[at];
    character += data[at + 1];
    if (line >= doc.lines) break;
    const from = doc.line(line + 1).from + character;
    found.push({ from, to: from + data[at + 2], type: types[data[at + 3]] });
  }
  return found;
}
