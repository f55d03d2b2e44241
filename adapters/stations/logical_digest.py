"""The digest of L, by which stations compare what they believe."""

from __future__ import annotations

from hashlib import sha256

from semantics.state.logical_model import LogicalModel


def logical_digest(logical: LogicalModel) -> str:
    """Return a digest of the nodes of L with their parents and links; it is the same in each process."""
    nodes = [(name, logical.parent(name), sorted(logical.links(name))) for name in sorted(logical.nodes())]
    return sha256(repr(nodes).encode()).hexdigest()[:32]
