"""Regions and sites of an occurrence in a state whose nodes may have several parents.

A place outside an occurrence holds each region whose top nodes are all in it, except a region smaller than another such
region. A node below an occurrence is in each site whose parents are all its parents, except a site smaller than another
such site. So the decomposition of a state is unique and does not depend on any numbering. A region whose nodes all have
parents in the pattern may have no place (as in Sevegnani and Calder's bigraphs with sharing, where a site may be an
orphan).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from bigraphs.engine.patterns import CompiledPattern
from bigraphs.engine.state_arrays import GroundState, bits


def shared_places_fit(pattern: CompiledPattern, state: GroundState, nodes: Sequence[int], used: int) -> bool:
    """Return whether the regions and sites cover all outer parents and all content of an occurrence's nodes."""
    places = region_places(pattern, state, nodes, used)
    tops = _tops(pattern, nodes)
    for place, inside in _around(state, nodes, used).items():
        if inside != _union(tops[region] for region, found in enumerate(places) if place in found):
            return False
    homes = _site_masks(pattern, nodes)
    for slot in bits(_held(state, nodes) & ~used):
        within = _matched_parents(state, slot, used)
        if within != _union(homes[site] for site in _sites_at(homes, within)):
            return False
    return True


def region_places(
    pattern: CompiledPattern, state: GroundState, nodes: Sequence[int], used: int
) -> list[list[int]]:
    """Return the places of each region, sorted."""
    tops = _tops(pattern, nodes)
    found: list[list[int]] = [[] for _ in tops]
    for place, inside in sorted(_around(state, nodes, used).items()):
        fitting = [region for region, top in enumerate(tops) if top & ~inside == 0]
        for region in fitting:
            if not any(_smaller(tops[region], tops[other]) for other in fitting):
                found[region].append(place)
    return found


def site_contents(pattern: CompiledPattern, state: GroundState, nodes: Sequence[int], used: int) -> list[int]:
    """Return the mask of the topmost slots in each site."""
    homes = _site_masks(pattern, nodes)
    found = [0] * len(homes)
    for slot in bits(_held(state, nodes) & ~used):
        for site in _sites_at(homes, _matched_parents(state, slot, used)):
            found[site] |= 1 << slot
    return found


def _sites_at(homes: Sequence[int], within: int) -> list[int]:
    fitting = [site for site, home in enumerate(homes) if home & ~within == 0]
    return [site for site in fitting if not any(_smaller(homes[site], homes[other]) for other in fitting)]


def _smaller(one: int, other: int) -> bool:
    return one != other and one & ~other == 0


def _tops(pattern: CompiledPattern, nodes: Sequence[int]) -> list[int]:
    found = [0] * pattern.regions
    for node, homes in enumerate(pattern.homes):
        for region in homes:
            found[region] |= 1 << nodes[node]
    return found


def _site_masks(pattern: CompiledPattern, nodes: Sequence[int]) -> list[int]:
    return [_union(1 << nodes[place] for place in parents) for parents in pattern.sites]


def _around(state: GroundState, nodes: Sequence[int], used: int) -> dict[int, int]:
    """Return the places around an occurrence, each with the mask of the occurrence's nodes in it."""
    found: dict[int, int] = {}
    for slot in nodes:
        for place in state.parents[slot]:
            if place < 0 or not used >> place & 1:
                found[place] = found.get(place, 0) | 1 << slot
    return found


def _held(state: GroundState, nodes: Sequence[int]) -> int:
    return _union(state.kids[slot] for slot in nodes)


def _matched_parents(state: GroundState, slot: int, used: int) -> int:
    return _union(1 << place for place in state.parents[slot] if place >= 0) & used


def _union(masks: Iterable[int]) -> int:
    found = 0
    for mask in masks:
        found |= mask
    return found
