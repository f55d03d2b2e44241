"""The three steps of a stale-observation race, as a trace carries them and every report marks them."""

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from semantics.behaviours.observations import Query
from semantics.behaviours.reaction_rules import Reaction
from semantics.state.configuration import Configuration, Label
from semantics.state.requests import CTR, FLY, OBS
from semantics.state.signature import Name

ROLES: Final = ("sensed", "changed", "acted")
"""The words that mark them, in the order of the steps."""


class RaceSteps(NamedTuple):
    """The numbers of the three steps, from 1.

    Attributes:
        sensed: The observation was sensed.
        changed: Another agent's control changed the answer.
        acted: A control that rests on the answer was served all the same.
    """

    sensed: int
    changed: int
    acted: int

    @property
    def roles(self) -> dict[int, str]:
        """The word of each of the three steps."""
        return dict(zip(self, ROLES, strict=True))

    def told(self, labels: Sequence[Label], run: Sequence[Configuration]) -> Iterator[str]:
        """Yield the three steps line by line: the labels of the run, and the lines of the text that ask for them."""
        by = labels[self.changed - 1].agent
        words = ("sensed", f"changed by {by}", "acted on")
        for what, at in zip(words, self, strict=True):
            line = line_of_request(labels, run, at)
            yield f"{what} in step {at}: {labels[at - 1]}{f', asked in line {line}' if line else ''}"


def line_of_request(labels: Sequence[Label], run: Sequence[Configuration], at: int) -> int:
    """Return the line of the statement by which a request was made that a step serves; 0 if it is unknown."""
    served = labels[at - 1].about
    if not isinstance(served, OBS | CTR | FLY):
        return 0
    wanted = _object_of(served)
    for number in range(at - 1, 0, -1):
        before, after = (map(_object_of, _pending(c, served.agent)) for c in run[number - 1 : number + 1])
        if labels[number - 1].agent == served.agent and wanted not in before and wanted in after:
            program, code = run[0].setting.program, run[number - 1].alpha.code(served.agent)
            return program.lines[code[0]] if program.lines and code else 0
    return 0


def _pending(c: Configuration, agent: Name) -> Iterator[OBS | CTR | FLY]:
    requests = (each.request for each in c.eta.in_line(agent))
    return (each for each in requests if isinstance(each, OBS | CTR | FLY))


def _object_of(request: OBS | CTR | FLY) -> Query | Reaction:
    return request.query if isinstance(request, OBS) else request.reaction
