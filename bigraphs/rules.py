"""Reaction rules: redex, reactum, and an instantiation of the sites."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from bigraphs.algebra import parallel, substitution
from bigraphs.bigraph import Bigraph
from bigraphs.errors import BigraphError, counted
from bigraphs.matching import Match, find_matches


@dataclass(frozen=True, slots=True)
class ReactionRule:
    """A parametric reaction rule; build it with `rule`.

    Site `i` of the reactum receives the content of site `instantiation[i]` of the redex. A named redex node matches
    only the node of the same name, unless its name is in `node_variables`. A variable matches any node, and its name in
    the reactum refers to that node. An anonymous node matches any node; the reactum replaces it, name included. An
    outer name of the redex matches any link, unless it is in `link_constants`.
    """

    redex: Bigraph
    reactum: Bigraph
    instantiation: tuple[int, ...]
    name: str = ""
    node_variables: frozenset[str] = frozenset()
    link_constants: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        _ = self.redex.signature | self.reactum.signature
        if self.redex.outer != self.reactum.outer:
            found = f"the redex shows {self.redex.outer}, the reactum {self.reactum.outer}"
            raise BigraphError(
                "rule", found, "give both the same regions, and every name of the reactum to the redex"
            )
        if self.redex.inner_links or self.reactum.inner_links:
            raise BigraphError("rule", "a rule has sites, but no inner names")
        self._check_instantiation()

    def _check_instantiation(self) -> None:
        given, wanted = len(self.instantiation), len(self.reactum.sites)
        if given != wanted:
            hint = "name a site of the redex for each site of the reactum"
            raise BigraphError("rule", f"the reactum has {wanted} sites, {given} are instantiated", hint)
        for site in self.instantiation:
            if not 0 <= site < len(self.redex.sites):
                raise BigraphError("rule", f"the redex has no site {site}")


def rule(
    redex: Bigraph,
    reactum: Bigraph,
    instantiation: tuple[int, ...] | None = None,
    *,
    name: str = "",
    node_variables: frozenset[str] = frozenset(),
    link_constants: frozenset[str] = frozenset(),
) -> ReactionRule:
    """Return a rule; outer names missing from the reactum are added as idle, and sites keep their order by default."""
    for missing in sorted(set(redex.outer_names) - set(reactum.outer_names)):
        reactum = parallel(reactum, substitution(missing, ()))
    if instantiation is None and len(redex.sites) != len(reactum.sites):
        message = f"the redex has {counted(len(redex.sites), 'site')}, the reactum {len(reactum.sites)}"
        raise BigraphError("rule", message, "give the content of the reactum's sites by an instantiation map")
    order = tuple(range(len(redex.sites))) if instantiation is None else instantiation
    return ReactionRule(redex, reactum, order, name, node_variables, link_constants)


def matches(rule: ReactionRule, target: Bigraph) -> Iterator[Match]:
    """Yield every occurrence of the rule's redex in a ground bigraph."""
    return find_matches(
        rule.redex, target, node_variables=rule.node_variables, link_constants=rule.link_constants
    )
