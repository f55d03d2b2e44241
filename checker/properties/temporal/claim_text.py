"""Temporal formulas over named predicates and rules, in the syntax of a mission's `ltl` and `ctl`.

They are about systems of bigraphs, and about models of a user's own. Atoms are predicates, and `taken` and `enabled`
with a rule. A prefix may restrict the formula
to fair runs: `under weak fairness of walk and strong fairness of rules: <> meeting`.
"""

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import chain
from typing import Final, NamedTuple, cast

from bigraphs.errors import NotationError
from bigraphs.notation import formulas as s
from bigraphs.notation.spelling import did_you_mean
from bigraphs.system import System
from semantics.properties import temporal as t
from semantics.properties.propositions import Always, Proposition

MOST_NESTED: Final = 32
"""The deepest nesting of path operators."""
MOST_PARTS: Final = 2_000
"""The most parts of a formula after the rewriting of `<->` and W, which doubles their operands."""

_PREFIXES: Final[dict[str, Callable[[t.Temporal], t.Path]]] = {
    "[]": t.Globally,
    "G": t.Globally,
    "always": t.Globally,
    "<>": t.Eventually,
    "F": t.Eventually,
    "eventually": t.Eventually,
    "X": t.Next,
    "next": t.Next,
}
_OPERATIONS: Final[dict[str, Callable[[t.Temporal, t.Temporal], t.Path]]] = {
    "U": t.Until,
    "until": t.Until,
    "R": t.Release,
    "W": t.WeakUntil,
}


@dataclass(frozen=True, slots=True)
class Occurs:
    """The atom that a predicate occurs in the state, beside the atoms of missions."""

    label: str

    def __str__(self) -> str:
        return self.label


def occurs(label: str) -> t.Now:
    """Return the formula that a predicate occurs now; the checker only looks its atoms up."""
    return t.Now(cast("Proposition", Occurs(label)))


class Claim(NamedTuple):
    """A formula, and the fairness of the runs that it quantifies over."""

    formula: t.Temporal
    fairness: tuple[t.Fairness, ...] = ()


EACH_RULE: Final = "rules"
"""The word for all rules; fairness then applies to each rule with each of its arguments."""


def fair_to(strong: bool, steps: t.Steps, word: str) -> t.Fairness:
    """Return fairness to the steps of rules; a class of steps has one rule with its arguments (the label's `rule`)."""
    return t.Fairness(strong, steps, ("rule",), word)


class ClaimWords(NamedTuple):
    """The words of formulas.

    Attributes:
        predicates: The names of the predicates.
        rules: The names of single rules and of groups of rules.
        single: The names of single rules: the `rule` of a label. A group is the `agent` of a label.
        instantaneous: The names of rules that are no steps of their own.
    """

    predicates: tuple[str, ...]
    rules: tuple[str, ...]
    single: Collection[str]
    instantaneous: Collection[str] = ()


def claim_words_of(system: System) -> ClaimWords:
    """Return the vocabulary of a system of bigraphs; a group has the rules of one name."""
    rules = [rule for each in system.classes if not each.instantaneous for rule in each.rules]
    at_once = [rule for each in system.classes if each.instantaneous for rule in each.rules]
    return ClaimWords(
        tuple(predicate.label for predicate in system.predicates),
        tuple(dict.fromkeys(chain.from_iterable((rule.name, rule.label) for rule in rules))),
        {rule.label for rule in rules},
        {name for rule in at_once for name in (rule.name, rule.label)},
    )


def parse_claim(text: str, logic: str, words: ClaimWords) -> Claim:
    """Parse a formula of a logic, `ltl` or `ctl`; raises NotationError for an invalid formula."""
    elaboration = _Elaboration(text, logic, words)
    term = s.parse_formula(text)
    fairness: tuple[t.Fairness, ...] = ()
    if term.kind == "under":
        *declared, term = cast("tuple[s.Term, ...]", term.parts)
        fairness = tuple(chain.from_iterable(map(elaboration.fairness, declared)))
    return Claim(elaboration.state(elaboration.part(term)), fairness)


