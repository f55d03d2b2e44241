"""Truth of propositions with many atoms: the atoms about one name are evaluated together.

A fleet of fifty vehicles on two hundred places has ten thousand atoms `x in c`. A row needs only fifty profiles: the
sets of true atoms about each x. A subformula about one or two names is evaluated once for each pair of profiles that
occurs. Quantifiers over more names are expanded, instance by instance.

An atom about regions has two subjects, each with the regions of one entity. So every two regions are compared once, and
not once in each row.
"""

from collections.abc import Hashable, Iterable, Iterator
from dataclasses import replace
from functools import partial, reduce
from operator import and_, or_
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.survey.row_survey import RowSurvey, distinct_leaves
from physical import PhysicalError
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
from semantics.properties.region_atoms import ApartFrom, RegionAtom, operands
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

Bools = NDArray[np.bool_]
Numbers = NDArray[np.int64]
Table = NDArray[Any]
"""The true atoms of each profile of a subject, one row for each; of regions, their numbers."""

Subject = tuple[Name, ...]
"""The names of an atom; the atoms of one subject share their reads."""

Subjects = tuple[Subject, ...]

MOST_TOGETHER = 2
"""The greatest number of subjects with combined profiles."""

MOST_REGION_PAIRS = 1 << 12
"""The greatest number of pairs of regions that are compared before a look at the rows."""

MOST_PAIRS = 1 << 22
"""The greatest number of profile pairs in a table; more are sorted."""


OF_REGION = ""
"""The first name of a subject whose profiles are the regions of an entity."""


def subjects_of_atom(atom: Atom) -> Subjects:
    """Return the subjects of an atom: two if it is about the regions of two entities."""
    if isinstance(atom, RegionAtom):
        return tuple((OF_REGION, name) for name in dict.fromkeys(operands(atom)))
    return (subject(atom),)


def subject(atom: Atom) -> Subject:
    """Return the single subject of an atom: both names if it reads equally much about each."""
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
        self.regions = Regions()
        for atom in dict.fromkeys(atoms_of(formula)):
            for one in subjects_of_atom(atom):
                self.atoms.setdefault(one, []).append(atom)
        self.ranks = {atom: rank for each in self.atoms.values() for rank, atom in enumerate(each)}
        self.anchors: dict[Inside, list[int]] = {}
        learner = survey.learner
        self.trees = {
            one: learner.question(
                partial(standing, one[1]) if is_of_region(one) else partial(profile, tuple(atoms))
            )
            for one, atoms in self.atoms.items()
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

    def table(self, one: Subject) -> Table:
        """Return the true atoms of each profile of a subject: one row for each profile; of regions, their numbers."""
        if is_of_region(one):
            return np.array([self.regions.number(each) for each in self.numbers[one]], np.int64)
        width = len(self.atoms[one])
        bits = [
            np.unpackbits(np.frombuffer(each, np.uint8), count=width, bitorder="little")  # type: ignore[call-overload]  # profiles are bytes
            for each in self.numbers[one]
        ]
        return np.array(bits, np.bool_).reshape(len(bits), width)


def is_of_region(one: Subject) -> bool:
    """Whether the profiles of a subject are the regions of an entity."""
    return one[0] == OF_REGION


def standing(entity: Name, c: Configuration) -> Hashable:
    """Return an entity with its region in a configuration."""
    from semantics.regions.region_truth import located  # noqa: PLC0415 - geometry takes its time to load

    return located(c, entity)


class Regions:
    """The regions that occur, by number, and the truth of atoms about two of them."""

    def __init__(self) -> None:
        self.numbers: dict[Any, int] = {}
        self.all: list[Any] = []
        self.said: dict[Hashable, bool] = {}

    def number(self, located: Any) -> int:
        """Return the number of an entity with its region."""
        if located not in self.numbers:
            self.numbers[located] = len(self.all)
            self.all.append(located)
        return self.numbers[located]

    def relate(self, atom: RegionAtom, ones: Numbers, others: Numbers) -> Bools:
        """Return the truth of an atom for pairs of numbered regions."""
        pairs, which = np.unique(ones << 32 | others, return_inverse=True)
        said = [self._relates(atom, pair >> 32, pair & 0xFFFFFFFF) for pair in pairs.tolist()]
        return np.array(said, np.bool_)[which]

    def _relates(self, atom: RegionAtom, one: int, other: int) -> bool:
        from semantics.regions.region_truth import relates  # noqa: PLC0415 - as in `standing`

        first, second = (other, one) if isinstance(atom, ApartFrom) and other < one else (one, other)
        asked = (type(atom), getattr(atom, "distance", 0), getattr(atom, "height", 0), first, second)
        if asked not in self.said:
            self.said[asked] = relates(atom, self.all[first], self.all[second])
        return self.said[asked]


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
        self.present = {one: np.unique(each) for one, each in codes.items()}

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
        same = self._by_all_pairs(formula, subjects)
        if same is not None:
            return np.broadcast_to(np.bool_(same), self.size)
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

    def _by_all_pairs(self, formula: Proposition, subjects: Subjects) -> bool | None:
        """Return the truth of a proposition about regions if it is the same for all that occur; else None.

        A fleet has so many pairs of vehicles that a look at each row for each pair would take too long.
        """
        if not subjects or not all(map(is_of_region, subjects)) or not self.size:
            return None
        present = [self.present[one] for one in subjects]
        if np.prod([len(each) for each in present], dtype=np.float64) > MOST_REGION_PAIRS:
            return None
        grid = np.meshgrid(*present, indexing="ij")
        tables = {one: self.tables[one][each.ravel()] for one, each in zip(subjects, grid, strict=True)}
        try:
            said = self._of(formula, tables, grid[0].size)
        except PhysicalError:  # of regions that may never occur together
            return None
        return bool(said[0]) if said.all() or not said.any() else None

    def _said(self, formula: Proposition, subjects: Subjects, there: Numbers) -> Bools:
        """Return the truth of a proposition for combined profile numbers of its subjects."""
        tables, rest = dict[Subject, Table](), there
        for one in reversed(subjects):
            rest, code = np.divmod(rest, len(self.tables[one]))
            tables[one] = self.tables[one][code]
        return self._of(formula, tables, len(there))

    def _of(self, formula: Proposition, tables: dict[Subject, Table], size: int) -> Bools:
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
        if isinstance(formula, RegionAtom):
            one, *others = (tables[each] for each in subjects_of_atom(formula))
            return self.profiles.regions.relate(formula, one, others[0] if others else one)
        true: Bools = tables[subject(formula)][:, self.profiles.ranks[formula]]
        return true

    def _worth_asking(self, parts: Instances, tables: dict[Subject, Table]) -> Iterator[Proposition]:
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
            yield from subjects_of_atom(formula)
