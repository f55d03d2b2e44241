"""Write the timed automaton of a mission for TChecker, as a second opinion: one process, whose edges are the steps.

TChecker has clocks of one name everywhere, which start at 0, and nothing enters a location too late for its invariant.
So a first location that takes no time sets what does not start at 0, and what is entered too late for its deadlines is
a location of its own, in which no time passes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from checker.engines.zones.automaton import Automaton, Constraint, Edge
from checker.engines.zones.network import Network
from checker.engines.zones.observers import Meter, Observer, Watch
from checker.engines.zones.search import Search
from checker.engines.zones.zone_times import ZoneTimes
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.timing.clocks import Clock

Measured = tuple[Clock | None, int]
"""What a clock measures, None for the observer's, and the how-manieth it is of several."""


def _measured(clocks: Sequence[Clock | None]) -> tuple[Measured, ...]:
    return tuple((clock, clocks[:at].count(clock)) for at, clock in enumerate(clocks))


def _named(locations: Sequence[tuple[Measured, ...]]) -> list[tuple[str, ...]]:
    """Return the names of the clocks of each location, and of 0 before them.

    What is never measured together may have one name, so that there are few.
    """
    beside: dict[Measured, set[Measured]] = {}
    for location in locations:
        for each in location:
            beside.setdefault(each, set()).update(location)
    names: dict[Measured, int] = {}
    for each, others in beside.items():
        taken = {names[other] for other in others if other in names}
        names[each] = next(number for number in range(len(taken) + 1) if number not in taken)
    return [("0", *(f"x{names[each]}" for each in location)) for location in locations]


def tchecker_text(times: ZoneTimes, asked: Property | None, called: str) -> str:
    """Write a mission's automaton; with a deadline or an endurance, `wrong` labels where it is violated.

    Raises:
        ValueError: It is another kind of property.
    """
    network = times.network
    if asked is None:
        return _text(called, network.automaton, network, range(len(network.places)), None, times.search)
    if asked.kind is PropertyKind.ENDURANCE:
        wrong = {
            at: list(each.values()) for at in range(len(network.places)) for each in [times.exhaustion(at)]
        }
        return _text(called, network.automaton, network, range(len(network.places)), wrong, times.search)
    if asked.kind is not PropertyKind.WITHIN:
        raise ValueError("only deadlines and endurance are exported")
    awaited = asked.formula if asked.then is None else asked.then
    rule = times.waiting(None if asked.then is None else asked.formula, awaited)
    observer = Observer(network, rule, Meter(asked.bound + 1, goal=(Watch.ON, asked.bound + 1)))
    search = Search(observer.automaton, 0, observer.first_ages())
    search.finish(lambda: None)
    late = {at: [each.goal] for at, each in enumerate(observer.automaton.all) if each.goal is not None}
    return _text(
        called, observer.automaton, network, [each.location for each in observer.spots], late, search
    )


def _text(
    called: str,
    automaton: Automaton,
    network: Network,
    locations: Sequence[int],
    wrong: dict[int, list[Constraint]] | None,
    search: Search,
) -> str:
    clocks = _named(
        [
            _measured(
                (
                    *network.clocks(each),
                    *([None] if len(automaton.all[at].lower) > len(network.clocks(each)) else []),
                )
            )
            for at, each in enumerate(locations)
        ]
    )
    late = _late(automaton)
    lines = list(_locations(automaton, clocks, late, wrong is not None))
    edges = list(_edges(automaton, clocks, late, wrong or {}))
    events = sorted({line.split(":")[4].split("{")[0] for line in edges})
    begin = "; ".join(
        f"{name} = {age}" for name, age in zip(clocks[search.location][1:], search.ages, strict=True) if age
    )
    return "\n".join(
        [
            f"system:{re.sub(r'[^A-Za-z0-9_]', '_', called)}",
            *(f"event:{each}" for each in ("begin", *events)),
            "process:mission",
            *(f"clock:1:{name}" for name in sorted({name for each in clocks for name in each[1:]})),
            "location:mission:first{initial: : committed: }",
            *lines,
            f"edge:mission:first:l{search.location}:begin{{{f'do: {begin}' if begin else ''}}}",
            *edges,
            "",
        ]
    )


