"""A worker's shard: whose rows are, and what it needs to know to go back."""

import numpy as np
import pytest

from checker import Engine, explore
from checker.engines.cluster.row_keys import Keys
from checker.engines.cluster.shard import Shard
from semantics.properties.property import watching
from semantics.races.monitor import monitored
from specs.elaboration import load_mission


def start(name):
    return load_mission(name).initial


def shard(name="surveillance", me=0, workers=1):
    """Return the shard of one of some workers; of one alone, all rows are its."""
    return Shard(start(name), 64, me, workers)


def explored(one):
    layer = 0
    while one.expanded < one.size:
        one.expand(layer, 1_000)
        layer += 1
    return one


@pytest.mark.parametrize("name", ["surveillance", "nomad", "tanker"])
def test_a_worker_alone_has_all_rows_in_the_order_of_the_fast_explorer(name):
    alone = explore(start(name), engine=Engine.FAST)
    one = explored(shard(name))
    assert [one.model.configuration(number) for number in range(one.size)] == list(alone.configurations)
    assert one.rules() == alone.rules


def test_whose_a_row_is_depends_on_what_it_says_alone():
    one = explored(shard())
    owners = {}
    for number in range(one.size):
        keys = Keys(one.model.learner.columns)
        keys.refresh()
        codes = one.store.codes(number)
        xor = np.bitwise_xor.reduce([keys.keys[keys.begins[n] + code] for n, code in enumerate(codes)])
        owners[one.model.row(number)] = int(xor) >> 32 >> 31  # of two workers
    assert set(owners.values()) == {0, 1}
    for me in range(2):
        first, other = shard(me=me, workers=2), shard(me=me, workers=2)
        assert first.size == other.size == (owners[first.model.learner.still] == me)


def test_what_was_learned_is_learned_again_from_the_start_so_that_checkpoints_say_where():
    one = explored(shard())
    before, rows = one.learned, one.size
    one.start()
    assert one.learned == set()
    explored(one)
    assert one.size == rows
    assert one.learned
    assert one.learned <= before  # of values that it knows it need not ask


def test_rows_that_wait_keep_the_values_of_new_columns():
    mission = load_mission("rendezvous")
    c = monitored(watching(mission.initial, mission.properties))
    shards, layer = [Shard(c, 64, me, 2) for me in range(2)], 1
    while any(each.expanded < each.size for each in shards):
        for each in shards:
            each.enter(layer)
        while any(each.expanded < each.end for each in shards):
            sent = [each.expand(layer, 1024) for each in shards]
            for me, each in enumerate(shards):
                each.take(*(parcels[me] for parcels in sent))
        layer += 1
    reached = [each.model.configuration(number) for each in shards for number in range(each.size)]
    assert len(reached) == 18_051
    assert set(reached) == set(explore(c, engine=Engine.FAST).configurations)
