"""What a copy of an exploration finds out about pieces of what waits, as plain values, and how it is taken over.

The copy knows what had been reached when it was made. What it numbers from there on, states and subtrees, gets the
numbers here that it would have got without a copy.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from bigraphs.columns import Column
from bigraphs.engine.labelling import labels_in
from bigraphs.engine.state import Key, codes_in, to_key
from bigraphs.engine.waiting import Block, Waiting
from bigraphs.engine.world import Codes, Row, World
from bigraphs.reached import Reached
from bigraphs.transitions import Kind


@dataclass(frozen=True, slots=True)
class Slice:
    """What the expansion of some states has added to a copy.

    Attributes:
        rows: The subtrees that are new.
        keys: The canonical keys of the new states, the same as `raw` where these are canonical.
        raw: Their keys as they were found.
        doubtful: Which of the new states have labels in their canonical keys that were not known before.
        found_from: For each new state the one that it was found from.
        holding: For each new state the predicates that occur in it.
        blocks: The new states, packed.
        ends: For each expanded state how many of the transitions are its own or those of states before it.
        targets: For each transition the state that it leads to.
        kinds: For each transition the rest of it.
        occurrences: For each expanded state how many there are.
    """

    rows: list[Row]
    keys: list[Key]
    raw: list[Key]
    doubtful: frozenset[int]
    found_from: array[int]
    holding: Column[tuple[int, ...]]
    blocks: list[Block]
    ends: array[int]
    targets: array[int]
    kinds: Column[Kind]
    occurrences: array[int]


def slices_of(copy: Reached, pieces: Sequence[tuple[int, int]]) -> Iterator[bytes]:
    """Expand, in a copy that is good for nothing else, pieces of what waits: so many are skipped, so many expanded."""
    import pickle  # noqa: PLC0415 - a small system has no workers

    queue, copy.max_states, labels = copy.waiting, None, len(copy.machine.labelling)
    source = copy.expanded
    for skipped, count in pieces:
        queue.drop(skipped)
        yield pickle.dumps(_slice(copy, queue, range(source + skipped, source + skipped + count), labels))
        source += skipped + count


def _slice(copy: Reached, queue: Waiting, sources: range, labels: int) -> Slice:
    """Expand the first states of a queue; labels of canonical keys are known up to a number."""
    world, expanded, occurrences = copy.machine.world, copy.expanded, array("Q")
    states, rows, transitions = len(copy), len(world.rows), len(copy.targets)
    copy.waiting = Waiting(copy.start)
    for source in sources:
        copy.occurrences = 0
        copy.expand(queue.popleft(), source)
        occurrences.append(copy.occurrences)
    raw = copy.keys[states:]
    keys = raw if world.plain else copy.visited.texts[states:]
    new_labels = len(copy.machine.labelling) > labels
    return Slice(
        world.rows[rows:],
        keys,
        raw,
        frozenset(_doubtful(keys, labels) if new_labels else ()),
        copy.found_from[states:],
        Column(copy.holding[states:]),
        copy.waiting.blocks(),
        array("Q", [end - transitions for end in copy.first[expanded + 1 :]]),
        copy.targets[transitions:],
        Column(copy.kinds[transitions:]),
        occurrences,
    )


def _doubtful(keys: Sequence[Key], labels: int) -> Iterator[int]:
    return (place for place, key in enumerate(keys) if max(labels_in(key), default=0) >= labels)


class Copy:
    """What the numbers of a copy are here; those that were given before it was made are the same."""

    def __init__(self, reached: Reached) -> None:
        """Take what had been reached when the copy was made."""
        self.reached = reached
        self.states = len(reached)
        self.numbers: list[int] = []
        self.codes = Codes(len(reached.machine.world.rows), [])

    def take_over(self, answer: bytes) -> bool:
        """Add what the copy has found out about the states that wait longest; say whether there was room for it."""
        import pickle  # noqa: PLC0415 - as above

        found: Slice = pickle.loads(answer)
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

    def _number(self, found: Slice) -> None:
        """Number the states that the copy took for new, as far as there is room for those that are."""
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

    def _keep(self, found: Slice, expanded: int) -> None:
        """Add the transitions of the first states of a slice."""
        reached, states, numbers = self.reached, self.states, self.numbers
        end, before = found.ends[expanded - 1] if expanded else 0, len(reached.targets)
        reached.targets.extend(
            [target if target < states else numbers[target - states] for target in found.targets[:end]]
        )
        reached.kinds.extend(found.kinds, end)
        reached.first.extend([before + each for each in found.ends[:expanded]])
        reached.occurrences += sum(found.occurrences[:expanded])

    def _new_blocks(self, blocks: Sequence[Block], is_new: Sequence[bool]) -> Iterator[Block]:
        """Yield what of some blocks is new."""
        start = 0
        for block in blocks:
            kept = [place for place, new in enumerate(is_new[start : start + len(block)]) if new]
            start += len(block)
            if kept:
                yield replace(block, kept=array("I", kept), codes=self.codes if self.codes.here else None)


def _recoded(world: World, key: Key, codes: Codes) -> Key:
    return to_key(world, [codes.translated(inside) for inside in codes_in(world, key)])
