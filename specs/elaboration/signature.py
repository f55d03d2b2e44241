"""The signature phase: kinds."""

from __future__ import annotations

from semantics.state.signature import Kind, Signature
from specs import syntax as s
from specs.elaboration.names import Names


def elaborate_signature(mission: s.Mission, names: Names) -> None:
    """Declare the kinds of a mission."""
    declared = [kind for section in mission.each(s.Signature) for kind in section.kinds]
    first = [kind for kind in declared if names.declare("kind", kind.name.text, kind.name)]
    names.signature = Signature.of(_kind(kind) for kind in first)
    for kind in declared:
        for other in (*kind.contains, *kind.carries):
            names.kind(other)


def _kind(kind: s.Kind) -> Kind:
    contains = frozenset(other.text for other in kind.contains)
    carries = frozenset(other.text for other in kind.carries)
    return Kind(kind.name.text, contains, carries, kind.driven, kind.passive)
