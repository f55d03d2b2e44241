"""Bigraphs from relations: containment, and the nodes on each link."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from bigraphs.bigraph import Bigraph, Node, assemble
from bigraphs.errors import BigraphError
from bigraphs.signature import Signature, open_signature


def from_relations(
    nodes: Mapping[str, str],
    parent: Mapping[str, str | None],
    links: Mapping[str, Iterable[str]],
    signature: Signature | None = None,
) -> Bigraph:
    """Return one region of named nodes.

    `nodes` maps each node to its control. `parent` maps a node to its parent; a node with None or without an entry is
    in the region. `links` maps each outer name to its nodes. Without a signature, controls are open: any arity,
    unordered ports.

    Raises:
        BigraphError: For a name that `nodes` does not have, and for a cycle.
    """
    order = sorted(nodes)
    number = {name: place for place, name in enumerate(order)}
    _check_known(number, parent, "has a parent")
    _check_known(number, (within for within in parent.values() if within is not None), "is a parent")
    ports: dict[str, list[str]] = {name: [] for name in order}
    for link in sorted(links):
        members = sorted(set(links[link]))
        _check_known(number, members, f"is on link '{link}'")
        for member in members:
            ports[member].append(link)
    return assemble(
        signature or open_signature(nodes.values()),
        [_node(name, nodes[name], ports[name], parent.get(name), number) for name in order],
        outer_names=links,
    )


def _node(name: str, control: str, ports: list[str], within: str | None, number: Mapping[str, int]) -> Node:
    return Node(control, name, tuple(ports), (~0 if within is None else number[within],))


def _check_known(number: Mapping[str, int], names: Iterable[str], how: str) -> None:
    for name in names:
        if name not in number:
            raise BigraphError("name", f"'{name}' {how} but is no node", "give it a control")
