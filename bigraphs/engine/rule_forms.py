"""Forms of rules: rules that differ only in their controls, such as thousands of instances of one rule, share one.

A canonical form depends only on the order of the controls. Symmetries depend only on their equality. So both are
computed once per form.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import replace
from typing import TypeAlias

from bigraphs.algebra import lean
from bigraphs.bigraph import Bigraph, Node, relabelled
from bigraphs.canonical_form import canonical
from bigraphs.engine.automorphisms import Automorphism, symmetries
from bigraphs.engine.patterns import CompiledPattern
from bigraphs.system import Rule

_Rank: TypeAlias = Callable[[str], Hashable]


class Forms:
    """The forms of one system's rules, with their cached results."""

    def __init__(self) -> None:
        self._tidy: dict[Hashable, tuple[Bigraph, list[str]]] = {}
        self._symmetries: dict[Hashable, tuple[Automorphism, ...]] = {}

    def tidy(self, rule: Rule) -> Rule:
        """Return a rule with both sides in canonical form, without idle edges."""
        return replace(rule, redex=self._side(rule.redex), reactum=self._side(rule.reactum))

    def _side(self, side: Bigraph) -> Bigraph:
        controls = sorted({node.control for node in side.nodes})
        form = _form(side, {control: rank for rank, control in enumerate(controls)}.__getitem__)
        found = self._tidy.get(form)
        if found is None:
            found = self._tidy[form] = canonical(lean(side)), controls
        first, others = found
        return relabelled(first, dict(zip(others, controls, strict=True)), side.signature)

    def symmetries(self, rule: Rule, pattern: CompiledPattern) -> tuple[Automorphism, ...]:
        """Return the symmetries of a rule with the redex `pattern`."""
        ranks: dict[str, int] = {}

        def rank(control: str) -> int:
            return ranks.setdefault(control, len(ranks))

        form = _form(rule.redex, rank), _form(rule.reactum, rank), rule.instantiation
        found = self._symmetries.get(form)
        if found is None:
            found = self._symmetries[form] = symmetries(rule, pattern)
        return found


def _form(side: Bigraph, rank: _Rank) -> Hashable:
    """Return a side in which ranks replace the controls; it keeps whether their ports are ordered."""

    def row(node: Node) -> Hashable:
        ordered = len(node.ports) > 1 and side.signature[node.control].ordered
        return rank(node.control), ordered, node.name, node.ports, node.parents

    links = side.edges, side.inner_links, side.outer_names
    return tuple(map(row, side.nodes)), side.regions, side.sites, links
