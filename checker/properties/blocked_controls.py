"""The missing relations of a control that can't be served: those of its redex in L, those of its reactum in P."""

from collections.abc import Iterator

from semantics.behaviours.reaction_rules import LinkTerm, LinkVariable, matches, moved
from semantics.control import Obstacle
from semantics.state.configuration import Configuration
from semantics.state.requests import CTR, FLY
from semantics.state.signature import REGION, Name


def lacking(c: Configuration, request: CTR | FLY, by: Obstacle) -> tuple[str, ...]:
    """Return in words the missing relations of a control, among those it names."""
    if by is Obstacle.UNREALISABLE:
        return tuple(dict.fromkeys(_unrealised(c, request)))
    return tuple(_unmatched(c, request)) if by is Obstacle.UNMATCHED else ()


def _unmatched(c: Configuration, request: CTR | FLY) -> Iterator[str]:
    """Yield each relation of a redex that L does not have."""
    redex, logical = request.reaction.redex, c.structure.logical
    named = [node for node in redex.nodes if isinstance(node, str)]
    unknown = [node for node in named if node not in logical]
    yield from (f"{node} is unknown" for node in unknown)
    for node, place in redex.parents:
        if isinstance(node, str) and isinstance(place, str) and node not in unknown:
            parent = logical.parent(node)
            if parent != place:
                yield f"{node} is not in {place}: it is believed in {_place(parent)}"
    for link in dict.fromkeys(link for link, _ in redex.links):
        nodes = [node for other, node in redex.links if other == link and isinstance(node, str)]
        yield from _unlinked(c, link, [node for node in nodes if node not in unknown])
    for node in redex.closed:
        if isinstance(node, str) and node not in unknown:
            others = [each for each in logical.children(node) if (each, node) not in redex.parents]
            yield from (f"{each} is in {node}, too" for each in others)
    host = c.alpha.host(request.agent)
    if host not in redex.nodes and len(named) == len(redex.nodes):
        yield f"it does not name {host}, on which {request.agent} is hosted"


def _place(parent: Name | None) -> str:
    return "no place" if parent in (None, REGION) else str(parent)


def _unlinked(c: Configuration, link: LinkTerm, nodes: list[Name]) -> Iterator[str]:
    """Yield the nodes that are not on a link, or that share none of a variable's possible links."""
    on = {node: [each for each in c.structure.logical.links(node) if _fits(link, each)] for node in nodes}
    shared = [each for links in on.values() for each in links if all(each in other for other in on.values())]
    if shared or not on:
        return
    for node, links in on.items():
        others = sorted({each for other, there in on.items() if other != node for each in there})
        if not links or isinstance(link, str):
            wanted = [link] if isinstance(link, str) else others
            yield f"{node} is not on {' or '.join(wanted) or _any(link)}"
    if all(on.values()) and not isinstance(link, str):
        words = ", ".join(f"{node} is on {' and '.join(links)}" for node, links in on.items())
        yield f"{words}: on none together"


def _any(link: LinkTerm) -> str:
    kind = link.kind if isinstance(link, LinkVariable) else None
    return "any channel" if kind is None else f"any channel of kind {kind}"


def _fits(link: LinkTerm, channel: Name) -> bool:
    if isinstance(link, str):
        return channel == link
    kind = channel.partition(":")[0] if ":" in channel else None
    return (link.kind is None or kind == link.kind) and (link.but is None or kind != link.but)


def _unrealised(c: Configuration, request: CTR | FLY) -> Iterator[str]:
    """Yield each relation of a reactum that no physical change can make true."""
    physical, setting = c.structure.physical, c.setting
    found = (
        [request.match]
        if isinstance(request, FLY)
        else list(matches(request.reaction.redex, c.structure.logical))
    )
    for match in found:
        for node, place in moved(request.reaction, match):
            if node not in physical or (place != REGION and place not in physical):
                yield f"{node if node not in physical else place} is gone"
            elif place == REGION:
                yield f"{node} would be in no place: a vehicle needs a place to go to"
            elif not setting.signature[setting.kind(place)].may_contain(setting.kind(node)):
                inside, holder = setting.kind(node), setting.kind(place)
                yield f"no {holder} may contain a {inside}: the signature lacks 'kind {holder} contains {inside}'"
            elif not setting.signature[setting.kind(node)].driven:
                by = physical.carrier(node)
                yield f"nothing drives {node}" + (
                    f", and {by}, which carries it, is not in {place}" if by else ""
                )
            else:
                yield f"{place} has no position for {node} outside its smaller places"
