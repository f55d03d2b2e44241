"""Linear time: is a formula false on some fair run? If so, find a shortest such run where possible."""

from collections.abc import Collection

from checker.engines.graph import Bools, Graph
from checker.properties.temporal.automaton import automaton_of
from checker.properties.temporal.components import Conditions, fair_components
from checker.properties.temporal.lassos import Lasso, fair_cycles, tightened
from checker.properties.temporal.product import Product, product_of
from checker.properties.temporal.shortest import shortest_false
from checker.properties.temporal.truth import Truth
from semantics.properties.temporal import Both, Globally, Temporal


def shortest_counterexample(
    graph: Graph, truth: Truth, formula: Temporal, fairness: Conditions
) -> Lasso | None:
    """Return what `counterexample` does, with as short a loop as can be found, and whether it is known to be shortest.

    Raises:
        TooLargeError: The automaton of some conjunct would be too large.
    """
    found = counterexamples(graph, truth, formula, fairness)
    known = least(found.values())
    if known is None or not known.loop:
        return known
    return shortest_false(graph, truth, found, fairness, known)


def counterexample(graph: Graph, truth: Truth, formula: Temporal, fairness: Conditions) -> Lasso | None:
    """Return a fair run from configuration 0 on which a formula is false; None if there is none.

    Without a loop it is a run after which the formula is false whatever follows: a fair continuation there always
    is.

    Args:
        graph: The explored graph, total. If it is partial, None is no proof.
        truth: The truth of atoms.
        formula: The formula.
        fairness: The conditions of fair runs.

    Raises:
        TooLargeError: The automaton of some conjunct would be too large.
    """
    return least(counterexamples(graph, truth, formula, fairness).values())


def counterexamples(
    graph: Graph, truth: Truth, formula: Temporal, fairness: Conditions
) -> dict[Temporal, Lasso]:
    """Return a run for each conjunct that is violated; they are decided one by one, as their automata are smaller."""
    found = {each: _counterexample(graph, truth, each, fairness) for each in conjuncts(formula)}
    return {each: lasso for each, lasso in found.items() if lasso is not None}


def least(found: Collection[Lasso]) -> Lasso | None:
    """Return the shortest of some runs; those that need no loop come first, as they say more."""
    return min(found, key=lambda lasso: (bool(lasso.loop), len(lasso)), default=None)


def conjuncts(formula: Temporal) -> list[Temporal]:
    """Return the conjuncts of a formula, with `[]` distributed over them."""
    match formula:
        case Both(left, right):
            return [*conjuncts(left), *conjuncts(right)]
        case Globally(Both(left, right)):
            return [*conjuncts(Globally(left)), *conjuncts(Globally(right))]
    return [formula]


def _counterexample(graph: Graph, truth: Truth, formula: Temporal, fairness: Conditions) -> Lasso | None:
    automaton = automaton_of(formula, claimed=False)
    if not automaton.moves[0]:
        return None
    product = product_of(graph, automaton, truth)
    if product.prefix is not None:
        return Lasso(product.prefix, shortest=graph.partial is None)
    known = None if fairness.none else ~graph.open[product.configurations]
    return _lasso(product, product.conditions(automaton.marks, fairness), known)


def _lasso(product: Product, conditions: Conditions, within: Bools | None) -> Lasso | None:
    """Return a lasso; `within` are the nodes with known successors, if enabledness is relevant."""
    components = fair_components(product, conditions, within)
    lassos = (  # nodes are numbered by distance: the nearest come first
        Lasso(product.way_to(node), tuple(int(product.edges[edge]) for edge in cycle))
        for node, cycle in fair_cycles(product, components, conditions)
    )
    return min(map(tightened, lassos), key=len, default=None)
