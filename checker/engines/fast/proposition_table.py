"""Truth of propositions with many atoms: the atoms about one name are evaluated together.

A fleet of fifty vehicles on two hundred places has ten thousand atoms `x in c`. A row needs only fifty profiles: the
sets of true atoms about each x. A subformula about one or two names is evaluated once for each pair of profiles that
occurs. Quantifiers over more names are expanded, instance by instance.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial, reduce
from operator import and_, or_

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.row_survey import RowSurvey, distinct_leaves
from semantics.properties.propositions import (
    Always,
    And,
    Atom,
    Ended,
    Exists,
    HostedAt,
    Inside,
    Instances,
    Known,
    LinkedWith,
    Not,
    Or,
    Present,
    Proposition,
    Same,
    Waiting,
    atoms_of,
    holds,
    is_variable,
    places_around,
)
from semantics.properties.region_atoms import ApartFrom, PossiblyIn, SurelyIn, WithinRangeOf, operands
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

Bools = NDArray[np.bool_]
Numbers = NDArray[np.int64]

Subject = tuple[Name, ...]
"""The names of an atom; the atoms of one subject share their reads."""

Subjects = tuple[Subject, ...]

MOST_TOGETHER = 2
"""The greatest number of subjects with combined profiles."""

MOST_PAIRS = 1 << 22
"""The greatest number of profile pairs in a table; more are sorted."""


def subject(atom: Atom) -> Subject:
    """Return the subject of an atom: both names if it reads equally much about each."""
    match atom:
        case (
            Inside(name)
            | Present(name)
            | Known(name)
            | Exists(name)
            | Ended(name)
            | Waiting(name)
            | HostedAt(name)
        ):
            return (name,)
        case LinkedWith(name, other):
            return (name, other)
        case PossiblyIn() | SurelyIn() | ApartFrom() | WithinRangeOf():
            return operands(atom)
        case _:
            return (str(atom),)


class Profiles:
    """The truth of a proposition in expanded rows, by the profiles of its subjects.

    Attributes:
        changing: Whether a read value differs between rows; set by `truths`.
    """

    def __init__(self, survey: RowSurvey, formula: Proposition) -> None:
        self.survey = survey
        self.formula = formula
        self.changing = False
        self.atoms: dict[Subject, list[Atom]] = {}
        for atom in dict.fromkeys(atoms_of(formula)):
            self.atoms.setdefault(subject(atom), []).append(atom)
        self.ranks = {atom: rank for each in self.atoms.values() for rank, atom in enumerate(each)}
        self.anchors: dict[Inside, list[int]] = {}
        learner = survey.space.learner
        self.trees = {
            one: learner.question(partial(profile, tuple(atoms))) for one, atoms in self.atoms.items()
        }
        self.numbers: dict[Subject, dict[object, int]] = {one: {} for one in self.atoms}
        self.met: dict[Subject, set[int]] = {one: set() for one in self.atoms}

    def truths(self, size: int | None = None) -> Bools:
        """Return whether the proposition is true, for each of the first `size` configurations."""
        found = [np.zeros(0, np.bool_)]
        found += (self._block(rows) for rows in self.survey.blocks(size))
        self.changing = any(len(leaves) > 1 for leaves in self.met.values())
        return np.concatenate(found)

    def _block(self, rows: Numbers) -> Bools:
        codes = {one: self._codes(one, rows) for one in self.trees}
        return _Block(self, codes, len(rows)).true(self.formula)

    def _codes(self, one: Subject, rows: Numbers) -> Numbers:
        leaves = self.survey.classify(self.trees[one], rows)
        self.met[one].update(distinct_leaves(leaves))
        return self.survey.numbered(leaves, self.numbers[one])

    def ranks_of(self, anchor: Inside, parts: Instances) -> list[int]:
        """Return the rank of each instance's anchor among the atoms of its subject."""
        if anchor not in self.anchors:
            each = (replace(anchor, place=name) for name in parts.range.names)
            self.anchors[anchor] = [self.ranks[atom] for atom in each]
        return self.anchors[anchor]

    def table(self, one: Subject) -> Bools:
        """Return the true atoms of each profile of a subject: one row for each profile."""
        width = len(self.atoms[one])
        bits = [
            np.unpackbits(np.frombuffer(each, np.uint8), count=width, bitorder="little")  # type: ignore[call-overload]  # profiles are bytes
            for each in self.numbers[one]
        ]
        return np.array(bits, np.bool_).reshape(len(bits), width)


