"""Linear and branching temporal formulas about runs, and the fairness of runs."""

from collections.abc import Iterator
from dataclasses import dataclass, fields

from semantics.properties.propositions import And, Or, Proposition
from semantics.state.configuration import Label
from semantics.state.signature import Name

ENVIRONMENTS = ("env", "say")
"""The rules that belong to no agent."""

SERVES = ("sense", "actuate", "command", "commit", "snd", "migrate")
"""The rules that serve a request; their labels show it."""

# --- steps ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Steps:
    """A set of steps: of some rules (of all if none is named), of one bigActor (of any if none is named)."""

    rules: tuple[str, ...] = ()
    agent: Name | None = None

    def has(self, label: Label) -> bool:
        """Whether a step with that label is in the set; the environment's steps are only if their rule is named."""
        if self.rules and label.rule not in self.rules:
            return False
        if self.agent is None:
            return bool(self.rules) or label.agent is not None
        return label.agent == self.agent

    def __str__(self) -> str:
        rules = "environment" if self.rules == ENVIRONMENTS else " or ".join(self.rules)
        return " ".join(word for word in (rules, self.agent) if word) or "agents"


@dataclass(frozen=True, slots=True)
class Fairness:
    """A fairness condition: a fair run takes the steps that it covers.

    Attributes:
        strong: Whether steps enabled infinitely often must be taken; otherwise only those enabled forever from some
            point.
        steps: The steps.
        per: The attributes by which steps are grouped, among `agent`, `rule` and `label`; each group is owed by itself.
            If empty, all steps are one group.
        word: The mission's name for them.
    """

    strong: bool
    steps: Steps
    per: tuple[str, ...] = ()
    word: str = ""

    def __str__(self) -> str:
        return f"{'strong' if self.strong else 'weak'} fairness of {self.word or self.steps}"


# --- formulas -------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Now:
    """A proposition is true of the configuration."""

    proposition: Proposition

    def __str__(self) -> str:
        return f"{self.proposition}"


@dataclass(frozen=True, slots=True)
class Taken:
    """`taken sense a`: the next step is one of these; in linear time only."""

    steps: Steps

    def __str__(self) -> str:
        return f"taken {self.steps}"


@dataclass(frozen=True, slots=True)
class Enabled:
    """`enabled sense a`: one of these steps is possible."""

    steps: Steps

    def __str__(self) -> str:
        return f"enabled {self.steps}"


@dataclass(frozen=True, slots=True)
class Denied:
    """`not f`."""

    formula: "Temporal"

    def __str__(self) -> str:
        return f"not {_operand(self.formula)}"


@dataclass(frozen=True, slots=True)
class Both:
    """`f and g`."""

    left: "Temporal"
    right: "Temporal"

    def __str__(self) -> str:
        return " and ".join(_chained(each, Both) for each in (self.left, self.right))


@dataclass(frozen=True, slots=True)
class Either:
    """`f or g`."""

    left: "Temporal"
    right: "Temporal"

    def __str__(self) -> str:
        return " or ".join(_chained(each, Either) for each in (self.left, self.right))


@dataclass(frozen=True, slots=True)
class Next:
    """`X f`: f after the next step."""

    formula: "Temporal"

    def __str__(self) -> str:
        return f"X {_operand(self.formula)}"


@dataclass(frozen=True, slots=True)
class Eventually:
    """`<> f`: f now or later."""

    formula: "Temporal"

    def __str__(self) -> str:
        return f"<> {_operand(self.formula)}"


@dataclass(frozen=True, slots=True)
class Globally:
    """`[] f`: f now and forever."""

    formula: "Temporal"

    def __str__(self) -> str:
        return f"[] {_operand(self.formula)}"


@dataclass(frozen=True, slots=True)
class Until:
    """`f U g`: g now or later, and f until then."""

    left: "Temporal"
    right: "Temporal"

    def __str__(self) -> str:
        return f"{_operand(self.left)} U {_operand(self.right)}"


@dataclass(frozen=True, slots=True)
class Release:
    """`f R g`: g forever, or until f and g are true together."""

    left: "Temporal"
    right: "Temporal"

    def __str__(self) -> str:
        return f"{_operand(self.left)} R {_operand(self.right)}"


@dataclass(frozen=True, slots=True)
class WeakUntil:
    """`f W g`: f until g, or f forever."""

    left: "Temporal"
    right: "Temporal"

    def __str__(self) -> str:
        return f"{_operand(self.left)} W {_operand(self.right)}"


@dataclass(frozen=True, slots=True)
class OnAllPaths:
    """`A f`: f on every run from here; in branching time only."""

    formula: "Temporal"

    def __str__(self) -> str:
        return f"A {_operand(self.formula)}"


@dataclass(frozen=True, slots=True)
class OnSomePath:
    """`E f`: f on some run from here; in branching time only."""

    formula: "Temporal"

    def __str__(self) -> str:
        return f"E {_operand(self.formula)}"


State = Now | Taken | Enabled
Path = Next | Eventually | Globally | Until | Release | WeakUntil
Quantified = OnAllPaths | OnSomePath
Temporal = State | Denied | Both | Either | Path | Quantified


def _operand(formula: Temporal) -> str:
    loose = Both | Either | Until | Release | WeakUntil
    joined = isinstance(formula, Now) and isinstance(formula.proposition, And | Or)
    return f"({formula})" if joined or isinstance(formula, loose) else str(formula)


def _chained(formula: Temporal, sort: type) -> str:
    return str(formula) if isinstance(formula, sort) else _operand(formula)


def parts(formula: Temporal) -> tuple[Temporal, ...]:
    """Return the direct subformulas of a formula."""
    if isinstance(formula, State):
        return ()
    return tuple(getattr(formula, each.name) for each in fields(formula))


def atoms(formula: Temporal) -> Iterator[State]:
    """Yield the atoms of a formula, from left to right."""
    waiting = [formula]
    while waiting:
        one = waiting.pop()
        if isinstance(one, State):
            yield one
        waiting.extend(reversed(parts(one)))


def chain(formula: Temporal, connective: type[Both | Either]) -> Iterator[Temporal]:
    """Yield the operands of a chain of one connective, from left to right."""
    waiting = [formula]
    while waiting:
        one = waiting.pop()
        if isinstance(one, connective):
            waiting += [one.right, one.left]
        else:
            yield one


def conjuncts(formula: Temporal) -> list[Temporal]:
    """Return the conjuncts of a formula, with `[]` and `A []` distributed over them."""
    match formula:
        case Both(left, right):
            return [*conjuncts(left), *conjuncts(right)]
        case Globally(Both(left, right)):
            return [*conjuncts(Globally(left)), *conjuncts(Globally(right))]
        case OnAllPaths(Globally(Both(left, right))):
            return [each for one in (left, right) for each in conjuncts(OnAllPaths(Globally(one)))]
    return [formula]
