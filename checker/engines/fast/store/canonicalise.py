"""Symmetry reduction in compiled loops: replaces a row by its canonical representative.

They compute the same as `checker.reduction.representatives`, from the tables of `symmetry_tables`.
"""

# mypy: disable-error-code="return-value, assignment, arg-type"
# numba types these functions; mypy would read their integers as Python's

from typing import NamedTuple

import numpy as np

from checker.engines.fast.compiled.jit_decorators import inner, njit
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.model.learned_model import PLACE, Ints, State, code_at

UNKNOWN, FIXED = 0, 1
"""Codes instead of an entry: not learned yet; mentions no member."""

ENTRY, WHOLE, TARGET = range(3)
"""Kinds of missing knowledge: the entry of a code, the entry of a whole cell, or a move."""

UNSETTLED = -1

KIND, WHAT, COUNT, LISTED = range(4)
"""The layout of a miss: its kind, its subject, the number of its arguments, and the arguments."""

MULTIPLIER, FINISHER = np.uint64(0x9E3779B97F4A7C15), np.uint64(0xBF58476D1CE4E5B9)


class Exchanges(NamedTuple):
    """The learned tables of members, entries and moves.

    Attributes:
        active: The columns that have bits, skeletons first.
        skeleton: The column of the skeleton for each column.
        holes_from, holes: The columns of the holes for each skeleton column.
        begins, widths, entries: The entries of each column's codes: the first, and their number. A negative entry is a
            node; from it, the codes of the cell's holes lead to the entry.
        shapes, mentions_from, who, roles: For each entry, the node of its shape, and the members that it mentions with
            their roles.
        own: The number of the item of each entry.
        keys, values: The edges from node and number to node, as a hash table.
        payload: The entry or move at each node.
        writes_from, writes, numbers: For each move, its columns with their codes, and the number of the item.
        classes: The class of each member.
        most: The greatest number of orders to try.
    """

    active: Ints
    skeleton: Ints
    holes_from: Ints
    holes: Ints
    begins: Ints
    widths: Ints
    entries: Ints
    shapes: Ints
    mentions_from: Ints
    who: Ints
    roles: Words
    own: Words
    keys: Words
    values: Ints
    payload: Ints
    writes_from: Ints
    writes: Ints
    numbers: Words
    classes: Ints
    most: int


class RowScratch(NamedTuple):
    """Scratch space for one row.

    Attributes:
        here: Its columns with a code other than 0, with their codes and entries.
        whole: For each skeleton column, the last row that read its cell as one item.
        colours, met: Two numbers for each member.
        order, place: The members in order, and the position of each.
        beside: Whether an item mentions the member together with others.
        best: The positions in the best order so far.
        unknown: The missing entry or move.
        stamp: The number of rows so far, which identifies the row in `whole`.
        image: The words of its representative.
    """

    here: Ints
    whole: State
    colours: Words
    met: Words
    order: Ints
    place: Ints
    beside: Ints
    best: Ints
    unknown: Ints
    stamp: State
    image: Words


@njit(cache=True, forceinline=True)
def mix(one: np.uint64, other: np.uint64) -> np.uint64:
    """Return the same as `items.mix`."""
    mixed = (one ^ (one >> np.uint64(32))) * MULTIPLIER + other
    mixed = (mixed ^ (mixed >> np.uint64(29))) * FINISHER
    return mixed ^ (mixed >> np.uint64(32))


@njit(cache=True, forceinline=True)
def slot_for(keys: Words, key: np.uint64) -> np.uint64:
    """Return the slot of a key in an open-addressing table whose size is a power of two, or the slot for it."""
    last = np.uint64(len(keys) - 1)
    slot = (key * MULTIPLIER) >> np.uint64(20) & last
    while keys[slot] != 0 and keys[slot] != key:
        slot = (slot + np.uint64(1)) & last
    return slot


@njit(cache=True, forceinline=True)
def led(keys: Words, values: Ints, node: int, number: int) -> int:
    """Return the target of an edge from a node, 0 if there is none."""
    slot = slot_for(keys, (np.uint64(node) << np.uint64(32)) | np.uint64(number))
    return np.int64(values[slot]) if keys[slot] != 0 else np.int64(0)


