"""A self-contained page of the state space; a click on a state shows its bigraph."""

from __future__ import annotations

import json
from html import escape
from typing import Final

from bigraphs.exports.dot import describe
from bigraphs.exports.svg import bigraph_svg, graph_svg
from bigraphs.transitions import TransitionSystem

MOST_STATES: Final = 2_000
"""How many states a page shows: more of them is no picture."""


def to_html(system: TransitionSystem, title: str) -> str:
    """Return a page; of a larger system it holds the first states only, and says so."""
    shown = first_states(system, MOST_STATES)
    facts = {
        "states": [bigraph_svg(shown.state(state)) for state in range(len(shown))],
        "labels": [list(shown.labels_of(state)) for state in range(len(shown))],
        "moves": [[each.source, each.target, describe(shown, each)] for each in shown.transitions()],
        "paths": [shown.found_from[state] for state in range(len(shown))],
    }
    data = json.dumps(facts, ensure_ascii=False).replace("</", "<\\/")
    return _PAGE.format(
        title=escape(title), summary=escape(_summary(system, len(shown))), graph=graph_svg(shown), data=data
    )


def first_states(system: TransitionSystem, most: int) -> TransitionSystem:
    """Return the part of a system that its first states are, with the transitions between them."""
    if len(system) <= most:
        return system
    kept = [n for n, start in enumerate(system.starts) if start < most and system.targets[n] < most]
    return system.restricted(most, kept)


def _summary(system: TransitionSystem, shown: int) -> str:
    parts = [f"{len(system):,} states", f"{len(system.starts):,} transitions"]
    parts.append("complete" if system.complete else f"incomplete: {system.reason}")
    if shown < len(system):
        parts.append(f"the first {shown:,} states are shown")
    return ", ".join(parts)


_PAGE: Final = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
body {{ margin: 0; font: 14px/1.45 sans-serif; color: #3b4252; display: grid; height: 100vh;
  grid-template: auto 1fr / minmax(20rem, 3fr) minmax(20rem, 2fr); }}
header {{ grid-column: 1 / 3; padding: .6rem 1rem; border-bottom: 1px solid #d8dee9; }}
h1 {{ font-size: 1.1rem; margin: 0; display: inline; }} header span {{ margin-left: 1rem; color: #7b8494; }}
#graph, #side {{ overflow: auto; padding: 1rem; }} #side {{ border-left: 1px solid #d8dee9; }}
.s {{ cursor: pointer; }} .s.on circle {{ stroke: #e4572e; stroke-width: 4; }}
.t.on {{ stroke: #e4572e; stroke-width: 2.5; }} h2 {{ font-size: 1rem; margin: .2rem 0; }}
button {{ font: inherit; border: 0; background: none; color: #2f6db5; cursor: pointer;
  padding: 0; text-align: left; }}
button:hover {{ text-decoration: underline; }} ul {{ padding-left: 1.1rem; margin: .3rem 0; }}
#picture svg {{ max-width: 100%; height: auto; }}
.label {{ background: #fdf1e3; border-radius: 6px; padding: 0 .4rem; }}
</style></head><body>
<header><h1>{title}</h1><span>{summary}</span></header>
<div id="graph">{graph}</div>
<div id="side"><h2 id="name"></h2><div id="labels"></div><div id="picture"></div>
<h2>what can happen</h2><ul id="moves"></ul><h2>a shortest way here</h2><ul id="path"></ul></div>
<script type="application/json" id="data">{data}</script>
<script>
const data = JSON.parse(document.getElementById("data").textContent);
const element = (id) => document.getElementById(id);
const button = (text, state) => {{
  const item = document.createElement("li"), made = document.createElement("button");
  made.textContent = text; made.onclick = () => show(state); item.append(made); return item;
}};
const rule = (from, to) => (data.moves.find((m) => m[0] === from && m[1] === to) || [0, 0, ""])[2];
function show(state) {{
  element("name").textContent = "state " + state;
  element("picture").innerHTML = data.states[state];
  element("labels").replaceChildren(...data.labels[state].map((label) => {{
    const made = document.createElement("span"); made.className = "label"; made.textContent = label; return made;
  }}));
  element("moves").replaceChildren(
    ...data.moves.filter((m) => m[0] === state).map((m) => button(m[2] + " \\u2192 " + m[1], m[1])));
  const path = [];
  for (let at = state; at !== 0; at = data.paths[at])
    path.unshift(button(rule(data.paths[at], at) + " \\u2192 " + at, at));
  element("path").replaceChildren(button("state 0", 0), ...path);
  for (const each of document.querySelectorAll(".s")) each.classList.toggle("on", +each.dataset.state === state);
  for (const each of document.querySelectorAll(".t")) each.classList.toggle("on", +each.dataset.from === state);
}}
for (const each of document.querySelectorAll(".s")) each.onclick = () => show(+each.dataset.state);
show(0);
</script></body></html>
"""