@dataclass(frozen=True, slots=True)
class _Part:
    """A part of a formula.

    Attributes:
        formula: The formula.
        start: Its start in the text.
        end: Its end in the text.
        depth: The nesting depth of its path operators.
        size: The number of its parts after the rewriting of `<->` and W.
        of_path: Whether it is an unquantified path formula, in CTL.
    """

    formula: t.Temporal
    start: int
    end: int
    depth: int = 0
    size: int = 1
    of_path: bool = False


class _Elaboration:
    """Builds the formulas of one logic from syntax trees."""

    def __init__(self, text: str, logic: str, words: ClaimWords) -> None:
        self.text, self.logic, self.words = text, logic, words

    def state(self, part: _Part) -> t.Temporal:
        """Return a state formula; in CTL, all formulas are state formulas except those directly after A and E."""
        if part.of_path:
            message = "in ctl an operator of paths stands directly behind A or E"
            raise self.wrong("logic", message, part, "write AG, EF, AX or A (F U G)")
        return part.formula

    def wrong(self, code: str, message: str, at: _Part | s.FormulaWord, hint: str) -> NotationError:
        """Return a mistake with its place."""
        return NotationError(code, message, self.text, at.start, length=at.end - at.start, hint=hint)

    def part(self, term: s.Term) -> _Part:
        """Return the formula of a term."""
        parts = (self.part(each) if isinstance(each, s.Term) else each for each in term.parts)
        found: _Part = getattr(self, term.kind)(term, *parts)
        return found

    # --- atoms, then compound formulas: a method for each kind of term

    def truth(self, at: s.Term, word: s.FormulaWord) -> _Part:
        return _part(t.Now(Always(word.text == "true")), at)

    def predicate(self, at: s.Term, word: s.FormulaWord) -> _Part:
        label = self.known(word, self.words.predicates, "predicate")
        return _part(occurs(label), at)

    def taken(self, at: s.Term, word: s.FormulaWord) -> _Part:
        if self.logic == "ctl":
            message = "ctl is about all possible steps, and so has no 'taken'"
            raise self.wrong("logic", message, word, "write it in ltl, or write enabled")
        return _part(t.Taken(self.steps(word)), at)

    def enabled(self, at: s.Term, word: s.FormulaWord) -> _Part:
        return _part(t.Enabled(self.steps(word)), at)

    def fairness(self, declared: s.Term) -> Iterator[t.Fairness]:
        """Yield the fairness to each of the rules that a declaration lists."""
        strength, *listed = cast("tuple[s.FormulaWord, ...]", declared.parts)
        for word in listed:
            steps = t.Steps() if word.text == EACH_RULE else self.steps(word)
            yield fair_to(strength.text == "strong", steps, word.text)

    def steps(self, word: s.FormulaWord) -> t.Steps:
        """Return the steps of a rule, or of all rules of a name (see `ClaimWords`)."""
        name = _unquoted(word.text)
        if name not in self.words.rules and name in self.words.instantaneous:
            message = f"the rule '{name}' is instantaneous, so no step is its own"
            raise self.wrong("rule", message, word, "name the ordinary rule that it follows")
        label = self.known(word, self.words.rules, "rule")
        return t.Steps((label,)) if label in self.words.single else t.Steps((), label)

    def known(self, word: s.FormulaWord, labels: tuple[str, ...], sort: str) -> str:
        """Return the label that a word names; spaces in its parameters are ignored."""
        name = _unquoted(word.text)
        if name in labels:
            return name
        tight = name.replace(" ", "")
        if tight in labels:
            return tight
        hint = did_you_mean(name, labels) or f"the {sort}s are {_some(labels)}"
        raise self.wrong(sort, f"unknown {sort} '{name}'", word, hint)

    # --- connectives

    def denied(self, at: s.Term, inner: _Part) -> _Part:
        return _part(t.Denied(self.state(inner)), at, inner)

    def both(self, at: s.Term, left: _Part, right: _Part) -> _Part:
        return _part(t.Both(self.state(left), self.state(right)), at, left, right)

    def either(self, at: s.Term, left: _Part, right: _Part) -> _Part:
        return _part(t.Either(self.state(left), self.state(right)), at, left, right)

    def implies(self, at: s.Term, left: _Part, right: _Part) -> _Part:
        return _part(t.Either(t.Denied(self.state(left)), self.state(right)), at, left, right)

    def equivalent(self, at: s.Term, left: _Part, right: _Part) -> _Part:
        one, other = self.state(left), self.state(right)
        formula = t.Both(t.Either(t.Denied(one), other), t.Either(t.Denied(other), one))
        return self.bounded(_part(formula, at, left, right, times=2))

    # --- operators of paths

    def prefix(self, at: s.Term, operator: s.FormulaWord, inner: _Part) -> _Part:
        formula = self.state(inner)
        make = _PREFIXES.get(operator.text)
        if make is not None:
            return self.over_path(make(formula), at, inner)
        if self.logic == "ctl":
            message = "'infinitely often' is two operators of paths"
            raise self.wrong("logic", message, operator, "write AG AF F")
        return self.over_path(t.Globally(t.Eventually(formula)), at, inner)

    def operation(self, at: s.Term, left: _Part, operator: s.FormulaWord, right: _Part) -> _Part:
        formula = _OPERATIONS[operator.text](self.state(left), self.state(right))
        times = 2 if operator.text == "W" else 1  # CTL rewrites W by U
        return self.over_path(formula, at, left, right, times=times)

    def quantified(self, at: s.Term, quantifier: s.FormulaWord, inner: _Part) -> _Part:
        letter, operator = quantifier.text[0], quantifier.text[1:]
        if self.logic == "ltl":
            message = f"ltl is about every run, and has no '{letter}'"
            raise self.wrong("logic", message, quantifier, "leave it out, or ask with --ctl")
        make = t.OnAllPaths if letter == "A" else t.OnSomePath
        if operator:
            formula = make(_PREFIXES[operator](self.state(inner)))
            return replace(self.over_path(formula, at, inner), of_path=False)
        if not inner.of_path:
            message = f"'{letter}' needs an operator of paths"
            raise self.wrong("logic", message, inner, "write AG, EF, AX or A (F U G)")
        return _part(make(inner.formula), at, inner)

    def leads_to(self, at: s.Term, left: _Part, _leads: s.FormulaWord, right: _Part) -> _Part:
        before, after = t.Denied(self.state(left)), t.Eventually(self.state(right))
        if self.logic == "ctl":
            always = t.OnAllPaths(t.Globally(t.Either(before, t.OnAllPaths(after))))
            return replace(self.over_path(always, at, left, right), of_path=False)
        return self.over_path(t.Globally(t.Either(before, after)), at, left, right)

    def bounded(self, part: _Part) -> _Part:
        """Return a part, or raise NotationError if its formula is too large."""
        if part.size > MOST_PARTS:
            message = f"written out, a formula of more than {MOST_PARTS} parts"
            raise self.wrong("too-long", message, part, "check its parts one by one")
        return part

    def over_path(self, formula: t.Temporal, at: s.Term, *parts: _Part, times: int = 1) -> _Part:
        """Return a path formula (every formula is one in LTL), one operator deeper than its parts."""
        found = self.bounded(_part(formula, at, *parts, times=times))
        if found.depth >= MOST_NESTED:
            message = f"more than {MOST_NESTED} operators of paths inside each other"
            raise self.wrong("too-deep", message, found, "split it")
        return replace(found, depth=found.depth + 1, of_path=self.logic == "ctl")


def _part(formula: t.Temporal, at: s.Term, *parts: _Part, times: int = 1) -> _Part:
    depth, size = max((part.depth for part in parts), default=0), sum(part.size for part in parts)
    return _Part(formula, at.start, at.end, depth, 1 + times * size)


def _unquoted(word: str) -> str:
    return word[1:-1] if word.startswith('"') else word


def _some(labels: Iterable[str]) -> str:
    first = list(labels)
    return ", ".join(first[:8]) + (", ..." if len(first) > 8 else "") if first else "none"
