"""Labels of nodes, links and places, the same in every representation of a bigraph."""

from __future__ import annotations

import re
from collections import Counter

from bigraphs.bigraph import Bigraph, Link


def node_labels(bigraph: Bigraph) -> tuple[str, ...]:
    """Return one distinct label per node: its name, else its control, with a number if several share it."""
    kinds = Counter(node.control for node in bigraph.nodes if node.name is None)
    taken = {node.name for node in bigraph.nodes}
    seen: Counter[str] = Counter()
    found: list[str] = []
    for node in bigraph.nodes:
        if node.name is not None:
            found.append(node.name)
            continue
        seen[node.control] += 1
        plain = kinds[node.control] == 1 and node.control not in taken
        label = node.control if plain else f"{node.control}#{seen[node.control]}"
        while label in taken:
            label += "'"
        found.append(label)
    return tuple(found)


def natural(label: str) -> tuple[tuple[bool, int, str], ...]:
    """Return the key of the natural order, in which numbers count as such.

    >>> sorted(["uav10", "uav2", "boat"], key=natural)
    ['boat', 'uav2', 'uav10']
    """
    parts = re.findall(r"[0-9]+|[^0-9]+", label)
    return tuple((not part.isdigit(), int(part) if part.isdigit() else 0, part) for part in parts)


def link_label(link: Link) -> str:
    """Return an outer name, or `/n` for edge n."""
    return link if isinstance(link, str) else f"/{link}"
