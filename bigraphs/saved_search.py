"""Saved searches: the plain data from which an exploration continues after its process was killed.

It has the interned subtrees and the keys of all states, their predicates, and the transitions of expanded states. Of a
waiting state it also has the slots of its nodes, since they order its steps. It has no rule, and nothing in it is ever
evaluated. `bigraphs.resumption` compares it with the system.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final, NamedTuple, Protocol

from bigraphs.compact_lists import Column, DictionaryColumn, Texts, Value
from bigraphs.engine.intern_tables import REFERENCE, InternTables, Row
from bigraphs.engine.machine import Machine
from bigraphs.state_store import StateStore
from bigraphs.transitions import TransitionKind

MOST_NODES: Final = 1 << 20
"""The most nodes, slots and edges of a state that is read."""

ARRAYS: Final = {
    "rows": "q",
    "keys": "B",
    "ends": "Q",
    "holding": "I",
    "first": "Q",
    "targets": "I",
    "kinds": "I",
    "slots": "I",
}
"""The arrays of a saved search, each with the type of its numbers."""


class Bytes(Protocol):
    """An array, of any library."""

    def tobytes(self) -> bytes:
        """Return its content."""
        ...


class SavedSearch(NamedTuple):
    """A saved search: values that JSON can hold, and the arrays of `ARRAYS`."""

    head: Mapping[str, Any]
    arrays: Mapping[str, Bytes]


def save(store: StateStore, seconds: float) -> SavedSearch:
    """Return the search up to the last state with all its transitions, after so many seconds in all.

    The arrays are views: while they are held, the search cannot continue.
    """
    expanded, states = store.expanded, store.reached
    transitions = store.first[expanded]
    rows = array("q")
    for label, ports, kids, itself in store.machine.world.rows:
        rows.extend((label, itself, len(ports), len(kids), *ports, *kids))
    head = {
        "seconds": seconds,
        "occurrences": store.occurrences,
        "holding": store.holding.values,
        "kinds": store.kinds.values,
    }
    arrays: dict[str, Bytes] = {
        "rows": memoryview(rows),
        "keys": beginning(store.keys.whole, store.keys.ends[states]),
        "ends": beginning(store.keys.ends, states + 1),
        "holding": array("I", beginning(store.holding.codes, states)),
        "first": beginning(store.first, expanded + 1),
        "targets": beginning(store.targets, transitions),
        "kinds": array("I", beginning(store.kinds.codes, transitions)),
        "slots": store.waiting.slots(states - expanded),
    }
    return SavedSearch(head, arrays)


def beginning(column: bytearray | Column, count: int) -> memoryview:
    """Return the first numbers of a column, without a copy."""
    return memoryview(column)[:count] if isinstance(column, array | bytearray) else column.beginning(count)


@dataclass(frozen=True, slots=True)
class SearchContent:
    """A saved search whose numbers are within their bounds.

    Attributes:
        rows: The rows of the subtrees.
        keys: The raw key of each state.
        holding: For each state the predicates that hold in it.
        first: For each expanded state its first transition, and their number at the end.
        targets: For each transition its target state.
        found_from: For each state its predecessor in the search.
        kinds: For each transition its other fields.
        slots: The slots of the nodes of waiting states, in one list.
        occurrences: The number of occurrences.
        seconds: The time of the search so far.
    """

    rows: list[Row]
    keys: Texts
    holding: DictionaryColumn[tuple[int, ...]]
    first: array[int]
    targets: array[int]
    found_from: array[int]
    kinds: DictionaryColumn[TransitionKind]
    slots: array[int]
    occurrences: int
    seconds: float

    @property
    def expanded(self) -> int:
        """The number of expanded states."""
        return len(self.first) - 1


def read(machine: Machine, saved: SavedSearch) -> SearchContent:
    """Return a saved search whose numbers are within the bounds of a system.

    Raises:
        ValueError: A number is out of its bounds; also IndexError, KeyError or TypeError for other damage.
    """
    head = saved.head
    parts = {name: array(kind, saved.arrays[name].tobytes()) for name, kind in ARRAYS.items()}
    keys, first = Texts(), parts["first"]
    keys.whole, keys.ends = bytearray(saved.arrays["keys"].tobytes()), parts["ends"]
    _check_steps(keys.ends, len(keys.whole))
    _check_steps(first, len(parts["targets"]))
    if not len(first) - 1 <= len(keys) or not len(keys):
        raise ValueError("it has more expanded states than states")
    if len(parts["holding"]) != len(keys) or len(parts["kinds"]) != len(parts["targets"]):
        raise ValueError("its arrays do not fit together")
    if max(parts["slots"], default=0) >= MOST_NODES:
        raise ValueError(f"a state has over {MOST_NODES:,} nodes")
    if type(head["occurrences"]) is not int or not _is_number(head["seconds"], 0):
        raise ValueError("its counts are wrong")
    return SearchContent(
        list(_rows(machine.world, parts["rows"])),
        keys,
        _column(_predicates(machine, head["holding"]), parts["holding"]),
        first,
        parts["targets"],
        _predecessors(len(keys), first, parts["targets"]),
        _column(_kinds(machine, head["kinds"]), parts["kinds"]),
        parts["slots"],
        head["occurrences"],
        head["seconds"],
    )


def _is_number(given: object, least: float) -> bool:
    return type(given) in {int, float} and least <= given < math.inf  # type: ignore[operator]  # a number


def _check_steps(ends: array[int], last: int) -> None:
    if not len(ends) or ends[0] or ends[-1] != last or any(one > other for one, other in pairwise(ends)):
        raise ValueError("the parts of an array do not follow each other")


def _column(values: Iterable[Value], codes: array[int]) -> DictionaryColumn[Value]:
    found: DictionaryColumn[Value] = DictionaryColumn()
    for value in values:
        found.code(value)
    if max(codes, default=-1) >= len(found.values):
        raise ValueError("it has unknown predicates or transitions")
    found.codes = codes
    return found


def _predicates(machine: Machine, given: Sequence[Sequence[int]]) -> Iterator[tuple[int, ...]]:
    known = set(range(len(machine.system.predicates)))
    for numbers in given:
        if list(numbers) != sorted(set(numbers)) or not known.issuperset(numbers):
            raise ValueError("it has unknown predicates")
        yield tuple(numbers)


def _kinds(machine: Machine, given: Sequence[Sequence[Any]]) -> Iterator[TransitionKind]:
    labels = {reaction.label for reaction in machine.reactions}
    actions = {each.name for each in machine.system.actions} | {None}
    for weight, rules, occurrences, action in given:
        if (
            not rules
            or list(rules) != sorted(set(rules))
            or not labels.issuperset(rules)
            or action not in actions
        ):
            raise ValueError("it has transitions by unknown rules")
        if (
            type(occurrences) is not int
            or occurrences < len(rules)
            or not _is_number(weight, 0)
            or not weight
        ):
            raise ValueError("it has transitions with impossible weights")
        yield TransitionKind(float(weight), tuple(rules), occurrences, action)


def _predecessors(states: int, first: array[int], targets: array[int]) -> array[int]:
    """Return the predecessor of each state; raise ValueError unless the transitions reach the states in order."""
    found = array("I", (0,))
    for source, (start, end) in enumerate(pairwise(first)):
        if source >= len(found):
            raise ValueError("some state is no successor of an earlier state")
        for target in targets[start:end]:
            if target == len(found):
                found.append(source)
            elif target > len(found):
                raise ValueError("some state is no successor of an earlier state")
    if len(found) != states:
        raise ValueError("some state is no successor of an earlier state")
    return found


def _rows(world: InternTables, numbers: array[int]) -> Iterator[Row]:
    """Yield the rows; each stands behind those of its children, and none has too many nodes."""
    place, sizes = 0, list[int]()
    shared = list[bool]()
    while place < len(numbers):
        label, itself, ports, kids = numbers[place : place + 4]
        middle, end = place + 4 + ports, place + 4 + ports + kids
        if min(ports, kids) < 0 or end > len(numbers):
            raise ValueError("a subtree is cut short")
        row = label, tuple(numbers[place + 4 : middle]), tuple(numbers[middle:end]), itself
        inside = row[2]
        if list(inside) != sorted(inside) or not all(
            0 <= kid < len(sizes) and not shared[kid] for kid in inside
        ):
            raise ValueError("a subtree has unknown parts")
        _check_row(world, row)
        sizes.append(1 + sum(sizes[kid] for kid in inside))
        shared.append(itself != 0)
        if sizes[-1] > MOST_NODES:
            raise ValueError(f"a subtree has over {MOST_NODES:,} nodes")
        yield row
        place = end


def _check_row(world: InternTables, row: Row) -> None:
    """Raise ValueError unless a row is that of a node of this world, or a reference to a shared node."""
    label, ports, kids, itself = row
    slots = (*ports, itself) if label == REFERENCE else (itself,)
    if any(slots) and not (world.sharing and all(-MOST_NODES <= slot <= 0 for slot in slots)):
        raise ValueError("a node has several parents")
    if label == REFERENCE:
        if len(ports) != 1 or not ports[0] or kids or itself:
            raise ValueError("a reference to a node is wrong")
        return
    if not 0 <= label < len(world.control_of):
        raise ValueError("a node has an unknown control")
    control = world.signature.controls[world.control_of[label]]
    if control.arity not in (None, len(ports)) or (kids and control.status == "atomic"):
        raise ValueError(f"a node is no {control.name}")
    edges = 0 if world.plain else MOST_NODES
    if not all(0 <= link < len(world.names) + edges for link in ports):
        raise ValueError("a node has an unknown link")
    if not control.ordered and list(ports) != sorted(ports):
        raise ValueError("the links of a node are not in order")
