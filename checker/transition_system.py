"""The explored transition system, as a networkx graph and as a pandas table."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from checker.engines.contract import Exploration
from checker.engines.graph import Graph, graph_of
from checker.steps import step_of
from physical.wordings import install_extra
from semantics.state.requests import Received

if TYPE_CHECKING:
    from networkx import MultiDiGraph
    from pandas import DataFrame


class TransitionRow(NamedTuple):
    """A transition, as a row of the table."""

    source: int
    target: int
    rule: str
    agent: str | None
    about: str
    label: str


def to_networkx(found: Exploration) -> "MultiDiGraph[int]":
    """Return the graph of configurations, by number, and transitions."""
    import networkx as nx  # noqa: PLC0415 - few need it, and it takes time to load

    graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph()
    graph.add_nodes_from((number, {"configuration": c}) for number, c in enumerate(found.configurations))
    for row in rows(found):
        graph.add_edge(
            row.source, row.target, rule=row.rule, agent=row.agent, about=row.about, label=row.label
        )
    return graph


def to_pandas(found: Exploration) -> "DataFrame":
    """Return the transitions as rows, in the order of their sources."""
    try:
        from pandas import DataFrame  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise ImportError(f"tables need pandas: {install_extra('notebook')}") from error

    return DataFrame(list(rows(found)), columns=list(TransitionRow._fields))


def rows(found: Exploration) -> Iterator[TransitionRow]:
    """Yield the transitions; raises ValueError where they were not kept."""
    graph, configurations = _graph(found), found.configurations
    for source, target, action in zip(graph.sources, graph.targets, graph.actions, strict=True):
        label = graph.labels[action]
        if found.survey is not None and isinstance(
            label.about, Received
        ):  # rows do not hold received observations
            label = step_of(configurations[source], label, configurations[target]).label
        yield TransitionRow(int(source), int(target), label.rule, label.agent, label.details, str(label))


def _graph(found: Exploration) -> Graph:
    if found.survey is not None:
        return found.survey.graph()
    if found.edges is None:
        raise ValueError("the transitions were not kept: explore(..., edges=True)")
    return graph_of(found.edges, found.size)
