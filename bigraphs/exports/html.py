"""A self-contained page of the state space; a click on a state shows its bigraph.

The page holds states and transitions as data, and its script draws them: a prepared picture of each state would take a
hundred times the time and the space.
"""

from __future__ import annotations

import base64
import hashlib
import json
from html import escape
from importlib.resources import files as resources
from typing import Any, Final

from bigraphs.bigraph import Bigraph
from bigraphs.drawing import KINDS, LINKS
from bigraphs.errors import counted
from bigraphs.exports.dot import describe
from bigraphs.exports.state_graph import RADIUS, places_of
from bigraphs.node_labels import link_label
from bigraphs.transitions import TransitionSystem

MOST_STATES: Final = 2_000
"""The largest number of states on a page; more are not readable."""


def to_html(system: TransitionSystem, title: str) -> str:
    """Return a page; for a larger system it has only the first states and a note about it."""
    shown = first_states(system, MOST_STATES)
    data = json.dumps(_facts(shown), ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
    script = _resource("states.js")
    return _PAGE.format(
        title=escape(title),
        summary=escape(_summary(system, len(shown))),
        style=_resource("states.css"),
        keys="".join(f'<span class="key {look}">{_KEY}{words}</span>' for look, words in _KEYS),
        allowed=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
        script=script,
        data=data,
    )


def _facts(shown: TransitionSystem) -> dict[str, Any]:
    """Return the data for the page's script; equal nodes of all states are written once."""
    nodes: dict[str, int] = {}
    rules: dict[str, int] = {}
    bigraphs = [shown.state(state) for state in range(len(shown))]
    states = [[nodes.setdefault(node, len(nodes)) for node in _nodes(each)] for each in bigraphs]
    moves = [
        [each.source, each.target, rules.setdefault(describe(shown, each), len(rules))]
        for each in shown.transitions()
    ]
    controls = sorted(control.name for control in shown.system.signature.controls)
    return {
        "states": states,
        "nodes": [json.loads(node) for node in nodes],
        "regions": shown.world.regions,
        "labels": [list(shown.labels_of(state)) for state in range(len(shown))],
        "moves": moves,
        "rules": list(rules),
        "paths": list(shown.found_from),
        "places": [[round(x), round(y)] for x, y in places_of(shown)],
        "radius": RADIUS,
        "expanded": shown.expanded,
        "kinds": {control: KINDS[rank % len(KINDS)] for rank, control in enumerate(controls)},
        "colours": LINKS,
    }


def _nodes(bigraph: Bigraph) -> list[str]:
    """Return each node as JSON: its control, name, parents and links."""
    return [
        json.dumps([node.control, node.name, node.parents, [link_label(link) for link in node.ports]])
        for node in bigraph.nodes
    ]


def _resource(name: str) -> str:
    return (resources(__package__) / name).read_text(encoding="utf-8")


def first_states(system: TransitionSystem, most: int) -> TransitionSystem:
    """Return the first states of a system, with the transitions between them."""
    if len(system) <= most:
        return system
    return system.beginning(most)


def _summary(system: TransitionSystem, shown: int) -> str:
    parts = [counted(len(system), "state"), counted(len(system.targets), "transition")]
    parts.append("complete" if system.complete else f"incomplete: {system.reason}")
    if shown < len(system):
        parts.append(f"shown: the first {counted(shown, 'state')}")
    return ", ".join(parts)


_KEY: Final = '<svg viewBox="0 0 20 14" aria-hidden="true"><circle cx="10" cy="7" r="6"/></svg>'
_KEYS: Final = (
    ("first", "the first state"),
    ("holds", "a predicate holds"),
    ("end", "no transition"),
    ("open", "not explored"),
    ("on", "chosen: its arrows, and dashed those to it"),
)

_PAGE: Final = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; \
script-src 'sha256-{allowed}'; base-uri 'none'; form-action 'none'">
<title>{title}</title>
<style>{style}</style></head><body>
<header><h1>{title}</h1><span>{summary}</span></header>
<main id="graph"><svg tabindex="0" role="application" aria-label="the states and transitions: drag, or use the arrow \
keys, plus, minus and 0"></svg>
<div id="tools"><button type="button" id="start">state 0</button><button type="button" id="whole">whole</button>
<button type="button" id="in" aria-label="larger">+</button>
<button type="button" id="out" aria-label="smaller">−</button>
<input id="find" type="number" min="0" placeholder="go to state" aria-label="go to state"></div></main>
<aside id="side" aria-label="One state"><h2 id="name" aria-live="polite"></h2><div id="labels"></div>
<div id="picture" role="img" aria-label="the bigraph of the state"></div>
<h2>transitions</h2><ul id="moves"></ul><h2>a shortest way here</h2><ul id="path"></ul></aside>
<footer>{keys}</footer>
<script type="application/json" id="data">{data}</script>
<script>{script}</script></body></html>
"""
