"""Shortest runs into a fair component: whether a shorter one exists, if a bounded search can decide it."""

from dataclasses import replace

from checker.engines.graph import Bools, Graph, Numbers
from checker.properties.temporal.components import Conditions
from checker.properties.temporal.cycles import shortest_cycle
from checker.properties.temporal.digraph import distances, shortest
from checker.properties.temporal.effort import Effort, Exhausted
from checker.properties.temporal.lassos import Lasso, component_of, fair_cycle, tightened


def run_into(
    graph: Graph, components: Numbers, conditions: Conditions, entry: int, by: Bools | None = None
) -> Lasso:
    """Return a run that stays in a fair component, as short as the search finds; `entry` is in the nearest one."""
    part = component_of(graph, components, entry, conditions, by=by)
    stem = shortest(graph, 0, graph.targets == entry) if entry else ()
    assert stem is not None  # every explored configuration is reachable
    known = tightened(Lasso(stem, fair_cycle(part, entry)))
    return shortest_run(graph, components, conditions, known, by=by)


def shortest_run(  # noqa: PLR0913  # independent parameters
    graph: Graph,
    components: Numbers,
    conditions: Conditions,
    known: Lasso,
    *,
    start: int = 0,
    through: Bools | None = None,
    by: Bools | None = None,
) -> Lasso:
    """Return a shortest lasso to a fair component, given one; `shortest` is set if it is certain.

    Args:
        graph: The graph.
        components: The fair components.
        conditions: The conditions of its loop.
        known: A lasso.
        start: Its first configuration.
        through: The configurations that it may visit; by default all.
        by: The edges that its loop may take; by default all.
    """
    if graph.partial is not None:
        return known
    effort = Effort()
    try:
        depths = distances(graph, start, len(known) - 2, effort, through)
        found = shortest_cycle(graph, depths, components, conditions, len(known), effort, by)
    except Exhausted:
        return known
    if found is None:
        return replace(known, shortest=True)
    node, loop = found
    stem = () if node == start else shortest(graph, start, graph.targets == node, through)
    assert stem is not None  # it has a depth
    return Lasso(stem, loop, shortest=True)
