"""Cross-check (`--paranoid`): the interpreter recomputes the successors of a sample of configurations."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator

from checker.engines.fast.model.learner import is_crowded
from checker.engines.fast.search.expander import Expander
from checker.limits import look
from checker.reduction.footprint_check import heed
from checker.reduction.reducer import Reduced
from semantics.state.configuration import Configuration
from semantics.state.printing import print_configuration
from semantics.successors import expand


class Disagreement(Exception):
    """The learned successors differ from the interpreter's: a bug of this program."""


Successors = Iterator[tuple[int, Configuration | None]]
"""The transitions of a row, each with its target; None for one that is not stored."""


def in_store(expander: Expander, number: int) -> Successors:
    """Yield the successors of a row as they are stored."""
    for _, steps, targets in expander.edges(range(number, number + 1)):
        for step, target in zip(steps.tolist(), targets.tolist(), strict=True):
            yield step, None if target < 0 else expander.model.configuration(target)


def in_batch(expander: Expander, number: int) -> Successors:
    """Yield the successors of a row of a plain store as they are made: others may store them."""
    where, model = expander.store.packing, expander.model
    for _, steps, _ in expander.edges(range(number, number + 1)):
        for step, words in zip(steps.tolist(), expander.batch.kept.reshape(-1, where.words), strict=False):
            cells = model.learner.columns.row(where.codes(words))
            yield step, Configuration(model.learner.setting, cells)


def crosscheck(
    expander: Expander,
    numbers: Iterable[int],
    reduce: Reduced | None = None,
    successors: Callable[[Expander, int], Successors] = in_store,
) -> None:
    """Compare learned successors of rows, and the assumptions of reductions and race monitor, with the interpreter.

    Raises:
        Disagreement: The successors of some configuration differ; the message names it.
    """
    for number in numbers:
        look()
        compare(expander, number, reduce, successors(expander, number))
        heed(expander.model.configuration(number))
        if reduce is not None:
            reduce.hold(expander.model.configuration(number))


def compare(expander: Expander, number: int, reduce: Reduced | None, successors: Successors) -> None:
    """Compare the learned successors of one configuration with the interpreter's, by rule and number.

    Under symmetry reduction, the interpreter's successors are first replaced by their representatives.
    """
    c = expander.model.configuration(number)
    learned: Counter[tuple[str, Configuration]] = Counter()
    left_out = 0
    for step, target in successors:
        if target is None:
            left_out += 1  # beyond the limit of configurations, or deferred by partial-order reduction
        else:
            learned[expander.model.learner.steps[step].rule, target] += 1
    is_left = any(
        is_crowded(c, a, expander.model.learner.pending) for a in c.alpha.names()
    )  # then the row has no successors
    represent = (lambda target: target) if reduce is None else reduce.representative
    ruled = Counter((t.label.rule, represent(t.target)) for t in (() if is_left else expand(c).transitions))
    unexpected = left_out > 0 and not expander.store.was_cut and expander.choosing is None
    if learned - ruled or (ruled - learned).total() != left_out or unexpected:
        wrong = ", ".join(sorted({rule for rule, _ in (learned - ruled) + (ruled - learned)}))
        raise Disagreement(f"configuration {number}: {wrong}\n{print_configuration(c)}")
