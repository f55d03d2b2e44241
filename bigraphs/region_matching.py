"""The second half of matching: the places of a redex's regions and sites, once its nodes are placed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations, product
from typing import TypeAlias

from bigraphs.bigraph import Bigraph, Place, children, sites_in

Places: TypeAlias = frozenset[Place]
Placed: TypeAlias = tuple[tuple[tuple[Place, ...], ...], tuple[tuple[int, ...], ...]]


def placements(redex: Bigraph, target: Bigraph, images: Sequence[int]) -> Iterator[Placed]:
    """Yield every combination of places for the regions and topmost nodes for the sites.

    There is at most one, unless two sites share their places, a site lies in a region, or places are shared.
    """
    matched = frozenset(images)
    inside = children(target)
    below = _below(inside, {child for image in images for child in inside[image]} - matched)
    if not matched.isdisjoint(below):
        return
    for regions in _regions(redex, target, images):
        taken = frozenset().union(*regions)
        if taken.isdisjoint(below) and _all_active(target, taken):
            for sites in _sites(redex, target, images, regions, below):
                yield tuple(tuple(sorted(places)) for places in regions), sites


def _below(inside: Mapping[Place, Iterable[int]], tops: Iterable[int]) -> frozenset[int]:
    """Return these nodes and all their descendants."""
    found = set(tops)
    waiting = list(found)
    while waiting:
        fresh = set(inside[waiting.pop()]) - found
        found |= fresh
        waiting.extend(fresh)
    return frozenset(found)


def _regions(redex: Bigraph, target: Bigraph, images: Sequence[int]) -> Iterator[tuple[Places, ...]]:
    """Yield the places of the regions: the unmatched parents of their top nodes."""
    outside = {
        number: frozenset(target.nodes[image].parents) - frozenset(images)
        for number, image in enumerate(images)
        if any(parent < 0 for parent in redex.nodes[number].parents)
    }
    choices = [_region_choices(redex, ~region, outside) for region in range(redex.regions)]
    for regions in product(*choices):
        if all(_union(redex.nodes[number].parents, regions) == found for number, found in outside.items()):
            yield regions


def _region_choices(redex: Bigraph, region: Place, outside: Mapping[int, Places]) -> list[Places]:
    """Return the possible place sets of a region.

    A node with this region alone determines its places. Otherwise each subset of the common parents of its nodes is
    possible, even the empty one: a region whose nodes all have other parents may have no place.
    """
    tops = [number for number in outside if region in redex.nodes[number].parents]
    alone = next((n for n in tops if sum(parent < 0 for parent in redex.nodes[n].parents) == 1), None)
    if alone is not None:
        return [outside[alone]]
    common = sorted(frozenset.intersection(*(outside[number] for number in tops)))
    return [frozenset(part) for size in range(len(common) + 1) for part in combinations(common, size)]


def _union(parents: Iterable[Place], regions: Sequence[Places]) -> Places:
    return frozenset().union(*(regions[~parent] for parent in parents if parent < 0))


def _all_active(target: Bigraph, places: Iterable[Place]) -> bool:
    seen: set[Place] = set()
    waiting = list(places)
    while waiting:
        place = waiting.pop()
        if place >= 0 and place not in seen:
            seen.add(place)
            if target.signature[target.nodes[place].control].status != "active":
                return False
            waiting.extend(target.nodes[place].parents)
    return True


def _sites(
    redex: Bigraph, target: Bigraph, images: Sequence[int], regions: Sequence[Places], below: Places
) -> Iterator[tuple[tuple[int, ...], ...]]:
    """Yield the topmost nodes of each site; the sites of a node cover its matched parents, and none is redundant."""
    matched, inside = frozenset(images), children(target)
    places = [
        frozenset(images[parent] for parent in parents if parent >= 0) | _union(parents, regions)
        for parents in redex.sites
    ]
    forced = sorted(number for number in below if not matched.isdisjoint(target.nodes[number].parents))
    barred = matched.union(*regions)
    free = sorted(_free(redex, inside, regions, barred) - below)
    options = [_covers(target.nodes[number].parents, places, matched) for number in forced]
    options += [[(), *_covers(target.nodes[number].parents, places, matched)] for number in free]
    for chosen in product(*options):
        sites: list[list[int]] = [[] for _ in places]
        for number, cover in zip([*forced, *free], chosen, strict=True):
            for site in cover:
                sites[site].append(number)
        yield tuple(tuple(sorted(tops)) for tops in sites)


def _free(
    redex: Bigraph, inside: Mapping[Place, Sequence[int]], regions: Sequence[Places], barred: Places
) -> set[int]:
    """Return the nodes that a site in a region may hold: neighbours without a matched node or a region inside them."""
    places = frozenset().union(*(regions[~parent] for parent in sites_in(redex) if parent < 0))
    near = {number for place in places for number in inside[place]}
    return {number for number in near if barred.isdisjoint(_below(inside, [number]))}


def _covers(parents: Iterable[Place], places: Sequence[Places], matched: Places) -> list[tuple[int, ...]]:
    """Return each set of sites for a node: inside its parents, covering all matched ones, without a redundant site."""
    around = frozenset(parents)
    usable = [site for site, found in enumerate(places) if found <= around]
    return [
        sites
        for size in range(1, len(around) + 1)
        for sites in combinations(usable, size)
        if _covered(sites, places, around & matched) and not _superfluous(sites, places)
    ]


def _covered(sites: Iterable[int], places: Sequence[Places], needed: Places) -> bool:
    return needed <= frozenset().union(*(places[site] for site in sites))


def _superfluous(sites: tuple[int, ...], places: Sequence[Places]) -> bool:
    """Return whether one site is covered by the others."""
    return any(
        places[site] <= frozenset().union(*(places[other] for other in sites if other != site))
        for site in sites
    )
