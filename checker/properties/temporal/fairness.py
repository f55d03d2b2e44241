"""Translate a mission's fairness to sets that a fair run meets infinitely often."""

from collections.abc import Collection, Iterable, Iterator

import numpy as np

from checker.engines.graph import Bools, Graph
from checker.properties.temporal.components import Conditions, Streett
from semantics.behaviours.reaction_rules import moved
from semantics.properties.temporal import SERVES, Fairness, Steps
from semantics.state.configuration import Label
from semantics.state.requests import FLY
from semantics.state.signature import Name

EACH_RULE_AND_REQUEST = (
    Fairness(False, Steps(), ("agent", "rule"), "rules"),
    Fairness(False, Steps(SERVES), ("label",), "requests"),
)
"""The assumptions of progress: weak fairness of each bigActor's rules, and of the serving of each request."""


def conditions_of(declared: Iterable[Fairness], graph: Graph, arriving: Collection[Name] = ()) -> Conditions:
    """Return the conditions of a total graph.

    Weak fairness: infinitely often the steps are taken, or not enabled. Strong fairness: taken infinitely often, if
    enabled infinitely often.
    """
    recurrent: list[Bools] = []
    strong: list[Streett] = []
    for fairness in declared:
        for labels in classes(fairness, graph.labels, arriving):
            taken = graph.taken(labels)
            enabled = graph.enabled(taken)
            if fairness.strong:
                strong.append(Streett(enabled, taken))
            else:
                recurrent.append(taken | ~enabled[graph.sources])
    return Conditions(tuple(recurrent), tuple(strong))


def classes(
    fairness: Fairness, labels: tuple[Label, ...], arriving: Collection[Name] = ()
) -> Iterator[Bools]:
    """Yield the labels of each set of steps that a fairness assumption promises separately.

    The end of a flight is included only if the mission promises its arrival, or the assumption names the rule `commit`.
    """
    said = fairness.steps.rules == ("commit",)
    members: dict[tuple[object, ...], list[int]] = {}
    for number, label in enumerate(labels):
        if fairness.steps.has(label) and (said or arrives(label, arriving)):
            key = tuple(label.missing() if word == "label" else getattr(label, word) for word in fairness.per)
            members.setdefault(key, []).append(number)
    for numbers in members.values():
        marked = np.zeros(len(labels), dtype=np.bool_)
        marked[numbers] = True
        yield marked


def optional(labels: tuple[Label, ...], arriving: Collection[Name]) -> Bools:
    """Return for each label whether its steps need never happen: the world's, and ends of flights without a promise."""
    found = (label.agent is None or not arrives(label, arriving) for label in labels)
    return np.fromiter(found, dtype=np.bool_, count=len(labels))


def arrives(label: Label, arriving: Collection[Name]) -> bool:
    """Return whether a step is no end of a flight, or the end of one that the mission promises."""
    if label.rule != "commit" or not isinstance(label.about, FLY):
        return True
    return all(node in arriving for node, _ in moved(label.about.reaction, label.about.match))
