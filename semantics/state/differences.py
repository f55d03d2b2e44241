"""The differences between two configurations, such as an added request or a removed link.

`printing.print_changes` prints whole cells after a step. This module lists only the changes within them, so that a run
reads as the effects of its steps.
"""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from semantics.behaviours.values import show
from semantics.state.agents import written
from semantics.state.canonical import written as written_cells
from semantics.state.cell_values import AGENTS, MONITOR, NAMES, QUEUE, Cell
from semantics.state.configuration import Configuration
from semantics.state.physical_model import Carried, InTransit, PhysicalModel
from semantics.state.printing import word_of
from semantics.state.requests import READY
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Difference:
    """One difference.

    Attributes:
        part: Its part: `α`, `L`, `P` or `η`; `E` for the messages that may still come from outside.
        whose: The agent, node or channel concerned.
        text: Its description.
    """

    part: str
    whose: Name
    text: str

    def __str__(self) -> str:
        return f"{self.part}  {self.text}"


PARTS = ("α", "L", "P", "η", "E")
"""The parts of a configuration, in the order in which differences are listed."""


def differences(before: Configuration, after: Configuration) -> tuple[Difference, ...]:
    """Return the differences, part by part, without the monitor's cells."""
    changed = sorted({*written_cells(before, after), *written_cells(after, before)})
    found = [each for cell in changed for each in _of_cell(before, after, cell)]
    return tuple(sorted(found, key=lambda each: PARTS.index(each.part)))


def _of_cell(before: Configuration, after: Configuration, cell: Cell) -> Iterator[Difference]:
    what, whose = cell[0], cell[-1]
    if what == MONITOR or cell in (AGENTS, NAMES):
        return
    old, new = before.read(cell), after.read(cell)
    if what == "code":
        yield Difference("α", whose, f"{whose} {'is ' if new else ''}{_at(after, whose)}")
    elif what == "host":
        yield Difference("α", whose, f"{whose} hosted_at {new}" if new else f"{whose} is gone")
    elif what == "store":
        texts = dict.fromkeys(_variables(old or (), new or ()))
        yield from (Difference("α", whose, f"{whose}.{text}") for text in texts)
    elif what == "mailbox":
        yield from (Difference("α", whose, f"mail of {whose}: {text}") for text in _shown(old, new))
    elif what in ("line", "sends") or cell == QUEUE:
        yield from (Difference("η", agent, text) for agent, text in _requests(old or (), new or ()))
    elif what == "parent":
        yield Difference("L", whose, f"{whose} : {_place(before, whose)} ↦ {_place(after, whose)}")
    elif what in ("links", "channels"):
        part = "L" if what == "links" else "P"
        yield from (Difference(part, whose, f"{whose} : {text}") for text in _joined(old or (), new or ()))
    elif what == "placement":
        physical = (where_words(c.structure.physical, whose) for c in (before, after))
        yield Difference("P", whose, f"{whose} : {' ↦ '.join(physical)}")
    elif what == "down":
        yield Difference("P", whose, f"{whose} {'drops' if new else 'returns'}")
    elif what == "says":
        yield Difference("E", whose, f"may still be said: {new}")


def _at(c: Configuration, a: Name) -> str:
    code, program = c.alpha.code(a), c.setting.program
    if not code:
        return "ended"
    line = program.line(code[0])
    return f"at {word_of(program.statements[code[0]])}" + (f" (line {line})" if line else "")


def _variables(old: Iterable[tuple[str, object]], new: Iterable[tuple[str, object]]) -> Iterator[str]:
    """Yield the variables that are new or have a new value; forgotten variables are not reported."""
    before = dict(old)
    for name, value in new:
        if before.get(name) != value and written(name):
            yield f"{written(name)} = {show(value)}"  # type: ignore[arg-type]  # stores hold values


def _shown(old: Iterable[object] | None, new: Iterable[object] | None) -> Iterator[str]:
    yield from _more_and_less(
        [show(each) for each in old or ()],  # type: ignore[arg-type]  # mail is values
        [show(each) for each in new or ()],  # type: ignore[arg-type]
    )


def _more_and_less(old: Iterable[str], new: Iterable[str]) -> Iterator[str]:
    before, after = Counter(old), Counter(new)
    yield from (f"− {each}" for each in sorted((before - after).elements()))
    yield from (f"+ {each}" for each in sorted((after - before).elements()))


def _requests(old: Iterable[object], new: Iterable[object]) -> Iterator[tuple[Name, str]]:
    before, after = Counter(old), Counter(new)
    for sign, requests in (("−", before - after), ("+", after - before)):
        for request in sorted(requests.elements(), key=str):
            short = (
                f"READY({request.agent}, {request.observation})"
                if isinstance(request, READY)
                else str(request)
            )
            yield request.agent, f"{sign} {short}"  # type: ignore[attr-defined]  # every request has an agent


def _joined(old: Iterable[Name], new: Iterable[Name]) -> Iterator[str]:
    before, after = set(old), set(new)
    yield from (f"− {each}" for each in sorted(before - after))
    yield from (f"+ {each}" for each in sorted(after - before))


def _place(c: Configuration, node: Name) -> str:
    return str(c.structure.logical.parent(node)) if node in c.structure.logical else "unknown"


def where_words(physical: PhysicalModel, name: Name) -> str:
    """Return the place of an entity in P in words."""
    placement = physical.placement(name)
    if placement is None:
        return "absent"
    if isinstance(placement, InTransit):
        return f"on the way to {placement.to}"
    if isinstance(placement, Carried):
        return f"carried by {placement.by}"
    return f"in {physical.abstract_parent(name)}"
