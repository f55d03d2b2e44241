"""Apply a match: the reactum replaces the redex in the same context."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from bigraphs.algebra import compose, lean, tensor
from bigraphs.bigraph import Bigraph, assemble
from bigraphs.decomposition import take_apart
from bigraphs.instantiation import instantiate
from bigraphs.matching import Match
from bigraphs.rules import ReactionRule, matches


def rewrite(rule: ReactionRule, match: Match) -> Bigraph:
    """Return the target with the reactum in place of the redex, without idle edges, as in abstract bigraphs.

    Raises:
        BigraphError: If the rule would copy a named node, or create one with a name that exists.
    """
    parts = take_apart(match)
    parameter = instantiate(parts.parameter, rule.instantiation, len(rule.redex.sites))
    reactum = _with_matched_names(rule, match)
    return lean(compose(parts.context, compose(tensor(reactum, parts.beside), parameter)))


def successors(rule: ReactionRule, target: Bigraph) -> Iterator[tuple[Match, Bigraph]]:
    """Yield every occurrence with the result of the rule there."""
    return ((match, rewrite(rule, match)) for match in matches(rule, target))


def _with_matched_names(rule: ReactionRule, match: Match) -> Bigraph:
    """Return the reactum in which each variable has the name of its matched node, if that has one."""
    found: dict[str | None, str | None] = {
        node.name: match.target.nodes[image].name
        for node, image in zip(rule.redex.nodes, match.nodes, strict=True)
        if node.name in rule.node_variables
    }
    reactum = rule.reactum
    nodes = [replace(node, name=found.get(node.name, node.name)) for node in reactum.nodes]
    return assemble(
        reactum.signature,
        nodes,
        regions=reactum.regions,
        sites=reactum.sites,
        edges=reactum.edges,
        outer_names=reactum.outer_names,
    )
