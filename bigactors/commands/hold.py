"""`bigactors hold`: order a vehicle of a running mission, or all, to stay in place."""

import time
from argparse import Namespace
from collections.abc import Iterable, Iterator

from adapters.live.operator_socket import Fates, fates, order
from adapters.live.overrides import Fate
from bigactors.commands.say import check_texts, heard_at
from bigactors.exits import Exit
from bigactors.mistakes import Mistake
from bigactors.terminal import say, tell

WAIT = 10.0
"""Seconds within which vehicles should confirm an order."""

LOOK = 0.25
"""Seconds between two queries for the outcome of an order."""


def run(options: Namespace) -> Exit:
    """Give the order, and print its outcome; also runs `return`."""
    what, vehicle = options.command, options.vehicle
    check_texts("a vehicle", vehicle or "", options.by)
    refusal, left_out, notes = heard_at(options.socket, lambda path: order(path, what, vehicle, options.by))
    if refusal:
        raise Mistake(refusal, "`bigactors status` says how the run stands")
    for note in (*left_out.values(), *notes):
        tell(note, "note:")
    say(f"told to {what}: {vehicle or 'all vehicles of this station'}")
    return _concluded(_awaited(options.socket, vehicle, left_out))


def _awaited(socket: str | None, vehicle: str | None, left_out: Iterable[str]) -> Fates:
    """Return the outcomes of an order once all vehicles have confirmed or refused it, or after the timeout."""
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
    return fate in (Fate.CONFIRMED, Fate.REFUSED)


def _concluded(found: Fates) -> Exit:
    """Print the outcomes of an order, and return the exit code."""
    for line in _lines(found):
        say(line)
    became = {fate for fate, _ in found.values()}
    if Fate.REFUSED in became:
        return Exit.VIOLATED
    return Exit.HOLDS if became <= {Fate.CONFIRMED} else Exit.INCOMPLETE


def _lines(found: Fates) -> Iterator[str]:
    for name, (fate, words) in sorted(found.items()):
        again = "; it is told again until it does" if fate == Fate.REFUSED else ""
        later = "" if _is_settled(fate) else "; the run says when it is"
        yield f"{name} {words}{again}{later}"
