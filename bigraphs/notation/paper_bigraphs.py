"""Conversion of the paper's notation to bigraphs and rules, and back."""

from __future__ import annotations

from collections.abc import Sequence

from bigraphs.bigraph import Bigraph, Node, Place, assemble, children, sites_in
from bigraphs.errors import BigraphError, NotationError
from bigraphs.notation.paper import (
    NodeTerm,
    RegionTerm,
    RuleTerm,
    SiteTerm,
    format_regions,
    nodes,
    parse_regions,
    parse_rule,
    sites,
)
from bigraphs.rules import ReactionRule, rule
from bigraphs.signature import Signature, open_signature


def read_bigraph(text: str, signature: Signature | None = None) -> Bigraph:
    """Return the bigraph of `region || region`; links are outer names. Without a signature, controls are open.

    Raises:
        NotationError: For a syntax error or a node without a control.
        BigraphError: If the text describes no valid bigraph.
    """
    regions = parse_regions(text)
    _check_controls(regions, text, {})
    order = _site_order(regions)
    if list(order) != list(range(len(order))):
        odd = next(site for site in sites(regions) if site.index >= len(order))
        raise NotationError(
            "site", f"there are {len(order)} sites, and one is {odd}", text, odd.offset, hint="count from $0"
        )
    return _bigraph(
        regions, signature or open_signature(_controls(regions)), [s.index for s in sites(regions)]
    )


def read_rule(
    text: str,
    signature: Signature | None = None,
    *,
    name: str = "",
    node_variables: frozenset[str] = frozenset(),
    link_constants: frozenset[str] = frozenset(),
) -> ReactionRule:
    """Return the rule of `redex -> reactum`; a node of the redex needs no control in the reactum."""
    term = parse_rule(text)
    known = {node.name: node.control for node in nodes(term.redex) if node.name and node.control}
    _check_controls(term.redex, text, {})
    _check_controls(term.reactum, text, known)
    both = signature or open_signature([*_controls(term.redex), *_controls(term.reactum)])
    place = {index: rank for rank, index in enumerate(sorted(_site_order(term.redex)))}
    redex = _bigraph(term.redex, both, [place[site.index] for site in sites(term.redex)])
    written = [place[site.index] for site in sites(term.reactum)]
    reactum = _bigraph(term.reactum, both, range(len(written)), known)
    return rule(
        redex,
        reactum,
        tuple(written),
        name=name,
        node_variables=node_variables,
        link_constants=link_constants,
    )


def write_bigraph(bigraph: Bigraph) -> str:
    """Return the text of a bigraph; raises BigraphError for edges, idle names and shared places."""
    return format_regions(regions_of(bigraph))


def write_rule(rule: ReactionRule) -> str:
    """Return the text of a rule; `read_rule` reads it with the same signature, variables and constants."""
    redex = regions_of(rule.redex)
    reactum = regions_of(rule.reactum, rule.instantiation, idle=frozenset(rule.redex.outer_names))
    return str(RuleTerm(redex, reactum))


def regions_of(
    bigraph: Bigraph, numbers: Sequence[int] | None = None, *, idle: frozenset[str] = frozenset()
) -> tuple[RegionTerm, ...]:
    """Return the syntax of a bigraph; `numbers` renumbers its sites, and `idle` names may be missing from the text."""
    _check_writable(bigraph, idle)
    inside, sited = children(bigraph), sites_in(bigraph)
    done: dict[Place, RegionTerm] = {}
    for place in _bottom_up(inside, bigraph.regions):
        held = [SiteTerm(numbers[site] if numbers else site) for site in sited.get(place, ())]
        below: RegionTerm = (
            *(_node_term(bigraph.nodes[child], done[child]) for child in inside[place]),
            *held,
        )
        done[place] = below
    return tuple(done[~region] for region in range(bigraph.regions))


def _node_term(node: Node, below: RegionTerm) -> NodeTerm:
    return NodeTerm(node.name, node.control, tuple(map(str, node.ports)), below)


def _bottom_up(inside: dict[Place, list[int]], regions: int) -> list[Place]:
    order: list[Place] = [~region for region in range(regions)]
    for place in order:  # the list grows during the loop
        order.extend(inside[place])
    return order[::-1]


def _check_writable(bigraph: Bigraph, idle: frozenset[str]) -> None:
    written = {link for node in bigraph.nodes for link in node.ports}
    unsaid = sorted(set(bigraph.outer_names) - written - idle)
    if unsaid:
        raise BigraphError("notation", f"this notation cannot say the idle name '{unsaid[0]}'")
    if bigraph.edges or bigraph.inner_links:
        raise BigraphError(
            "notation", "this notation cannot say closed links or inner names", "write it as .big"
        )
    if any(len(parents) > 1 for parents in [*(node.parents for node in bigraph.nodes), *bigraph.sites]):
        raise BigraphError("notation", "this notation cannot say shared places", "write it as .big")
    if bigraph.regions == 0:
        raise BigraphError("notation", "this notation needs at least one region")


def _bigraph(
    regions: tuple[RegionTerm, ...],
    signature: Signature,
    numbers: Sequence[int],
    known: dict[str, str] | None = None,
) -> Bigraph:
    found: list[Node] = []
    parents: dict[int, Place] = {}
    numbered = iter(numbers)
    waiting = [
        (term, ~region) for region in reversed(range(len(regions))) for term in reversed(regions[region])
    ]
    while waiting:
        term, place = waiting.pop()
        if isinstance(term, SiteTerm):
            parents[next(numbered)] = place
            continue
        control = term.control or (known or {})[term.name or ""]
        found.append(Node(control, term.name, term.links, (place,)))
        waiting += [(child, len(found) - 1) for child in reversed(term.children)]
    return assemble(
        signature,
        found,
        regions=len(regions),
        sites=[(parents[site],) for site in range(len(parents))],
        outer_names=[link for node in found for link in node.ports if isinstance(link, str)],
    )


def _check_controls(regions: tuple[RegionTerm, ...], text: str, known: dict[str, str]) -> None:
    for node in nodes(regions):
        if node.control is None and node.name not in known:
            hint = f"write '{node.name}_' and its control"
            length = len(node.name or "")
            raise NotationError(
                "control", f"'{node.name}' has no control", text, node.offset, length=length, hint=hint
            )


def _controls(regions: tuple[RegionTerm, ...]) -> list[str]:
    return [node.control for node in nodes(regions) if node.control is not None]


def _site_order(regions: tuple[RegionTerm, ...]) -> list[int]:
    return sorted(site.index for site in sites(regions))