@njit(cache=True)
def enter_all(keys: Words, values: Ints, new: Words, to: Ints) -> None:
    """Insert keys with their values."""
    for k in range(len(new)):
        slot = slot_for(keys, new[k])
        keys[slot], values[slot] = new[k], to[k]


@inner(cache=True)
def read_whole(
    x: Exchanges, d: RowScratch, words: Words, at: int, columns: Words, column: int, node: int
) -> int:
    """Return the entry of a whole cell, UNKNOWN if it is not learned yet."""
    d.unknown[KIND], d.unknown[WHAT], count = WHOLE, column, 0
    for k in range(x.holes_from[column], x.holes_from[column + 1]):
        code = code_at(words, at, columns, x.holes[k])
        if code != 0:
            d.unknown[LISTED + count], d.unknown[LISTED + count + 1] = x.holes[k], code
            count += 2
            if node != 0:
                node = led(x.keys, x.values, node, x.holes[k])
            if node != 0:
                node = led(x.keys, x.values, node, code)
    d.unknown[COUNT] = count
    return np.int64(x.payload[node])


@inner(cache=True)
def read_row(x: Exchanges, d: RowScratch, words: Words, at: int, columns: Words) -> int:
    """Note the entries of a row and colour its members; return the number of entries, -1 if one is unknown."""
    count = np.int64(0)
    d.stamp[0] += 1
    stamp = d.stamp[0]
    d.colours[:] = np.uint64(0)
    d.beside[:] = 0
    for a in range(len(x.active)):
        column = np.int64(x.active[a])
        code = code_at(words, at, columns, column)
        if code == 0 or (x.skeleton[column] != column and d.whole[x.skeleton[column]] == stamp):
            continue
        entry = np.int64(UNKNOWN)
        if code < x.widths[column]:
            entry = np.int64(x.entries[x.begins[column] + code])
        d.unknown[KIND], d.unknown[WHAT], d.unknown[COUNT], d.unknown[LISTED] = ENTRY, column, 1, code
        if entry < 0:
            d.whole[column] = stamp
            node = -entry
            entry = read_whole(x, d, words, at, columns, column, node)
            if entry == UNKNOWN:
                d.unknown[LISTED + d.unknown[COUNT]] = code
                d.unknown[COUNT] += 1
        if entry == UNKNOWN:
            return -1
        d.here[3 * count], d.here[3 * count + 1], d.here[3 * count + 2] = column, code, entry
        count += 1
        if entry != FIXED:
            begin, end = x.mentions_from[entry], x.mentions_from[entry + 1]
            for k in range(begin, end):
                d.colours[x.who[k]] += x.roles[k]
                if end - begin > 1:
                    d.beside[x.who[k]] = 1
    return count


@inner(cache=True)
def sort_members(x: Exchanges, d: RowScratch) -> int:
    """Sort the members of each class by colour, then by number; return the number of colours."""
    groups = np.int64(0)
    for k in range(len(d.order)):
        j = k
        while (
            j > 0 and x.classes[d.order[j - 1]] == x.classes[k] and d.colours[d.order[j - 1]] > d.colours[k]
        ):
            d.order[j] = d.order[j - 1]
            j -= 1
        d.order[j] = k
    k = np.int64(0)
    while k < len(d.order):
        k = end_of_group(x, d, k)
        groups += 1
    return groups


@inner(cache=True)
def end_of_group(x: Exchanges, d: RowScratch, begin: int) -> int:
    """Return the end of the group of equal members that begins at `begin`."""
    first = d.order[begin]
    end = begin + 1
    while (
        end < len(d.order)
        and x.classes[d.order[end]] == x.classes[first]
        and d.colours[d.order[end]] == d.colours[first]
    ):
        end += 1
    return end


@inner(cache=True)
def is_tied(d: RowScratch, begin: int, end: int) -> bool:
    """Return whether a group is tied: its order matters."""
    if end - begin > 1:
        for k in range(begin, end):
            if d.beside[d.order[k]]:
                return True
    return False