def profile(atoms: tuple[Atom, ...], c: Configuration) -> bytes:
    """Return the truth of atoms in a configuration, one bit each."""
    around: dict[tuple[Name, bool], tuple[Name, ...]] = {}

    def is_true(atom: Atom) -> bool:
        if not isinstance(atom, Inside):
            return holds(atom, c)
        asked = (atom.node, atom.actually)
        if asked not in around:
            around[asked] = tuple(places_around(c, atom.node, actually=atom.actually))
        return atom.place in (around[asked][:1] if atom.directly else around[asked])

    return np.packbits([is_true(atom) for atom in atoms], bitorder="little").tobytes()


class _Block:
    """Some rows, with the number of each subject's profile in each row."""

    def __init__(self, profiles: Profiles, codes: dict[Subject, Numbers], size: int) -> None:
        self.profiles = profiles
        self.codes = codes
        self.size = size
        self.tables = {one: profiles.table(one) for one in codes}

    def true(self, formula: Proposition) -> Bools:
        """Return whether a proposition is true, for each row."""
        subjects = _subjects_of(formula)
        if subjects is not None and len(subjects) <= MOST_TOGETHER:
            return self._by_profiles(formula, subjects)
        match formula:
            case Not(inner):
                return ~self.true(inner)
            case And(parts):
                return reduce(and_, map(self.true, _by_subjects(And, parts)), np.ones(self.size, np.bool_))
            case Or(parts):
                return reduce(or_, map(self.true, _by_subjects(Or, parts)), np.zeros(self.size, np.bool_))
        raise AssertionError(formula)  # an atom has one subject

    def _by_profiles(self, formula: Proposition, subjects: Subjects) -> Bools:
        together, counts = np.zeros(self.size, np.int64), [len(self.tables[one]) for one in subjects]
        for one, count in zip(subjects, counts, strict=True):
            together = together * count + self.codes[one]
        if np.prod(counts, dtype=np.float64) > MOST_PAIRS:
            there, which = np.unique(together, return_inverse=True)
            return self._said(formula, subjects, there)[which]
        there = np.flatnonzero(np.bincount(together))
        said = np.zeros(there[-1] + 1 if len(there) else 0, np.bool_)
        said[there] = self._said(formula, subjects, there)
        return said[together]

    def _said(self, formula: Proposition, subjects: Subjects, there: Numbers) -> Bools:
        """Return the truth of a proposition for combined profile numbers of its subjects."""
        tables, rest = dict[Subject, Bools](), there
        for one in reversed(subjects):
            rest, code = np.divmod(rest, len(self.tables[one]))
            tables[one] = self.tables[one][code]
        return self._of(formula, tables, len(there))

    def _of(self, formula: Proposition, tables: dict[Subject, Bools], size: int) -> Bools:
        match formula:
            case Always(value):
                return np.full(size, value)
            case Not(inner):
                return ~self._of(inner, tables, size)
            case And(parts) | Or(parts):
                operation, start = (and_, True) if isinstance(formula, And) else (or_, False)
                each = self._worth_asking(parts, tables) if isinstance(parts, Instances) else iter(parts)
                said = (self._of(part, tables, size) for part in each)
                return reduce(operation, said, np.full(size, start))
        return tables[subject(formula)][:, self.profiles.ranks[formula]]

    def _worth_asking(self, parts: Instances, tables: dict[Subject, Bools]) -> Iterator[Proposition]:
        """Yield the instances with an anchor that is true in some profile; without anchors, yield all."""
        anchor = parts.anchor
        if anchor is None:
            yield from parts
            return
        somewhere = tables[subject(anchor)][:, self.profiles.ranks_of(anchor, parts)].any(axis=0)
        yield from (parts.of_name(parts.range.names[rank]) for rank in np.flatnonzero(somewhere))


def _by_subjects(make: type[And | Or], parts: Iterable[Proposition]) -> list[Proposition]:
    """Return the operands of a connective, with those about the same few subjects grouped."""
    together: dict[Subjects, list[Proposition]] = {}
    rest: list[Proposition] = []
    for part in parts:
        subjects = _subjects_of(part)
        few = subjects is not None and len(subjects) <= MOST_TOGETHER
        (together.setdefault(subjects, []) if subjects is not None and few else rest).append(part)
    return [*(make(tuple(each)) for each in together.values()), *rest]


def _subjects_of(formula: Proposition) -> Subjects | None:
    """Return the subjects of a proposition, sorted; None if one contains a variable."""
    found = sorted(set(_subjects(formula)))
    return None if any(is_variable(name) for one in found for name in one) else tuple(found)


def _subjects(formula: Proposition) -> Iterator[Subject]:
    match formula:
        case Always() | Same():
            return
        case Not(inner):
            yield from _subjects(inner)
        case And(parts) | Or(parts):
            for part in (parts.body,) if isinstance(parts, Instances) else parts:
                yield from _subjects(part)
        case _:
            yield subject(formula)
