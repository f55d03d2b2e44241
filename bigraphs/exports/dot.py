"""Transition systems for Graphviz."""

from __future__ import annotations

from collections.abc import Iterator

from bigraphs.exports.markov import number
from bigraphs.system import SystemKind
from bigraphs.transitions import Transition, TransitionSystem


def to_dot(system: TransitionSystem) -> str:
    """Return states with labels, and transitions with rules and weights, in the dot language."""
    return "".join(f"{line}\n" for line in _lines(system))


def _lines(system: TransitionSystem) -> Iterator[str]:
    yield "digraph transitions {"
    yield '  node [shape=box, style=rounded, fontname="sans-serif"];'
    yield '  edge [fontname="sans-serif", fontsize=10];'
    for state in range(len(system)):
        label = "\n".join([str(state), *system.labels_of(state)])
        look = ", penwidth=2" if state == 0 else ", style=dashed" if state >= system.expanded else ""
        yield f"  {state} [label={_quoted(label)}{look}];"
    for each in system.transitions():
        yield f"  {each.source} -> {each.target} [label={_quoted(describe(system, each))}];"
    yield "}"


def describe(system: TransitionSystem, transition: Transition) -> str:
    """Return the rules of a transition, with its action and weight if it has them."""
    rules = ", ".join(transition.rules)
    action = f"{transition.action}: " if transition.action is not None else ""
    weight = "" if system.kind is SystemKind.BRS else f" {number(round(transition.weight, 6))}"
    return f"{action}{rules}{weight}"


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
