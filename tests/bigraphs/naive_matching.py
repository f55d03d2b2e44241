"""Matching by trying everything: every map of nodes and links, every place of a region, every filling of sites."""

from itertools import chain, combinations, permutations, product

from bigraphs.bigraph import children, link_key, links, points
from bigraphs.matching import Match


def naive_matches(redex, target, *, sharing=False):
    """Return every match that satisfies the definition, as a set: with sharing, regions may lie nowhere."""
    found = set()
    for nodes in permutations(range(len(target.nodes)), len(redex.nodes)):
        if not _controls_agree(redex, target, nodes):
            continue
        maps = [m for m in _link_maps(redex, target) if _links_agree(redex, target, nodes, m)]
        placed = list(_placed(redex, target, nodes, sharing)) if maps else []
        found |= {Match(redex, target, nodes, tuple(m.items()), *where) for m in maps for where in placed}
    return found


def _controls_agree(redex, target, nodes):
    return all(
        node.control == target.nodes[image].control and node.name in (None, target.nodes[image].name)
        for node, image in zip(redex.nodes, nodes, strict=True)
    )


def _link_maps(redex, target):
    wanted = links(redex)
    for images in product(links(target), repeat=len(wanted)):
        yield dict(zip(wanted, images, strict=True))


def _links_agree(redex, target, nodes, mapped):
    for node, image in zip(redex.nodes, nodes, strict=True):
        ports, there = [mapped[link] for link in node.ports], list(target.nodes[image].ports)
        ordered = target.signature[node.control].ordered
        if ports != there if ordered else sorted(ports, key=link_key) != sorted(there, key=link_key):
            return False
    on = points(target)
    closed = [link for link in mapped if isinstance(link, int)]
    return all(
        isinstance(mapped[edge], int)
        and list(mapped.values()).count(mapped[edge]) == 1
        and len(on[mapped[edge]]) == len(points(redex)[edge])
        for edge in closed
    )


def _subsets(items, largest):
    items = list(items)
    return chain.from_iterable(combinations(items, size) for size in range(largest + 1))


def _placed(redex, target, nodes, sharing):
    places = range(-target.regions, len(target.nodes))
    rest = [number for number in range(len(target.nodes)) if number not in nodes]
    homes = [
        set(s)
        for s in _subsets([p for p in places if p not in nodes], len(places) if sharing else 1)
        if s or sharing
    ]
    for regions in product(homes, repeat=redex.regions):
        if not _tops_agree(redex, target, nodes, regions):
            continue
        fillings = list(_subsets(range(len(redex.sites)), len(redex.sites) if sharing else 1))
        for filling in product(fillings, repeat=len(rest)):
            sites = [
                [n for n, held in zip(rest, filling, strict=True) if s in held]
                for s in range(len(redex.sites))
            ]
            if _valid(redex, target, nodes, regions, sites):
                yield tuple(tuple(sorted(r)) for r in regions), tuple(map(tuple, sites))


def _image(parents, nodes, regions):
    return set().union(*({nodes[parent]} if parent >= 0 else regions[~parent] for parent in parents))


def _tops_agree(redex, target, nodes, regions):
    return all(
        set(target.nodes[image].parents) == _image(node.parents, nodes, regions)
        for node, image in zip(redex.nodes, nodes, strict=True)
    )


def _valid(redex, target, nodes, regions, sites):
    inside, matched = set(), set(nodes)
    waiting = [number for tops in sites for number in tops]
    below = children(target)
    while waiting:
        number = waiting.pop()
        inside.add(number)
        waiting.extend(below[number])
    context = set(range(-target.regions, len(target.nodes))) - inside - matched
    around = set().union(*regions)
    if inside & matched or not around <= context or not _active(target, around):
        return False
    for number in context:
        if number >= 0 and not set(target.nodes[number].parents) <= context:
            return False
    held = [_image(parents, nodes, regions) for parents in redex.sites]
    return all(
        _held_well(set(target.nodes[number].parents), number, sites, held, matched) for number in inside
    )


def _held_well(parents, number, sites, held, matched):
    mine = [held[site] for site, tops in enumerate(sites) if number in tops]
    covered = set().union(*mine)
    spare = any(covered == set().union(*(mine[:n] + mine[n + 1 :])) for n in range(len(mine)))
    return covered <= parents and parents & matched <= covered and not spare


def _active(target, places):
    waiting, seen = list(places), set()
    while waiting:
        place = waiting.pop()
        if place >= 0 and place not in seen:
            seen.add(place)
            if target.signature[target.nodes[place].control].status != "active":
                return False
            waiting.extend(target.nodes[place].parents)
    return True
