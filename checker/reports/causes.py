"""The causes of a trace's end: the few steps that explain it, each in one plain sentence."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from operator import methodcaller
from typing import Final

from checker.reports.plain_steps import step_words
from checker.traces import Trace
from checker.verdicts import Violation
from semantics.properties.property import Property
from semantics.properties.propositions import Proposition, atoms_of, holds
from semantics.properties.region_atoms import RegionAtom, operands
from semantics.properties.temporal import Now
from semantics.properties.temporal import atoms as temporal_atoms
from semantics.state.configuration import Configuration
from semantics.state.requests import CTR, FLY, Request
from semantics.state.signature import Name

MOST: Final = 4
"""The most causes of one trace."""

OF_TIME: Final = frozenset({"late", "exhausted", "time stops"})
"""The kinds of violations whose message is a plain sentence about the end of the run."""

MOST_ATOMS: Final = 64
MOST_STEPS: Final = 2_000
"""The longest run whose causes are sought."""


@dataclass(frozen=True, slots=True)
class Cause:
    """One cause: the number of its step, and a sentence."""

    number: int
    text: str


def causes_of(
    trace: Trace, violation: Violation | None = None, formulas: tuple[Proposition, ...] = ()
) -> tuple[Cause, ...]:
    """Return the causes, in the order of the run; the formulas are those of the violated property, if it has any."""
    if not trace.steps or len(trace) > MOST_STEPS:
        return ()
    if trace.race is not None:
        sensed, changed, acted = trace.race
        looker, actor = (trace.steps[number - 1].label.agent for number in (sensed, acted))
        deed = _words(trace, acted).removesuffix(f", as {actor} wants")
        texts = (
            _words(trace, sensed),
            _words(trace, changed),
            f"{actor} acts on what {'it' if looker == actor else looker} saw: {deed}",
        )
        return tuple(map(Cause, (sensed, changed, acted), texts))
    if violation is None:
        return ()
    if violation.kind == "deadlock":
        return tuple(_waits(trace, violation))
    found = {*_requests(trace, violation.subject), *_flips(trace, formulas)}
    if not found and trace.loop is None:
        found = {len(trace)}
    told = [Cause(number, _words(trace, number)) for number in sorted(found)[-MOST:]]
    return (*told, *_ends(trace, violation))


def formulas_of(asked: Property) -> tuple[Proposition, ...]:
    """Return the propositions about configurations in a property."""
    temporal = () if asked.temporal is None else temporal_atoms(asked.temporal)
    states = (each.proposition for each in temporal if isinstance(each, Now))
    return (*(each for each in (asked.formula, asked.then) if each is not None), *states)


def _ends(trace: Trace, violation: Violation) -> Iterator[Cause]:
    """Yield what is wrong at the end of the run, where no step is: too late a moment, or what never happens."""
    end = len(trace)
    if violation.kind in OF_TIME:
        yield Cause(end, violation.message)
    elif trace.loop == end:
        yield Cause(end, "the run may stay as it is for ever")
    elif trace.loop is not None:
        yield Cause(end, f"the steps since c{trace.loop} repeat for ever")


def _words(trace: Trace, number: int) -> str:
    before, step = trace.configurations[number - 1], trace.steps[number - 1]
    return step_words(before, step.label, step.target)


def _waits(trace: Trace, violation: Violation) -> Iterator[Cause]:
    """Yield a sentence for each agent that waits, with its last step."""
    waits = violation.message.partition(", and ")[2].split("; ")
    lasts = {step.label.agent: number for number, step in enumerate(trace.steps, 1)}
    for words in waits[:MOST]:
        yield Cause(lasts.get(words.split(" ")[0], len(trace)), words)


def _requests(trace: Trace, subject: str) -> Iterator[int]:
    """Yield the steps that asked for the pending controls that a violation is about, and that moved what they name."""
    end, subjects = trace.configurations[-1], subject.split(" and ")
    found = [each.request for each in end.eta.all() if str(each.request) in subjects]
    yield from (_last(trace, partial(_is_pending, each)) for each in found)
    names = {name for each in found for name in _nodes(each)} if len(subjects) == 1 else set()
    yield from _moves(trace, names | (end.setting.kinds.keys() & {*subjects}))


def _moves(trace: Trace, names: Iterable[Name]) -> Iterator[int]:
    """Yield the last step that moved each entity."""
    found = (_last(trace, methodcaller("read", ("placement", name))) for name in sorted(names))
    yield from filter(None, found)


def _is_pending(request: Request, c: Configuration) -> bool:
    return any(each.request == request for each in c.eta.all())


def _nodes(request: Request) -> tuple[Name, ...]:
    if not isinstance(request, CTR | FLY):
        return ()
    return tuple(sorted(node for node in request.reaction.redex.nodes if isinstance(node, str)))


def _flips(trace: Trace, formulas: tuple[Proposition, ...]) -> Iterator[int]:
    """Yield the last step that changed each atom of the formulas, and the last moves of what it compares."""
    atoms = dict.fromkeys(atom for formula in formulas for atom in atoms_of(formula))
    for atom in list(atoms)[:MOST_ATOMS]:
        changed = _last(trace, partial(holds, atom))
        if changed:
            yield changed
            if isinstance(atom, RegionAtom):
                yield from _moves(trace, operands(atom))


def _last(trace: Trace, value: Callable[[Configuration], object]) -> int:
    """Return the last step that changed a value of configurations; 0 if none did."""
    values = [value(c) for c in trace.configurations]
    return next((n for n in range(len(values) - 1, 0, -1) if values[n] != values[n - 1]), 0)
