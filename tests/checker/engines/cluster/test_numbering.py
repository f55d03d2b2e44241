"""Numbers of rows: layer by layer, and in a layer worker by worker."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from checker.engines.cluster.numbering import Places


def test_rows_are_numbered_layer_by_layer_and_in_a_layer_worker_by_worker():
    places = Places.of([(0, 1, 1, 3), (0, 0, 2, 3)])
    assert [places.find(number) for number in range(6)] == [(0, 0), (1, 0), (1, 1), (0, 1), (0, 2), (1, 2)]
    assert (len(places), places.depth) == (6, 2)


def test_a_last_layer_without_rows_is_no_depth():
    assert Places.of([(0, 1, 2, 2), (0, 0, 1, 1)]).depth == 1
    assert Places.of([(0, 1, 1), (0, 0, 0)]).depth == 0


@given(
    st.integers(1, 4), st.lists(st.lists(st.integers(0, 3), min_size=4, max_size=4), min_size=1, max_size=5)
)
def test_each_row_has_one_number_and_each_number_one_row(workers, layers):
    begins = [np.cumsum([0, *(layer[worker] for layer in layers)]).tolist() for worker in range(workers)]
    places = Places.of(begins)
    rows = [places.find(number) for number in range(len(places))]
    assert sorted(rows) == [(worker, row) for worker in range(workers) for row in range(begins[worker][-1])]
    assert [places.number(*row) for row in rows] == list(range(len(places)))
    for worker in range(workers):
        mine = np.arange(begins[worker][-1])
        assert places.all_of(worker, mine).tolist() == [places.number(worker, int(row)) for row in mine]
