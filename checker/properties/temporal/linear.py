"""Linear time: a short fair run on which a formula is false, if there is one."""

from checker.engines.graph import Bools, Graph
from checker.properties.temporal.buchi_automaton import automaton_of
from checker.properties.temporal.components import Conditions, fair_components
from checker.properties.temporal.lassos import Lasso, fair_cycles, tightened
from checker.properties.temporal.product import Product, product_of
from checker.properties.temporal.truth import FormulaTruth
from semantics.properties.temporal import Temporal, conjuncts


def counterexample(
    graph: Graph, truth: FormulaTruth, formula: Temporal, fairness: Conditions
) -> Lasso | None:
    """Return a fair run from configuration 0 on which a formula is false; None if there is none.

    Conjuncts are decided separately, since their automata are smaller. A run without a loop comes first: it refutes the
    formula with any continuation, and there is always a fair one.

    Args:
        graph: The explored graph, total. If it is partial, None is no proof.
        truth: The truth of atoms.
        formula: The formula.
        fairness: The conditions of fair runs.

    Raises:
        TooLargeError: The automaton of some conjunct would be too large.
    """
    runs = (_counterexample(graph, truth, each, fairness) for each in conjuncts(formula))
    found = (each for each in runs if each is not None)
    return min(found, key=lambda lasso: (bool(lasso.loop), len(lasso)), default=None)


def _counterexample(
    graph: Graph, truth: FormulaTruth, formula: Temporal, fairness: Conditions
) -> Lasso | None:
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
