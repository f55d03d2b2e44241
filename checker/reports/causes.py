"""The causes of a trace's end: the few steps that explain it, each in one plain sentence."""

from collections.abc import Callable, Iterable, Iterator, Mapping
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

PLAIN: Final[Mapping[str, str]] = {
    "control race": "the outcome depends on which of two commands comes first",
    "stale-observation race": "a command rests on an observation that is no longer true",
    "inconsistent": "a command rests on a belief that is no longer true",
    "unmatched": "the beliefs do not allow a command",
    "unrealisable": "nothing in the world can carry out a command",
    "deadlock": "nobody can go on, and not all is done",
    "not arrived": "a flight may never end",
    "unserved": "a request may never be served",
    "late": "it comes too late",
    "exhausted": "a vehicle is away for longer than it lasts",
    "time stops": "no later moment is ever reached",
    "diverges": "a bigActor computes for ever",
    "fails": "a computation fails",
}
"""Kinds of violations in words that need no theory."""

SAID_BY_MESSAGE: Final = frozenset({"late", "exhausted", "time stops", "diverges", "fails"})
"""The kinds of violations whose message is a plain sentence about the end of the run."""

SAID_BY_DETAILS: Final = frozenset({"invariant", "inconsistent", "unmatched", "unrealisable"})
"""The kinds of violations with details in plain sentences."""

MOST_TRUTHS: Final = 4
"""The most atoms of an invariant in its explanation."""

MOST_ATOMS: Final = 64
MOST_STEPS: Final = 2_000
"""The longest run whose causes are sought."""


@dataclass(frozen=True, slots=True)
class Cause:
    """One cause: the number of its step, and a sentence.

    Attributes:
        number: The number of the step.
        text: The sentence.
        is_step: Whether that step is to blame; if not, the sentence is about the configuration after it.
    """

    number: int
    text: str
    is_step: bool = True


def causes_of(
    trace: Trace, violation: Violation | None = None, formulas: tuple[Proposition, ...] = ()
) -> tuple[Cause, ...]:
    """Return the causes, in the order of the run; the formulas are those of the violated property, if it has any."""
    if len(trace) > MOST_STEPS:
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
        return tuple(sorted(_waits(trace, violation), key=lambda cause: cause.number)[-MOST:])
    found = {*_missed(trace), *_requests(trace, violation.subject), *_flips(trace, formulas)}
    if not found and trace.loop is None and trace.steps:
        found = {len(trace)}
    told = [Cause(number, _words(trace, number)) for number in sorted(found)[-MOST:]]
    ends = (Cause(len(trace), each, is_step=False) for each in _ends(trace, violation, formulas) if each)
    return (*told, *ends)


def headline_of(asked: Property, kind: str) -> str:
    """Return in plain words which property is violated, and how."""
    plain = PLAIN.get(kind) or PLAIN.get(kind.partition(" ")[0], kind)
    return f"{asked.name} is violated: {asked.written or plain}"


def formulas_of(asked: Property) -> tuple[Proposition, ...]:
    """Return the propositions about configurations in a property."""
    temporal = () if asked.temporal is None else temporal_atoms(asked.temporal)
    states = (each.proposition for each in temporal if isinstance(each, Now))
    return (*(each for each in (asked.formula, asked.then) if each is not None), *states)


def _ends(trace: Trace, violation: Violation, formulas: tuple[Proposition, ...]) -> Iterator[str]:
    """Yield what is wrong at the end of the run, where no step is: too late a moment, or what never happens."""
    if violation.kind in SAID_BY_MESSAGE:
        yield violation.message
    elif violation.kind == "control race":
        yield "nothing decides which of the two comes first, and the outcome depends on it"
    elif violation.kind in SAID_BY_DETAILS:
        yield _details(trace, violation, formulas)
    elif trace.loop == len(trace):
        yield "all may stay like this for ever"
    elif trace.loop is not None:
        yield f"{f'the steps after step {trace.loop}' if trace.loop else 'all steps'} repeat for ever"


def _details(trace: Trace, violation: Violation, formulas: tuple[Proposition, ...]) -> str:
    """Return the details without what variables stand for; else which atoms of an invariant are true."""
    found = [each for each in violation.details if not each.startswith("where ")] or violation.details
    if found:
        return "; ".join(found)
    end, atoms = trace.configurations[-1], dict.fromkeys(atom for each in formulas for atom in atoms_of(each))
    values = {True: "true", False: "not true"} if len(atoms) <= MOST_TRUTHS else {}
    truths = [
        (words, [str(each) for each in atoms if holds(each, end) is value]) for value, words in values.items()
    ]
    return "; ".join(f"{words} here: {', '.join(those)}" for words, those in truths if those)


def _words(trace: Trace, number: int) -> str:
    before, step = trace.configurations[number - 1], trace.steps[number - 1]
    return step_words(before, step.label, step.target)


def _waits(trace: Trace, violation: Violation) -> Iterator[Cause]:
    """Yield a sentence for each agent that waits, with its last step, and for each request that stays pending."""
    lasts = {step.label.agent: number for number, step in enumerate(trace.steps, 1)}
    pending = {str(each.request): each.request for each in trace.configurations[-1].eta.all()}
    for words in violation.details or (violation.message.partition(", and ")[2],):
        about, _, why = words.partition(": ")
        agent, waits, _ = words.partition(" waits ")
        if about in pending:
            number, then = (
                _last(trace, partial(_is_pending, pending[about])),
                f"this stays pending: {PLAIN.get(why.removeprefix('it is '), why)}",
            )
        else:
            number, then = lasts.get(agent, 0) if waits else 0, words
        if number:
            yield Cause(number, f"{_words(trace, number)}; then {then}")
        else:
            yield Cause(len(trace), then, is_step=False)


def _missed(trace: Trace) -> Iterator[int]:
    """Yield the last observation that missed somebody."""
    missed = (number for number, step in enumerate(trace.steps, 1) if step.label.missed)
    yield from [*missed][-1:]


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
