"""The declarations of a file by name; a name declared twice is a mistake."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from bigraphs.notation.big.declarations import (
    ActionDeclaration,
    ActionTerm,
    BigDeclaration,
    ConstantDeclaration,
    ControlDeclaration,
    Model,
    ReactDeclaration,
)
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.lalr import Span


@dataclass(slots=True)
class Names:
    """Declarations by name.

    Of the declarations for particular arguments, `big b(1) = ...`, `bigs` and `reacts` have the first.
    """

    controls: dict[str, ControlDeclaration] = field(default_factory=dict)
    constants: dict[str, ConstantDeclaration] = field(default_factory=dict)
    bigs: dict[str, BigDeclaration] = field(default_factory=dict)
    reacts: dict[str, ReactDeclaration] = field(default_factory=dict)
    given_bigs: dict[str, list[BigDeclaration]] = field(default_factory=dict)
    given_reacts: dict[str, list[ReactDeclaration]] = field(default_factory=dict)
    actions: dict[str, ActionDeclaration] = field(default_factory=dict)
    """Actions by the names of their rules."""
    free: dict[tuple[type, str], tuple[str, ...]] = field(default_factory=dict)
    """For each declaration the system parameters that it uses but does not declare, directly or in its calls."""

    def all_reacts(self) -> Iterator[ReactDeclaration]:
        """Yield every rule as declared."""
        for declaration in self.reacts.values():
            yield from self.given_reacts.get(declaration.name, [declaration])

    def all_bigs(self) -> Iterator[BigDeclaration]:
        """Yield every bigraph as declared."""
        for declaration in self.bigs.values():
            yield from self.given_bigs.get(declaration.name, [declaration])


def index(model: Model, findings: Findings) -> Names:
    """Return the names that a file declares."""
    names = Names()
    first: dict[str, tuple[str, Span]] = {}
    for declaration in model.declarations:
        match declaration:
            case ControlDeclaration(name=name):
                if _is_new(first, f"control '{name}'", name, declaration.span, findings):
                    names.controls[name] = declaration
            case ConstantDeclaration(name=name):
                if _is_new(first, f"'{name}'", name, declaration.span, findings):
                    names.constants[name] = declaration
            case BigDeclaration():
                _add_big(names, declaration, first, findings)
            case ReactDeclaration():
                _add_react(names, declaration, first, findings)
            case ActionDeclaration(rules=rules):
                _check_action(names, declaration, findings)
                for rule in rules:
                    names.actions[rule.name] = declaration
                    _add_react(names, rule, first, findings)
            case _:
                pass  # sorts have their own names
    for action in model.system.actions if model.system is not None else ():
        _add_listed(names, action, findings)
    return names


def _add_listed(names: Names, action: ActionTerm, findings: Findings) -> None:
    """Register the rules that an action of the system lists."""
    declaration = ActionDeclaration(action.name, (), action.reward, action.span)
    _check_action(names, declaration, findings)
    nowhere = Findings(findings.text)
    for rule in action.rules:
        if rule not in names.reacts:
            nowhere.unknown("rule", rule, action.span, names.reacts)
        elif rule in names.actions:
            found = f"rule '{rule}' is in action '{names.actions[rule].name}', too"
            findings.add("name", found, action.span, "leave it in one of them")
        names.actions[rule] = declaration
    findings.warn(nowhere)


def _check_action(names: Names, action: ActionDeclaration, findings: Findings) -> None:
    if any(other.name == action.name for other in names.actions.values()):
        findings.add(
            "name",
            f"action '{action.name}' is declared twice",
            action.span,
            "put its rules into one",
        )


def _add_big(
    names: Names, big: BigDeclaration, first: dict[str, tuple[str, Span]], findings: Findings
) -> None:
    if big.arguments and big.name in names.given_bigs:
        names.given_bigs[big.name].append(big)
    elif _is_new(first, f"bigraph '{big.name}'", big.name, big.span, findings):
        names.bigs[big.name] = big
        if big.arguments:
            names.given_bigs[big.name] = [big]


def _add_react(
    names: Names, react: ReactDeclaration, first: dict[str, tuple[str, Span]], findings: Findings
) -> None:
    if react.arguments and react.name in names.given_reacts:
        names.given_reacts[react.name].append(react)
    elif _is_new(first, f"rule '{react.name}'", react.name, react.span, findings):
        names.reacts[react.name] = react
        if react.arguments:
            names.given_reacts[react.name] = [react]


def _is_new(first: dict[str, tuple[str, Span]], what: str, name: str, span: Span, findings: Findings) -> bool:
    if name not in first:
        first[name] = what, span
        return True
    line = findings.text.count("\n", 0, first[name][1].start) + 1
    findings.add("name", f"{what} is declared twice", span, f"it is declared on line {line}, too")
    return False
