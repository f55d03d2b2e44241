"""Transition systems as plain data for JSON."""

from __future__ import annotations

from typing import Any

from bigraphs.bigraph import Bigraph
from bigraphs.node_labels import link_label
from bigraphs.transitions import TransitionSystem


def to_json(system: TransitionSystem) -> dict[str, Any]:
    """Return states, transitions and completeness as dictionaries, lists, strings and numbers."""
    return {
        "kind": system.kind.value,
        "complete": system.complete,
        "reason": system.reason,
        "occurrences": system.occurrences,
        "predicates": [predicate.label for predicate in system.system.predicates],
        "states": [
            {"labels": list(system.labels_of(state)), **bigraph_json(system.state(state))}
            for state in range(len(system))
        ],
        "transitions": [
            {
                "from": each.source,
                "to": each.target,
                "rules": list(each.rules),
                "occurrences": each.occurrences,
                "weight": each.weight,
                "action": each.action,
            }
            for each in system.transitions()
        ],
    }


def bigraph_json(bigraph: Bigraph) -> dict[str, Any]:
    """Return a ground bigraph as plain data; a parent is a node number or `region 0`."""
    return {
        "regions": bigraph.regions,
        "names": list(bigraph.outer_names),
        "nodes": [
            {
                "control": node.control,
                "name": node.name,
                "parents": [place if place >= 0 else f"region {~place}" for place in node.parents],
                "links": [link_label(link) for link in node.ports],
            }
            for node in bigraph.nodes
        ],
    }
