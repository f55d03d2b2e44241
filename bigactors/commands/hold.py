"""`bigactors hold`: order a vehicle of a running mission, or all, to stay in place."""

from __future__ import annotations

import time
from argparse import Namespace
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Final

from bigactors.arguments.options import SOCKET, SPEAKER
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell

if TYPE_CHECKING:
    from adapters.live.operator_socket import Fates

DESCRIPTION: Final = """\
Order a vehicle to hold its position; a plane circles. The order is sent at once; to a silent vehicle, as soon as it is
heard. The mission then does not command the vehicle until `bigactors give-back VEHICLE`. An order by name overrules a
pilot or a fail-safe, `--all` does not. Order another station's vehicle at that station.

The command waits 10 s. Its exit code is 0 if the vehicle obeys, 1 if it refuses, 3 if neither is known. A refused order
is repeated until the vehicle obeys."""

EXAMPLES: Final = ("bigactors hold uav0", "bigactors hold --all --by Ana")

ARGUMENTS: Final = f"""\
exactly one of
  vehicle [VEHICLE]  a vehicle of the running mission
  --all  every vehicle of this station, except those that others have taken over

{SPEAKER}
{SOCKET}"""


WAIT = 10.0
"""Seconds within which vehicles should confirm an order."""

LOOK = 0.25
"""Seconds between two queries for the outcome of an order."""


def run(options: Namespace) -> Exit:
    """Give the order, and print its outcome; also runs `return`."""
    from adapters.live.operator_socket import order
    from bigactors.sockets import check_texts, heard_at, speaker

    what, vehicle, by = options.command, options.vehicle, speaker(options.by)
    check_texts("a vehicle", vehicle or "", by)
    refusal, left_out, notes = heard_at(options.socket, lambda path: order(path, what, vehicle, by))
    if refusal:
        raise Mistake(refusal, "`bigactors status` prints the state of the run")
    for note in (*left_out.values(), *notes):
        tell(note, "note:")
    say(f"ordered to {what}: {vehicle or 'all vehicles of this station'}")
    return _concluded(_awaited(options.socket, vehicle, left_out))


def _awaited(socket: str | None, vehicle: str | None, left_out: Iterable[str]) -> Fates:
    """Return the outcomes of an order once all vehicles have confirmed or refused it, or after the timeout."""
    from adapters.live.operator_socket import fates
    from bigactors.sockets import heard_at

    until = time.monotonic() + WAIT
    while True:
        known = heard_at(socket, fates)
        meant = {
            name: each for name, each in known.items() if vehicle in (None, name) and name not in left_out
        }
        if all(_is_settled(fate) for fate, _ in meant.values()) or time.monotonic() >= until:
            return meant
        time.sleep(LOOK)


def _is_settled(fate: str) -> bool:
    from adapters.live.overrides import Fate

    return fate in (Fate.CONFIRMED, Fate.REFUSED)


def _concluded(found: Fates) -> Exit:
    """Print the outcomes of an order, and return the exit code."""
    from adapters.live.overrides import Fate

    for line in _lines(found):
        say(line)
    became = {fate for fate, _ in found.values()}
    if Fate.REFUSED in became:
        return Exit.VIOLATED
    return Exit.HOLDS if became <= {Fate.CONFIRMED} else Exit.INCOMPLETE


def _lines(found: Fates) -> Iterator[str]:
    from adapters.live.overrides import Fate

    for name, (fate, words) in sorted(found.items()):
        again = "; the order is repeated until it obeys" if fate == Fate.REFUSED else ""
        later = "" if _is_settled(fate) else "; the run reports the confirmation"
        yield f"{name} {words}{again}{later}"