@inner(cache=True)
def first_tied(x: Exchanges, d: RowScratch, begin: int) -> int:
    """Return the begin of the first tied group from `begin` on; -1 if there is none."""
    while begin < len(d.order):
        end = end_of_group(x, d, begin)
        if is_tied(d, begin, end):
            return begin
        begin = end
    return -1


@inner(cache=True)
def refine(x: Exchanges, d: RowScratch, count: int) -> None:
    """Refine the colours of members by the colours of members in the same items."""
    d.met[:] = np.uint64(0)
    for h in range(count):
        entry = np.int64(d.here[3 * h + 2])
        begin, end = x.mentions_from[entry], x.mentions_from[entry + 1]
        if entry == FIXED or end - begin < 2:
            continue
        total = np.uint64(0)
        for k in range(begin, end):
            total += mix(x.roles[k], d.colours[x.who[k]])
        for k in range(begin, end):
            rest = total - mix(x.roles[k], d.colours[x.who[k]])
            d.met[x.who[k]] += mix(x.roles[k], rest)
    for k in range(len(d.colours)):
        d.colours[k] = mix(d.colours[k], d.met[k])


@inner(cache=True)
def orders_left(x: Exchanges, d: RowScratch) -> int:
    """Return the number of orders of tied members, at most `most` + 1."""
    found = np.int64(1)
    begin = first_tied(x, d, 0)
    while begin >= 0 and found <= x.most:
        end = end_of_group(x, d, begin)
        for k in range(2, end - begin + 1):
            found = min(found * k, x.most + 1)
        begin = first_tied(x, d, end)
    return found


@njit(cache=True, forceinline=True)
def move(x: Exchanges, d: RowScratch, entry: int) -> int:
    """Return the move of an entry under the present order, UNKNOWN if it is not learned yet."""
    node = np.int64(x.shapes[entry])
    begin, end = x.mentions_from[entry], x.mentions_from[entry + 1]
    for k in range(begin, end):
        node = led(x.keys, x.values, node, d.place[x.who[k]])
        if node == 0:
            break
    found = np.int64(x.payload[node])
    if found == UNKNOWN:
        d.unknown[KIND], d.unknown[WHAT], d.unknown[COUNT] = TARGET, entry, end - begin
        for k in range(begin, end):
            d.unknown[LISTED + k - begin] = d.place[x.who[k]]
    return found


@inner(cache=True)
def is_about(x: Exchanges, entry: int, one: int, other: int) -> bool:
    """Return whether an entry mentions one of two members."""
    found = False
    for k in range(x.mentions_from[entry], x.mentions_from[entry + 1]):
        found = found or x.who[k] == one or x.who[k] == other
    return found


@inner(cache=True)
def may_change(x: Exchanges, d: RowScratch, count: int, one: int, other: int) -> int:
    """Return 1 if the row is invariant under the swap of two members, 0 if not, UNSETTLED if a move is unknown."""
    difference = np.uint64(0)
    for k in range(len(d.place)):
        d.place[k] = k
    d.place[one], d.place[other] = other, one
    for h in range(count):
        entry = np.int64(d.here[3 * h + 2])
        if entry != FIXED and is_about(x, entry, one, other):
            to = move(x, d, entry)
            if to == UNKNOWN:
                return UNSETTLED
            difference += x.numbers[to] - x.own[entry]
    return 1 if difference == 0 else 0


@inner(cache=True)
def free_groups(x: Exchanges, d: RowScratch, count: int) -> bool:
    """Mark tied groups as free if their order does not matter; return False if a move is unknown."""
    begin = first_tied(x, d, 0)
    while begin >= 0:
        end, free = end_of_group(x, d, begin), np.int64(1)
        for k in range(begin + 1, end):
            free = may_change(x, d, count, d.order[k - 1], d.order[k])
            if free != 1:
                break
        if free == UNSETTLED:
            return False
        for k in range(begin, end if free == 1 else begin):
            d.beside[d.order[k]] = 0
        begin = first_tied(x, d, end)
    return True


