"""Small missions as text over one world, checked; and a naive depth-first enumeration beside the explorer."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from checker import Interruption, Limits, Progress, Report, Trace, Verdict, Violation, check
from semantics.state.configuration import Configuration
from semantics.successors import expand
from specs import parse_bytes
from specs.elaboration import ElaboratedMission, elaborate

WORLD = """
signature {
  kind Location contains Location, OilSpill, UAV, Vessel, Drifter, Station
  kind OilSpill contains UAV, Vessel, Drifter
  kind UAV driven
  kind Vessel driven carries Drifter, Station, UAV
  kind Drifter
  kind Station
}

world {
  gate0: Location = circle (37.00, -8.70) radius 300 m
  north0: Location = box (37.03, -8.68) (37.01, -8.72)
  south0: Location = box (36.99, -8.68) (36.97, -8.72)
  uav0: UAV = point (37.02, -8.70) linked control:gcs0, mesh
  uav1: UAV = point (36.98, -8.70) linked control:gcs1, mesh
  vessel0: Vessel = point (36.975, -8.69) linked mesh
  drifter0: Drifter carried by vessel0
  gcs0: Station = point (37.06, -8.70) linked control:gcs0, internet
  gcs1: Station = point (37.07, -8.70) linked control:gcs1, internet
  gcs2: Station = point (37.08, -8.70) linked control:gcs2, internet
  spill0: OilSpill absent
}
"""
"""Two UAVs and a vessel on one mesh, three stations on the internet, and an empty gate."""

PILOTS = """
BigActor a hosted_at gcs0 with_behavior { control(MOVE uav0 TO south0) }
BigActor b hosted_at gcs0 with_behavior { control(MOVE uav0 TO gate0) }
"""
"""Two that command one vehicle."""

BOTH_LOOK = "".join(
    f"""
    BigActor {agent} hosted_at {host} with_behavior {{
      observe(CHILDREN(gate0))
      react {{ case o if not ({other} in o) => control(MOVE_HOST_TO gate0) case o => skip }}
    }}
    """
    for agent, host, other in (("a", "uav0", "uav1"), ("b", "uav1", "uav0"))
)
"""Two that look whether the other is in the gate before they enter it."""

SPARE = Limits(configurations=20_000)


def interrupted_at(size: int, limits: Limits = SPARE) -> tuple[Limits, Callable[[Progress], None]]:
    """Return limits, and what wishes for the end when it is told of so many configurations."""
    limits = replace(limits, interruption=Interruption())

    def report(progress: Progress) -> None:
        if progress.configurations >= size:
            limits.interruption.wish()

    return limits, report


def load(text: str, world: str = WORLD) -> ElaboratedMission:
    """Elaborate a mission that is written in this world."""
    source, mission = parse_bytes("small.mission", (world + text).encode())
    return elaborate(mission, source, Path())


def start(text: str, world: str = WORLD) -> Configuration:
    return load(text, world).initial


def checked(text: str, world: str = WORLD, limits: Limits = SPARE) -> Report:
    mission = load(text, world)
    return check(mission, limits=limits, notes=mission.notes)


def verdict(text: str, name: str, world: str = WORLD, limits: Limits = SPARE) -> Verdict:
    """Return the verdict on one property, asked for alone if the text has no check section."""
    if "check {" not in text:
        text += f"\ncheck {{ {name} }}"
    return verdict_of(checked(text, world, limits), name)


def visited(found: Any) -> tuple[Any, ...]:
    """Return all that an exploration tells of what it visited, in its order."""
    counts = (found.depth, found.expanded, found.transitions, found.rules, list(map(str, found.bounds)))
    return (list(found.configurations), list(map(int, found.origins)), *counts)


def timeless(report: Report) -> Report:
    """Return what a report says, whenever it is made."""
    return replace(report, seconds=0.0)


def verdict_of(report: Report, name: str) -> Verdict:
    return next(each for each in report.verdicts if each.property.name == name)


def kinds(found: Verdict) -> dict[str, int]:
    """Return the kinds of violations with the lengths of their shortest traces."""
    return {each.kind: len(each.trace) for each in reversed(found.violations)}


def violation(found: Verdict, kind: str) -> Violation:
    return next(each for each in found.violations if each.kind == kind)


def rules_of(trace: Trace) -> list[str]:
    return [step.label.rule for step in trace.steps]


def moves(place: str, agent: str, host: str) -> str:
    return f"BigActor {agent} hosted_at {host} with_behavior {{ control(MOVE_HOST_TO {place}) }}\n"


def enumerate_naively(
    c: Configuration, most: int = 20_000
) -> tuple[dict[Configuration, int], set[tuple[Configuration, str, Configuration]]]:
    """Return every reachable configuration with its distance, and every transition: depth-first, without cleverness."""
    distances: dict[Configuration, int] = {}
    transitions = set()
    stack = [(c, 0)]
    while stack:
        here, distance = stack.pop()
        if distances.get(here, distance + 1) <= distance:
            continue
        distances[here] = distance
        assert len(distances) <= most
        for each in expand(here).transitions:
            transitions.add((here, str(each.label), each.target))
            stack.append((each.target, distance + 1))
    return distances, transitions
