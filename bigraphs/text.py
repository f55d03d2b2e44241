"""Bigraphs as text: an indented tree of places, then the links."""

from __future__ import annotations

from collections.abc import Iterator

from bigraphs.bigraph import Bigraph, Place, children, points, sites_in
from bigraphs.node_labels import link_label, natural, node_labels


def draw_text(bigraph: Bigraph) -> str:
    """Return the places as a tree and the links as a list.

    A node with several parents is drawn in full in the first; in the others an arrow and its label stand for it.

    >>> from bigraphs.relational_bigraphs import from_relations
    >>> print(draw_text(from_relations({"u": "UAV", "a": "Area"}, {"u": "a"}, {"net": ["u"]})))
    region 0
    └─ a: Area
       └─ u: UAV [net]
    net ─ u
    """
    return "\n".join([*_places(bigraph), *_links(bigraph)])


def _places(bigraph: Bigraph) -> Iterator[str]:
    labels, inside, sited = node_labels(bigraph), children(bigraph), sites_in(bigraph)
    drawn: set[int] = set()
    waiting: list[tuple[Place, str, str]] = [(~region, "", "") for region in reversed(range(bigraph.regions))]
    while waiting:
        place, branch, indent = waiting.pop()
        if place in drawn:
            yield f"{branch}↑ {labels[place]}"
            continue
        yield f"region {~place}" if place < 0 else branch + _node(bigraph, place, labels[place])
        drawn.add(place)
        for site in sited.get(place, ()):
            last = not inside[place] and site == sited[place][-1]
            yield f"{indent}{'└─' if last else '├─'} ${site}"
        within = sorted(inside[place], key=lambda number: natural(labels[number]))
        for child in reversed(within):
            last = child == within[-1]
            waiting.append((child, indent + ("└─ " if last else "├─ "), indent + ("   " if last else "│  ")))


def _node(bigraph: Bigraph, number: int, label: str) -> str:
    node = bigraph.nodes[number]
    kind = f": {node.control}" if node.name is not None else ""
    ports = f" [{', '.join(map(link_label, node.ports))}]" if node.ports else ""
    return label + kind + ports


def _links(bigraph: Bigraph) -> Iterator[str]:
    labels = node_labels(bigraph)
    inner: dict[int | str, list[str]] = {}
    for name, link in bigraph.inner_links:
        inner.setdefault(link, []).append(f"{name} (inner)")
    for link, on in points(bigraph).items():
        ends = sorted((labels[number] for number, _ in on), key=natural) + inner.get(link, [])
        yield f"{link_label(link)} ─ {', '.join(ends) or '(idle)'}"
