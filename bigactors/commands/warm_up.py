"""`bigactors warm-up`: compile all loops now instead of at their first use."""

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from bigactors.exits import Exit

DESCRIPTION: Final = """\
Compile all loops of the fast engine, by checks of small missions. Otherwise each is compiled at its first use, for some
seconds once after an installation. An image of a container is best warmed up while it is built
(docs/how-to/check-in-ci.md)."""

EXAMPLES: Final = ("bigactors warm-up", "NUMBA_CACHE_DIR=/var/cache/bigactors bigactors warm-up")

ARGUMENTS: Final = ""

ALIKE: Final = b"""
mission alike
signature { kind Room contains Robot kind Robot driven }
world {
  hall: Room = box (37.1, -8.6) (37, -8.7)
  room0: Room = box (37.3, -8.6) (37.2, -8.7)
  robot0: Robot = point (37.05, -8.65)
  robot1: Robot = point (37.05, -8.65)
}
def look() = { observe(PARENT(HOST)) react { case obs => control(MOVE_HOST_TO room0) } }
BigActor a hosted_at robot0 with_behavior { look() }
BigActor b hosted_at robot1 with_behavior { look() }
check { deadlock_freedom ltl "they go": F actually robot0 in room0 }
"""
"""A mission that all reductions take."""

SETS: Final = (
    ("the search, and properties of runs", "alike", ()),
    ("partial-order reduction", "alike", ("por",)),
    ("symmetry", "alike", ("symmetry",)),
    ("both reductions", "alike", ("por", "symmetry")),
    ("races", "rendezvous", ("por",)),
    ("large graphs", "takeover", ()),
    ("times", "handover_timed", ()),
)
"""What is compiled: its name, and a mission with reductions that needs it."""


def run(_: Namespace) -> Exit:
    """Compile the loops, a set after another, and print the time that each took."""
    from time import monotonic

    from bigactors.terminal import say

    began = monotonic()
    for compressed in (False, True):
        for name, mission, reductions in SETS:
            with rows(compressed=compressed):
                _check(mission, reductions)
            shown = f"{name}, with compressed rows" if compressed else name
            say(f"{shown}: {monotonic() - began:.1f} s")
            began = monotonic()
    return Exit.HOLDS


def _check(mission: str, reductions: tuple[str, ...]) -> None:
    """Check a mission by the fast engine."""
    from pathlib import Path

    from checker import Engine, Limits, Reduction, check
    from specs import parse_bytes
    from specs.elaboration import elaborate, load_mission

    if mission == "alike":
        source, parsed = parse_bytes("alike.mission", ALIKE)
        loaded = elaborate(parsed, source, Path())
    else:
        loaded = load_mission(mission)
    check(loaded, engine=Engine.FAST, reduce=map(Reduction, reductions), limits=Limits(configurations=1_000))


@contextmanager
def rows(*, compressed: bool) -> Iterator[None]:
    """Compress the rows of every exploration meanwhile, or of none."""
    from checker.engines.fast.store import row_store

    before = row_store.PLAIN, row_store.COMPRESSED_FROM
    row_store.PLAIN, row_store.COMPRESSED_FROM = (0, 0) if compressed else (1 << 30, 1 << 30)
    try:
        yield
    finally:
        row_store.PLAIN, row_store.COMPRESSED_FROM = before
