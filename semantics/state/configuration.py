"""Configurations ⟨α | S | η⟩: immutable, hashable, compared by value; and the transitions between them."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from semantics.state.agents import Agents
from semantics.state.brief import cut
from semantics.state.cell_values import (
    MONITOR,
    Cell,
    Changes,
    Edit,
    Part,
    Question,
    Row,
    WritableCells,
    merged,
)
from semantics.state.eta import Eta, PendingRequest
from semantics.state.requests import REQUESTS, Received, Request
from semantics.state.setting import Setting
from semantics.state.signature import Name
from semantics.state.structure import Structure


class Configuration:
    """⟨α | S | η⟩ as views over cells, within a setting.

    Attributes:
        alpha: The agents.
        structure: The structure S = (L, P, β, γ).
        eta: The pending requests.
        setting: The constants of the mission.
        state: The cells.
    """

    __slots__ = ("alpha", "eta", "setting", "state", "structure")

    def __init__(self, setting: Setting, state: WritableCells) -> None:
        self.setting = setting
        self.state = state
        self.alpha = Agents(state)
        self.structure = Structure(state, setting)
        self.eta = Eta(state, setting)

    @staticmethod
    def of(setting: Setting, contents: Mapping[Cell, Any]) -> "Configuration":
        """Return the configuration with these cells."""
        return Configuration(setting, Row.of(contents))

    def read(self, cell: Cell) -> Any:
        """Return the value of a cell."""
        return self.state.read(cell)

    def test(self, cell: Cell, question: Question, *constants: Any) -> bool:
        """Return the answer to a yes-or-no question about a cell."""
        return self.state.test(cell, question, *constants)

    def ask(self, cell: Cell, question: Question, *constants: Any) -> Any:
        """Return the answer to a question about a cell."""
        return self.state.ask(cell, question, *constants)

    def edited(self, cell: Cell, edit: Edit, *constants: Any) -> Any:
        """Return an edited value of a cell."""
        return self.state.edited(cell, edit, *constants)

    def with_(self, *changes: Changes) -> "Configuration":
        """Return the configuration with these cells written; later changes win."""
        return Configuration(self.setting, self.state.with_(merged(changes)))

    def each(self, names: Iterable[Name], part: Callable[[Name], Part]) -> Mapping[Name, Part]:
        """Return the part of each name in a pointwise definition: no part depends on another."""
        return self.state.each(names, part)

    def with_each(self, parts: Mapping[Name, Changes]) -> "Configuration":
        """Return the configuration with the writes of each part of a pointwise definition."""
        return Configuration(self.setting, self.state.with_each(parts))

    def unmonitored(self) -> "Configuration":
        """Return the configuration without the monitor's cells, as it is counted."""
        assert isinstance(self.state, Row)
        kept = {cell: value for cell, value in self.state.items() if cell[0] != MONITOR}
        return Configuration.of(self.setting, kept)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Configuration) and self.state == other.state

    def __hash__(self) -> int:
        return hash(self.state)

    def __str__(self) -> str:
        from semantics.state.printing import print_configuration  # noqa: PLC0415  # printing knows configurations

        return print_configuration(self)

    def __repr__(self) -> str:
        from semantics.state.printing import print_briefly  # noqa: PLC0415  # the same

        return print_briefly(self)


@dataclass(frozen=True, slots=True)
class Label:
    """The label of a transition: `⟨rule : ...⟩`.

    Attributes:
        rule: The name of the inference rule.
        agent: The agent of the rule; None for the environment's rules.
        about: The request served, the observation received, or the text after the agent.
        missed: The entities that an observation misses, sorted.
    """

    rule: str
    agent: Name | None
    about: Request | Received | str = ""
    missed: tuple[Name, ...] = ()

    def missing(self, *names: Name) -> "Label":
        """Return the label of an observation that misses these entities instead."""
        return replace(self, missed=names)

    @property
    def details(self) -> str:
        """The text after the rule and the agent."""
        return f"{self.about}, missing {', '.join(self.missed)}" if self.missed else str(self.about)

    def __str__(self) -> str:
        words = [self.details] if isinstance(self.about, REQUESTS) else [self.agent or "", self.details]
        return f"⟨{self.rule} : {', '.join(word for word in words if word)}⟩"

    def __repr__(self) -> str:
        return f"<Label {cut(self)}>"


@dataclass(frozen=True, slots=True)
class Transition:
    """One transition of a rule.

    Attributes:
        label: Its label.
        target: The configuration after it.
        shown: The output of `display`.
        served: The pending request that it serves, with its position.
    """

    label: Label
    target: Configuration
    shown: tuple[str, ...] = ()
    served: PendingRequest | None = field(default=None, compare=False)

    def __repr__(self) -> str:
        return f"<Transition {cut(self.label)}>"
