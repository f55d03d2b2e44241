import pytest
from scripts import script

cluster = script("cluster")


@pytest.mark.long
def test_two_workers_measure_what_one_process_does():
    size = cluster.Size(2, 2)
    fast, ray = cluster.Means(cluster.Engine.FAST, 1), cluster.Means(cluster.Engine.RAY, 2)
    one, two = cluster.measured(size, fast), cluster.measured(size, ray)
    assert (one["engine"], two["engine"]) == ("fast, 1 thread", "ray, 2 workers")
    assert one["transitions"] == two["transitions"] == 62_157
    assert 0 < two["bytes_sent"] < 94
    assert two["bytes_kept"] > 16
