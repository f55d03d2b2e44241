"""The pending requests and their lines."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_missions import mission

from semantics.behaviours.observations import All, Observation
from semantics.state.requests import MGR, OBS, READY, SND, Request
from semantics.state.setting import Scheduler

requests: st.SearchStrategy[Request] = st.sampled_from(
    [
        OBS("a", All()),
        MGR("a", "u0"),
        SND("a", "b", "x"),
        SND("a", "b", frozenset({"p", "q", "r"})),
        READY("a", All(), Observation.of()),
        OBS("b", All()),
        SND("b", "a", ("x",)),
    ]
)


def pending(scheduler: Scheduler, asked):
    c = mission(["u0"], agents={"a": ("u0", ()), "b": ("u0", ())}, scheduler=scheduler)
    for request in asked:
        c = c.with_(c.eta.adding(request))
    return c


@pytest.mark.parametrize("scheduler", Scheduler)
@given(asked=st.lists(requests, max_size=6))
def test_eta_is_a_multiset_whatever_the_lines(scheduler, asked):
    c = pending(scheduler, asked)
    assert sorted(map(repr, asked)) == sorted(repr(each.request) for each in c.eta.all())
    for each in c.eta.all():
        fewer = c.with_(c.eta.removing(each))
        assert len(fewer.eta.all()) == len(asked) - 1


@given(asked=st.lists(requests, max_size=6), data=st.data())
def test_unordered_requests_make_one_configuration_in_whatever_order_they_were_asked(asked, data):
    again = data.draw(st.permutations(asked))
    assert pending(Scheduler.UNORDERED, asked) == pending(Scheduler.UNORDERED, again)


@pytest.mark.parametrize("scheduler", [Scheduler.PROGRAM_ORDER, Scheduler.FCFS])
@given(asked=st.lists(requests, max_size=6))
def test_in_line_are_the_first_request_and_all_messages(scheduler, asked):
    c = pending(scheduler, asked)
    for agent in "ab":
        own = [each for each in asked if each.agent == agent]
        served = [each.request for each in c.eta.in_line(agent)]
        line = [each for each in own if not isinstance(each, SND | READY)]
        assert [each for each in served if not isinstance(each, SND)] == line[:1]
        assert len([each for each in served if isinstance(each, SND)]) == len(
            [each for each in own if isinstance(each, SND)]
        )


@pytest.mark.parametrize("scheduler", Scheduler)
@given(asked=st.lists(requests, max_size=6))
def test_requests_are_counted_and_found_where_they_stand(scheduler, asked):
    c = pending(scheduler, asked)
    for agent in "ab":
        assert c.eta.count(agent) == len(c.eta.of(agent)) == sum(each.agent == agent for each in asked)
        assert set(c.eta.in_line(agent)) <= set(c.eta.of(agent))
        assert all(c.read(each.cell)[each.position] == each.request for each in c.eta.in_line(agent))


def test_what_takes_no_turn_has_no_place_in_the_queue():
    ready = READY("a", All(), Observation.of())
    asked = [OBS("a", All()), OBS("b", All())]
    c = pending(Scheduler.FCFS, asked)
    orders = [
        c.with_(c.eta.replacing(c.eta.in_line("a")[0], ready)),
        pending(Scheduler.FCFS, [asked[1], ready]),
    ]
    assert orders[0] == orders[1]
    assert orders[0].read(("queue",)) == (asked[1],)
    assert [each.request for each in orders[0].eta.ready("a")] == [ready]
