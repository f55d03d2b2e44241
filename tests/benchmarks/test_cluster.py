import pytest
from scripts import script

cluster = script("cluster")


@pytest.mark.long
def test_two_workers_measure_what_one_process_does():
    size = cluster.Size(2, 2)
    one, two = cluster.measured(size, 1), cluster.measured(size, 2)
    assert one["transitions"] == two["transitions"] == 62_157
    assert 0 < two["bytes_sent"] < 94
    assert two["bytes_kept"] > 16
