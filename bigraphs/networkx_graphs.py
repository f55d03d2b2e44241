"""Bigraphs as networkx graphs, for paths, components and other layouts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bigraphs.bigraph import Bigraph, Place
from bigraphs.labels import link_label, node_labels

if TYPE_CHECKING:
    import networkx as nx


def to_networkx(bigraph: Bigraph) -> nx.MultiDiGraph[Any]:
    """Return places and links as one graph.

    Vertices are pairs: `("region", 0)`, `("node", "uav0")`, `("site", 0)`, `("link", "net")`, `("inner", "x")`. Each
    has a `kind`; nodes also have `control` and `name`, links `closed`. Edges have a `relation`: `contains` from parent
    to child, `linked` from a node (with its `port`) or an inner name to its link.
    """
    import networkx as nx  # noqa: PLC0415 - rarely needed and slow to import

    graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph()
    _add_places(graph, bigraph)
    _add_links(graph, bigraph)
    return graph


def _add_places(graph: nx.MultiDiGraph[Any], bigraph: Bigraph) -> None:
    labels = node_labels(bigraph)

    def vertex(place: Place) -> tuple[str, int | str]:
        return ("node", labels[place]) if place >= 0 else ("region", ~place)

    for region in range(bigraph.regions):
        graph.add_node(("region", region), kind="region")
    for number, node in enumerate(bigraph.nodes):
        graph.add_node(vertex(number), kind="node", control=node.control, name=node.name)
    for site in range(len(bigraph.sites)):
        graph.add_node(("site", site), kind="site")
    for number, node in enumerate(bigraph.nodes):
        graph.add_edges_from(((vertex(p), vertex(number)) for p in node.parents), relation="contains")
    for site, parents in enumerate(bigraph.sites):
        graph.add_edges_from(((vertex(place), ("site", site)) for place in parents), relation="contains")


def _add_links(graph: nx.MultiDiGraph[Any], bigraph: Bigraph) -> None:
    labels = node_labels(bigraph)
    for link in (*range(bigraph.edges), *bigraph.outer_names):
        graph.add_node(("link", link_label(link)), kind="link", closed=isinstance(link, int))
    for number, node in enumerate(bigraph.nodes):
        for port, link in enumerate(node.ports):
            graph.add_edge(("node", labels[number]), ("link", link_label(link)), relation="linked", port=port)
    for name, link in bigraph.inner_links:
        graph.add_node(("inner", name), kind="inner")
        graph.add_edge(("inner", name), ("link", link_label(link)), relation="linked")
