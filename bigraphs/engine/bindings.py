"""Binding of a pattern's links to a state's links: port by port or, for unordered ports, in every possible way."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator

from bigraphs.engine.intern_tables import InternTables
from bigraphs.engine.patterns import CompiledPattern
from bigraphs.engine.search_state import OFTEN, PatternSearch, Placing, Step
from bigraphs.engine.state_arrays import GroundState


def binding(world: InternTables, pattern: CompiledPattern, node: int, then: Step) -> Placing:
    """Return the step that binds the links of a node in each possible way."""
    ports = pattern.ports[node]
    if not ports:
        return lambda run, used, _: then(run, used)
    if len(ports) == 1 or world.ordered[pattern.controls[node]]:
        return _in_order(world, pattern, ports, then)
    return _in_any_order(world, pattern, ports, then)


def _in_order(world: InternTables, pattern: CompiledPattern, ports: tuple[int, ...], then: Step) -> Placing:
    fits = _fitting(world, pattern)

    def bind(run: PatternSearch, used: int, slot: int) -> bool:
        targets, links, fresh = run.state.ports[slot], run.links, []
        over = False
        if len(targets) == len(ports):
            for link, target in zip(ports, targets, strict=True):
                known = links[link]
                if known < 0 and fits(run.state, link, target):
                    links[link] = target
                    fresh.append(link)
                elif known != target:
                    break
            else:
                over = then(run, used)
        for link in fresh:
            links[link] = -1
        return over

    return bind


def _in_any_order(
    world: InternTables, pattern: CompiledPattern, ports: tuple[int, ...], then: Step
) -> Placing:
    """Return the step for unordered ports: each link of a node takes a link with enough ports on the slot."""
    fits = _fitting(world, pattern)
    wanted = sorted(Counter(ports).items())

    def bind(run: PatternSearch, used: int, slot: int) -> bool:
        targets = run.state.ports[slot]
        if len(targets) != len(ports):
            return False
        return any(then(run, used) for _ in ways(run, Counter(targets), 0))

    def ways(run: PatternSearch, left: Counter[int], place: int) -> Iterator[None]:
        if place == len(wanted):
            yield
            return
        link, times = wanted[place]
        known = run.links[link]
        for target in [target for target in left if left[target] >= times]:
            if target != known and (known >= 0 or not fits(run.state, link, target)):
                continue
            run.steps += 1
            if run.steps & OFTEN == 0:
                run.state.world.pause()
            left[target] -= times
            run.links[link] = target
            yield from ways(run, left, place + 1)
            run.links[link] = known
            left[target] += times

    return bind


def _fitting(world: InternTables, pattern: CompiledPattern) -> Callable[[GroundState, int, int], bool]:
    """Return the test whether a pattern link may bind a state link; an edge needs an edge of the same size."""
    names, fixed = pattern.names, len(world.names)
    sizes = [len(nodes) for nodes in pattern.on]

    def fits(state: GroundState, link: int, target: int) -> bool:
        return link < names or (target >= fixed and state.points[target].bit_count() == sizes[link])

    return fits