@inner(cache=True)
def settle(x: Exchanges, d: RowScratch, count: int) -> int:
    """Sort the members; return the number of orders that remain, UNSETTLED if a move is unknown."""
    while True:
        groups, before = sort_members(x, d), np.int64(0)
        while groups > before and first_tied(x, d, 0) >= 0:
            before = groups
            refine(x, d, count)
            groups = sort_members(x, d)
        if not free_groups(x, d, count):
            return UNSETTLED
        left = orders_left(x, d)
        if left <= x.most:
            return left
        one = d.order[first_tied(x, d, 0)]
        d.colours[one] = mix(d.colours[one], np.uint64(1))


@inner(cache=True)
def next_order(x: Exchanges, d: RowScratch) -> bool:
    """Advance to the next order of tied members; False after the last."""
    begin = first_tied(x, d, 0)
    while begin >= 0:
        end = end_of_group(x, d, begin)
        k = end - 2
        while k >= begin and d.order[k] > d.order[k + 1]:
            k -= 1
        if k >= begin:
            j = end - 1
            while d.order[j] < d.order[k]:
                j -= 1
            d.order[k], d.order[j] = d.order[j], d.order[k]
        low, high = k + 1, end - 1
        while low < high:
            d.order[low], d.order[high] = d.order[high], d.order[low]
            low += 1
            high -= 1
        if k >= begin:
            return True
        begin = first_tied(x, d, end)
    return False


@inner(cache=True)
def note_places(d: RowScratch) -> bool:
    """Note the position of each member; return whether some member has moved."""
    moved = False
    for k in range(len(d.order)):
        d.place[d.order[k]] = k
        moved = moved or d.order[k] != k
    return moved


@njit(cache=True, forceinline=True)
def copy(source: Ints, target: Ints) -> None:
    """Copy numbers one by one: a slice assignment would allocate an array."""
    for k in range(len(source)):
        target[k] = source[k]


@inner(cache=True)
def choose_order(x: Exchanges, d: RowScratch, count: int) -> bool:
    """Find the best of all remaining orders; return False if a move is unknown."""
    best, found = np.uint64(0), False
    while True:
        note_places(d)
        spelling = np.uint64(0)
        for h in range(count):
            entry = np.int64(d.here[3 * h + 2])
            if entry != FIXED and x.mentions_from[entry] != x.mentions_from[entry + 1]:
                to = move(x, d, entry)
                if to == UNKNOWN:
                    return False
                spelling += x.numbers[to]
        if not found or spelling < best:
            best, found = spelling, True
            copy(d.place, d.best)
        if not next_order(x, d):
            break
    copy(d.best, d.place)
    return True


@njit(cache=True, forceinline=True)
def put(words: Words, at: int, columns: Words, column: int, code: int) -> None:
    """Write the code of a column into bits that are zero."""
    where = PLACE * column
    words[at + np.int64(columns[where])] |= np.uint64(code) << columns[where + 1]


@inner(cache=True)
def order_members(x: Exchanges, d: RowScratch, count: int) -> int:
    """Note the position of each member; return 1 if some member has moved, 0 if none, UNSETTLED if unknown."""
    left = settle(x, d, count)
    if left == UNSETTLED or (left > 1 and not choose_order(x, d, count)):
        return UNSETTLED
    return 1 if left > 1 or note_places(d) else 0


@inner(cache=True)
def represent(x: Exchanges, d: RowScratch, words: Words, at: int, width: int, columns: Words) -> bool:
    """Replace a row by its canonical representative; return False if an entry or move is unknown."""
    count = read_row(x, d, words, at, columns)
    moved = order_members(x, d, count) if count >= 0 else np.int64(UNSETTLED)
    if moved != 1:
        return moved == 0
    for h in range(count):  # before anything is written
        entry = np.int64(d.here[3 * h + 2])
        if entry != FIXED:
            to = move(x, d, entry)
            if to == UNKNOWN:
                return False
            d.here[3 * h], d.here[3 * h + 2] = -1, to
    for j in range(width):
        words[at + j] = np.uint64(0)
    for h in range(count):
        column, to = d.here[3 * h], d.here[3 * h + 2]
        if column >= 0:
            put(words, at, columns, column, d.here[3 * h + 1])
        else:
            for k in range(x.writes_from[to], x.writes_from[to + 1], 2):
                put(words, at, columns, x.writes[k], x.writes[k + 1])
    return True