def _late(automaton: Automaton) -> set[int]:
    """Return the locations that may be entered too late for a deadline."""
    late: set[int] = set()
    found = {edge.target for out in range(len(automaton.all)) for edge in _late_edges(automaton, out, late)}
    while not found <= late:
        late |= found
        found = {
            edge.target for out in range(len(automaton.all)) for edge in _late_edges(automaton, out, late)
        }
    return late


def _late_edges(automaton: Automaton, place: int, late: set[int]) -> list[Edge]:
    return [
        edge
        for edge in automaton.out[place]
        if edge.target >= 0
        and _waits(automaton, edge.target)
        and (_too_late(automaton, place, edge) or (place in late and _too_late(automaton, None, edge)))
    ]


def _too_late(automaton: Automaton, place: int | None, edge: Edge) -> list[tuple[int, int]]:
    """Return the clocks, with their bounds, that may be past a deadline after an edge from a location in time."""
    before = {} if place is None else dict(automaton.all[place].deadlines)
    after = [(edge.sources[clock - 1], most) for clock, most in automaton.all[edge.target].deadlines]
    return [(one, most) for one, most in after if one and before.get(one, most + 1) > most]


def _locations(
    automaton: Automaton, clocks: Sequence[Sequence[str]], late: set[int], goals: bool
) -> Iterator[str]:
    for at, location in enumerate(automaton.all):
        bounds = " && ".join(
            f"{clocks[at][clock]} <= {most}" for clock, most in location.deadlines if most >= 0
        )
        stands = any(most < 0 for _, most in location.deadlines)
        yield f"location:mission:l{at}{{{'urgent:' if stands else f'invariant: {bounds}' if bounds else ''}}}"
        if at in late and not stands:
            yield f"location:mission:u{at}{{urgent:}}"
    if goals:
        yield "location:mission:wrong{labels: wrong}"


def _edges(
    automaton: Automaton, clocks: Sequence[Sequence[str]], late: set[int], wrong: dict[int, list[Constraint]]
) -> Iterator[str]:
    for at in range(len(automaton.all)):
        for source in (f"l{at}", *([f"u{at}"] if at in late and _waits(automaton, at) else [])):
            for edge in automaton.out[at]:
                if edge.target >= 0:
                    yield from _edge(automaton, clocks, source, at, edge)
            for test in wrong.get(at, ()):
                yield f"edge:mission:{source}:wrong:wrong{{provided: {clocks[at][test.clock]} >= {test.least}}}"


def _waits(automaton: Automaton, at: int) -> bool:
    return all(most >= 0 for _, most in automaton.all[at].deadlines)


def _edge(
    automaton: Automaton, clocks: Sequence[Sequence[str]], source: str, at: int, edge: Edge
) -> Iterator[str]:
    tests = [
        each
        for clock, least, most in edge.tests
        for each in (
            *([f"{clocks[at][clock]} >= {least}"] if least > 0 else []),
            *([f"{clocks[at][clock]} <= {most}"] if most >= 0 else []),
        )
    ]
    does = [
        f"{name} = {clocks[at][one] if one else 0}"
        for name, one in zip(clocks[edge.target][1:], edge.sources, strict=True)
        if clocks[at][one] != name
    ]
    done = "; ".join(sorted(does, key=lambda each: each.endswith(" = 0")))  # what goes on is copied first
    targets = [(f"l{edge.target}", list[str]())]
    if _waits(automaton, edge.target):
        past = _too_late(automaton, at if source.startswith("l") else None, edge)
        targets += [(f"u{edge.target}", [f"{clocks[at][one]} > {most}"]) for one, most in past]
    for target, more in targets:
        provided = " && ".join([*tests, *more])
        parts = [f"provided: {provided}"] if provided else []
        parts += [f"do: {done}"] if done else []
        yield f"edge:mission:{source}:{target}:s{edge.step}{{{' : '.join(parts)}}}"
