"""Slices: the results of a worker's copy of an exploration, as plain values, and their merge into the original.

A copy starts with the states and subtrees that were known at its creation. It numbers new ones by itself. The merge
translates these numbers to those of a search without workers.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from bigraphs.compact_lists import DictionaryColumn
from bigraphs.engine.frontier import Block, Frontier
from bigraphs.engine.intern_tables import Codes, InternTables, Row
from bigraphs.engine.labelling import labels_in
from bigraphs.engine.state_arrays import Key, codes_in, to_key
from bigraphs.state_store import StateStore
from bigraphs.transitions import TransitionKind


@dataclass(frozen=True, slots=True)
class StateSlice:
    """The additions of a copy after the expansion of some states.

    Attributes:
        rows: The rows of the new subtrees.
        keys: The canonical keys of the new states, equal to `raw` where these are canonical.
        raw: The raw keys of the new states.
        doubtful: The new states whose canonical keys contain labels that the original may number differently.
        found_from: For each new state its predecessor in the search.
        holding: For each new state the predicates that hold in it.
        blocks: The new states, packed.
        ends: For each expanded state the number of transitions up to and including its own.
        targets: For each transition its target state.
        kinds: For each transition its other fields.
        occurrences: For each expanded state the number of occurrences.
    """

    rows: list[Row]
    keys: list[Key]
    raw: list[Key]
    doubtful: frozenset[int]
    found_from: array[int]
    holding: DictionaryColumn[tuple[int, ...]]
    blocks: list[Block]
    ends: array[int]
    targets: array[int]
    kinds: DictionaryColumn[TransitionKind]
    occurrences: array[int]


def slices_of(copy: StateStore, pieces: Sequence[tuple[int, int]]) -> Iterator[bytes]:
    """Expand pieces of the queue in a copy, which is useless afterwards; a piece skips states, then expands some."""
    import pickle  # noqa: PLC0415 - a small system has no workers

    queue, copy.max_states, labels = copy.waiting, None, len(copy.machine.labelling)
    source = copy.expanded
    for skipped, count in pieces:
        queue.drop(skipped)
        yield pickle.dumps(_slice(copy, queue, range(source + skipped, source + skipped + count), labels))
        source += skipped + count


def _slice(copy: StateStore, queue: Frontier, sources: range, labels: int) -> StateSlice:
    """Expand the first states of a queue; the labels of canonical keys below `labels` are known to the original."""
    world, expanded, occurrences = copy.machine.world, copy.expanded, array("Q")
    states, rows, transitions = len(copy), len(world.rows), len(copy.targets)
    copy.waiting = Frontier(copy.start)
    for source in sources:
        copy.occurrences = 0
        copy.expand(queue.popleft(), source)
        occurrences.append(copy.occurrences)
    raw = copy.keys[states:]
    keys = raw if world.plain else copy.visited.texts[states:]
    new_labels = len(copy.machine.labelling) > labels
    return StateSlice(
        world.rows[rows:],
        keys,
        raw,
        frozenset(_doubtful(keys, labels) if new_labels else ()),
        copy.found_from[states:],
        DictionaryColumn(copy.holding[states:]),
        copy.waiting.blocks(),
        array("Q", [end - transitions for end in copy.first[expanded + 1 :]]),
        copy.targets[transitions:],
        DictionaryColumn(copy.kinds[transitions:]),
        occurrences,
    )


def _doubtful(keys: Sequence[Key], labels: int) -> Iterator[int]:
    return (place for place, key in enumerate(keys) if max(labels_in(key), default=0) >= labels)


class Copy:
    """The translation of a copy's numbers to this exploration; numbers assigned before the copy are equal."""

    def __init__(self, reached: StateStore) -> None:
        """Store the sizes of the tables at the creation of the copy."""
        self.reached = reached
        self.states = len(reached)
        self.numbers: list[int] = []
        self.codes = Codes(len(reached.machine.world.rows), [])

    def take_over(self, answer: bytes) -> bool:
        """Merge a copy's slice for the longest waiting states; return whether the limit of states allowed all of it."""
        import pickle  # noqa: PLC0415 - a small system has no workers

        found: StateSlice = pickle.loads(answer)
        reached, first, before = self.reached, len(self.reached), len(self.numbers)
        reached.machine.world.adopt(self.codes, found.rows)
        self._number(found)
        numbers = self.numbers[before:]
        whole = len(numbers) == len(found.keys)
        expanded = len(found.ends) if whole else found.found_from[len(numbers)] - reached.expanded
        self._keep(found, expanded)
        reached.waiting.drop(expanded)
        reached.waiting.extend(self._new_blocks(found.blocks, [number >= first for number in numbers]))
        return whole

    def _number(self, found: StateSlice) -> None:
        """Number the states that were new to the copy, up to the limit of states."""
        reached, machine = self.reached, self.reached.machine
        for place, raw in enumerate(found.raw):
            known = _recoded(machine.world, raw, self.codes) if self.codes.here else raw
            doubtful = machine.world.plain or place in found.doubtful
            key = machine.labelling.canonical_of(known) if doubtful else found.keys[place]
            number = reached.visited.find(key)
            if number < 0:
                if reached.full():
                    break
                number = reached.add(key, known, found.found_from[place], found.holding[place])
            if not machine.world.plain:
                reached.remember(known, number)
            self.numbers.append(number)

    def _keep(self, found: StateSlice, expanded: int) -> None:
        """Add the transitions of the first expanded states of a slice."""
        reached, states, numbers = self.reached, self.states, self.numbers
        end, before = found.ends[expanded - 1] if expanded else 0, len(reached.targets)
        reached.targets.extend(
            [target if target < states else numbers[target - states] for target in found.targets[:end]]
        )
        reached.kinds.extend(found.kinds, end)
        reached.first.extend([before + each for each in found.ends[:expanded]])
        reached.occurrences += sum(found.occurrences[:expanded])

    def _new_blocks(self, blocks: Sequence[Block], is_new: Sequence[bool]) -> Iterator[Block]:
        """Yield the blocks, reduced to the new states."""
        start = 0
        for block in blocks:
            kept = [place for place, new in enumerate(is_new[start : start + len(block)]) if new]
            start += len(block)
            if kept:
                yield replace(block, kept=array("I", kept), codes=self.codes if self.codes.here else None)


def _recoded(world: InternTables, key: Key, codes: Codes) -> Key:
    return to_key(world, [codes.translated(inside) for inside in codes_in(world, key)])
