"""The graph of an exploration: every transition in order, and what is missing where it was cut off."""

import numpy as np
import pytest
from checked_missions import start

from checker import Engine, Limits, explore
from checker.engines.graph import STUTTER
from checker.properties.temporal.decide import kept_graph
from semantics.successors import expand

TEXT = """
BigActor a hosted_at uav0 with_behavior { control(MOVE_HOST_TO gate0) observe(HOST) }
BigActor b hosted_at uav1 with_behavior { control(MOVE_HOST_TO gate0) }
"""
CROWDING = """
BigActor a hosted_at gcs0 with_behavior { loop { send(SELF, b) } }
BigActor b hosted_at gcs0 with_behavior { }
"""


def kept(text, **options):
    found = explore(start(text), edges=True, **options)
    return found, kept_graph(found)


def edges_of(graph):
    return [
        (int(source), str(graph.labels[action]), int(target))
        for source, action, target in zip(graph.sources, graph.actions, graph.targets, strict=True)
    ]


@pytest.mark.parametrize("engine", [Engine.REFERENCE, Engine.FAST])
def test_a_graph_has_every_transition_in_the_order_of_the_rules(engine):
    found, graph = kept(TEXT, engine=engine)
    numbers = {c: number for number, c in enumerate(found.configurations)}
    expected = [
        (number, str(transition.label), numbers[transition.target])
        for number, c in enumerate(found.configurations)
        for transition in expand(c).transitions
    ]
    assert edges_of(graph) == expected
    assert len(expected) == found.transitions
    assert graph.partial is None


@pytest.mark.parametrize("most", [1, 2, 3, 5, 8])
def test_where_an_exploration_is_cut_off_the_graph_is_partial(most):
    whole, everything = kept(TEXT)
    found, graph = kept(TEXT, limits=Limits(configurations=most))
    assert found.configurations == whole.configurations[:most]
    inside = [edge for edge in edges_of(everything) if edge[0] < most and edge[2] < most]
    assert edges_of(graph) == inside
    cut = {edge[0] for edge in edges_of(everything) if edge[0] < most <= edge[2]}
    assert set(np.flatnonzero(graph.open).tolist()) == cut


def test_what_was_never_expanded_is_partial():
    found, graph = kept(TEXT, limits=Limits(seconds=-1.0))
    assert len(found.configurations) == 1
    assert graph.open.tolist() == [True]
    crowded, graph = kept(CROWDING, limits=Limits(pending=3))
    assert not crowded.complete
    assert graph.open.any()
    assert not np.diff(graph.starts)[graph.open].any()


def test_a_terminal_configuration_stutters_and_no_other_does():
    _, graph = kept(TEXT)
    total = graph.total()
    ends = np.flatnonzero(np.diff(graph.starts) == 0)
    stuttering = total.sources[total.actions == STUTTER]
    assert stuttering.tolist() == total.targets[total.actions == STUTTER].tolist() == ends.tolist()
    assert (
        np.delete(total.targets, np.flatnonzero(total.actions == STUTTER)).tolist() == graph.targets.tolist()
    )
    assert (np.diff(total.starts) > 0).all()


def test_where_nothing_has_to_happen_a_run_may_stay():
    _, graph = kept(TEXT + "environment { uav0 leaves mesh and returns }")
    assert graph.total() is graph  # the link comes and goes for ever
    world = np.array([label.agent is None for label in graph.labels])
    total = graph.total(world)
    stuttering = set(total.sources[total.actions == STUTTER].tolist())
    moving = set(graph.sources[~world[graph.actions]].tolist())
    assert stuttering == set(range(graph.size)) - moving
    assert stuttering
