"""States as lines of text: every state that can be explored can be printed."""

from dataclasses import replace
from typing import Final

from bigraphs import Bigraph, BigraphError
from bigraphs.notation import write_big
from bigraphs.signature import Signature
from physical.wordings import counted

LONG: Final = 300
"""The number of characters beyond which a state is replaced by its size, unless it is the requested output."""


def state_text(bigraph: Bigraph) -> str:
    """Return a state in the notation of `.big`, with named nodes as in `.bgm` files: `u0_UAV`.

    A state that nests too deeply for the notation gives its size.
    """
    named = {f"{node.name}_{node.control}": node for node in bigraph.nodes if node.name is not None}
    controls = [replace(bigraph.signature[node.control], name=label) for label, node in named.items()]
    nodes = [
        node if node.name is None else replace(node, control=f"{node.name}_{node.control}", name=None)
        for node in bigraph.nodes
    ]
    signature = Signature((*bigraph.signature.controls, *controls))
    try:
        return write_big(replace(bigraph, signature=signature, nodes=tuple(nodes)))
    except BigraphError:
        return _size(bigraph)


def state_line(bigraph: Bigraph) -> str:
    """Return a state in its notation if that is short, else its size."""
    written = state_text(bigraph)
    return written if len(written) <= LONG else f"{_size(bigraph)}; 'bigactors big show' prints it"


def _size(bigraph: Bigraph) -> str:
    kinds = len({node.control for node in bigraph.nodes})
    nodes = f"{counted(len(bigraph.nodes), 'node')} of {counted(kinds, 'control')}"
    links = f"{counted(bigraph.edges, 'edge')}, {counted(len(bigraph.outer_names), 'name')}"
    return f"{nodes} in {counted(bigraph.regions, 'region')}, {links}"
