"""What a copy of an exploration finds out about a slice of what waits, as plain values, and how it is taken over.

The copy knows what had been reached when it was made. What it numbers from there on, states and subtrees, gets the
numbers here that it would have got without a copy.
"""

from __future__ import annotations

import pickle
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
    """What the expansion of some states has added.

    Attributes:
        states: How many states there were before; new ones are numbered from there on.
        rows_before: How many subtrees the world knew before.
        rows: Those that are new.
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

    states: int
    rows_before: int
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


def slice_of(copy: Reached, skipped: int, count: int) -> bytes:
    """Expand, in a copy that is good for nothing afterwards, some of the states that wait after others."""
    world, labelling = copy.machine.world, copy.machine.labelling
    states, rows, labels, transitions = len(copy), len(world.rows), len(labelling), len(copy.targets)
    source, before, queue = copy.expanded + skipped, copy.expanded, copy.waiting
    queue.drop(skipped)
    copy.waiting, copy.max_states, occurrences = Waiting(copy.start), None, array("Q")
    for number in range(count):
        copy.occurrences = 0
        copy.expand(queue.popleft(), source + number)
        occurrences.append(copy.occurrences)
    raw = copy.keys[states:]
    keys = raw if world.plain else copy.visited.texts[states:]
    added = Slice(
        states,
        rows,
        world.rows[rows:],
        keys,
        raw,
        frozenset(_doubtful(keys, labels)) if len(labelling) > labels else frozenset(),
        copy.found_from[states:],
        Column(copy.holding[states:]),
        copy.waiting.blocks(),
        array("Q", [end - transitions for end in copy.first[before + 1 :]]),
        copy.targets[transitions:],
        Column(copy.kinds[transitions:]),
        occurrences,
    )
    return pickle.dumps(added, pickle.HIGHEST_PROTOCOL)


def _doubtful(keys: Sequence[Key], labels: int) -> Iterator[int]:
    return (place for place, key in enumerate(keys) if max(labels_in(key), default=0) >= labels)


def take_over(reached: Reached, answer: bytes) -> bool:
    """Add what a copy has found out about the states that wait longest; say whether there was room for all of it."""
    found: Slice = pickle.loads(answer)
    codes = reached.machine.world.adopt(found.rows_before, found.rows)
    first = len(reached)
    numbers = _numbered(reached, found, codes)
    whole = len(numbers) == len(found.keys)
    expanded = len(found.ends) if whole else found.found_from[len(numbers)] - reached.expanded
    _keep(reached, found, numbers, expanded)
    reached.waiting.drop(expanded)
    reached.waiting.extend(_new_blocks(found.blocks, codes, [number >= first for number in numbers]))
    return whole


def _numbered(reached: Reached, found: Slice, codes: Codes) -> list[int]:
    """Number the states that the copy took for new, as far as there is room for those that are."""
    machine, numbers = reached.machine, list[int]()
    for place, (key, raw) in enumerate(zip(found.keys, found.raw, strict=True)):
        known = _recoded(machine.world, raw, codes) if codes.here else raw
        if machine.world.plain:
            key = known
        elif place in found.doubtful:
            key = machine.labelling.canonical_of(known)
        number = reached.visited.find(key)
        if number < 0:
            if reached.full():
                break
            number = reached.add(key, known, found.found_from[place], found.holding[place])
        if not machine.world.plain:
            reached.remember(known, number)
        numbers.append(number)
    return numbers


def _recoded(world: World, key: Key, codes: Codes) -> Key:
    return to_key(world, [codes.translated(inside) for inside in codes_in(world, key)])


def _keep(reached: Reached, found: Slice, numbers: Sequence[int], expanded: int) -> None:
    """Add the transitions of the first states of a slice."""
    end, before = found.ends[expanded - 1] if expanded else 0, len(reached.targets)
    new = found.states
    reached.targets.extend(
        [target if target < new else numbers[target - new] for target in found.targets[:end]]
    )
    reached.kinds.extend(found.kinds, end)
    reached.first.extend([before + each for each in found.ends[:expanded]])
    reached.occurrences += sum(found.occurrences[:expanded])


def _new_blocks(blocks: Sequence[Block], codes: Codes, is_new: Sequence[bool]) -> Iterator[Block]:
    """Yield what of some blocks is new, the states of which the exploration would have numbered in this order."""
    start = 0
    for block in blocks:
        kept = [place for place, new in enumerate(is_new[start : start + len(block)]) if new]
        start += len(block)
        if kept:
            yield replace(block, kept=array("I", kept), codes=codes if codes.here else None)
