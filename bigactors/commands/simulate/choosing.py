"""`simulate --choose`: a run in which the user chooses every step."""

import random
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from bigactors.commands.simulate.one_run import Choice, OneRun, nothing_more, print_step
from physical.wordings import counted
from semantics.properties.property import Property
from semantics.properties.propositions import holds
from semantics.state.printing import print_changes, print_configuration
from semantics.timing.dates import clock_text, lapse_text, milliseconds_at

HELP = (
    "a number takes that step; with times as early as may be, or at the moment behind it: 2 1:30",
    "r  takes one by chance",
    "u  takes the last step back",
    "s  shows the configuration",
    "f  shows which formulas of the mission are true here",
    "q  ends the run, as the end of the input does",
)


@dataclass
class Walk:
    """A run in which the user chooses the steps.

    Attributes:
        run: The run so far.
        properties: The mission's properties.
        chance: Chooses a step when the user answers `r`.
    """

    run: OneRun
    properties: tuple[Property, ...]
    chance: random.Random

    def lines(self, answers: Iterable[str]) -> Iterator[str]:
        """Yield the output up to the answer `q`, or to the last answer."""
        yield from self.state()
        yield from self.choices()
        for answer in answers:
            word = answer.strip()
            if word == "q":
                break
            yield from self.answer(word)
        yield f"ended after {counted(len(self.run.taken), 'step')}"

    def answer(self, word: str) -> Iterator[str]:
        """Execute an answer, and yield its output."""
        choices = self.run.choices()
        number, _, moment = word.partition(" ")
        known = not moment or self.run.initial.setting.timing is not None
        if known and number.isdecimal() and len(number) < _DIGITS and 1 <= int(number) <= len(choices):
            yield from self.take(choices[int(number) - 1], moment.strip())
        elif word == "r" and choices:
            self.run.take_by_chance(self.chance)
            yield from self.told()
        elif word in _ANSWERS:
            yield from _ANSWERS[word](self)
        elif word:
            yield f"{word[:40]!r} is no choice here: {self.possible(len(choices))}"

    def possible(self, enabled: int) -> str:
        """Return the possible answers."""
        numbers = f"a number from 1 to {enabled}, r, " if enabled > 1 else "1, r, " if enabled else ""
        return f"answer {numbers}u, s, f, q, or ? for their meaning"

    def take(self, choice: Choice, moment: str) -> Iterator[str]:
        """Take a step, at the given moment if there is one."""
        try:
            self.run.take(choice, self._date(moment) if moment else None)
        except ValueError as problem:
            yield f"{moment[:40]!r} is no moment for it: {problem}"
            return
        yield from self.told()

    def _date(self, moment: str) -> int:
        timing = self.run.initial.setting.timing
        assert timing is not None
        ticks, rest = divmod(milliseconds_at(moment), timing.tick)
        if rest:
            raise ValueError(f"a tick is {lapse_text(timing.tick)}")
        return ticks

    def told(self) -> Iterator[str]:
        """Yield the step just taken, and the next choices."""
        yield from print_step(self.run, len(self.run.taken) - 1)
        yield from self.choices()

    def undo(self) -> Iterator[str]:
        """Take the last step back."""
        if not self.run.taken:
            yield "this is the beginning: there is no step to take back"
            return
        self.run.undo()
        yield f"back at c{len(self.run.taken)}"
        yield from self.choices()

    def state(self) -> Iterator[str]:
        """Show the configuration."""
        yield f"c{len(self.run.taken)} = {print_configuration(self.run.at)}"

    def formulas(self) -> Iterator[str]:
        """Show the truth of each formula about a single configuration."""
        asked = [each for each in self.properties if each.kind.has_proposition]
        for each in asked:
            yield f"  {'true ' if holds(each.formula, self.run.at) else 'false'}  {each.name}: {each.shown}"
        if not asked:
            yield "the mission has no invariant and no reachable: no property is about a single configuration"

    def choices(self) -> Iterator[str]:
        """Show the numbered choices. Choices with equal labels also show their changes."""
        choices = self.run.choices()
        labels = [each.transition.label for each in choices]
        for number, each in enumerate(choices, 1):
            alike = labels.count(each.transition.label) > 1
            changes = f"  {'; '.join(print_changes(self.run.at, each.transition.target))}" if alike else ""
            yield f"  {number:>2}  {self._when(each)}{each.transition.label}{changes}"
        if not labels:
            yield nothing_more(self.run)

    def _when(self, choice: Choice) -> str:
        timing = self.run.initial.setting.timing
        if choice.earliest is None or timing is None:
            return ""
        if choice.latest is None:
            return f"from {clock_text(choice.earliest * timing.tick)}  "
        return f"{clock_text(choice.earliest * timing.tick)} to {clock_text(choice.latest * timing.tick)}  "

    def help(self) -> Iterator[str]:
        """Explain the answers."""
        yield from (f"  {line}" for line in HELP)


_DIGITS = 8
_ANSWERS: dict[str, Callable[[Walk], Iterator[str]]] = {
    "u": Walk.undo,
    "s": Walk.state,
    "f": Walk.formulas,
    "?": Walk.help,
    "h": Walk.help,
}
