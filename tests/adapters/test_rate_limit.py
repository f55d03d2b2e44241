from collections import Counter

from adapters.rate_limit import Ration, Turns


def test_so_much_of_each_source_is_kept_in_a_second_and_the_rest_counted():
    ration = Ration(2)
    assert [ration.takes("a", 1.0 + k / 10) for k in range(4)] == [True, True, False, False]
    assert ration.takes("b", 1.5)
    assert ration.left_out(1.9) == ()  # the second is not over
    assert ration.takes("a", 2.0)
    assert ration.left_out(2.0) == (("a", 2),)
    assert ration.left_out(2.0) == ()


def test_what_was_not_kept_for_another_reason_is_told_once_the_second_is_over_too():
    ration = Ration(2)
    assert ration.takes("a", 1.0)
    for moment in (1.1, 1.5, 1.9):
        ration.leave_out("others")
        assert ration.left_out(moment) == ()
    assert ration.left_out(2.0) == (("others", 3),)
    ration.leave_out("others")
    assert ration.left_out() == (("others", 1),)


def test_what_a_pause_has_piled_up_is_no_flood():
    ration = Ration(10)
    assert ration.takes("a", 0.0)
    assert all(ration.takes("a", 3.5 + k / 1_000) for k in range(35))  # 10 a second since 1.0
    assert not ration.takes("a", 3.6)
    assert [ration.takes("a", 4.75) for _ in range(20)].count(True) == 12  # the pause after 4.5 was short
    assert ration.left_out(6.0) == (("a", 9),)
    assert [ration.takes("a", 9_000.0) for _ in range(1_000)].count(True) == 110


def test_in_the_end_all_is_told():
    ration = Ration(0)
    assert not ration.takes("a", 1.0)
    assert ration.left_out() == (("a", 1),)


def test_of_more_sources_than_can_be_kept_each_has_its_turn():
    turns = Turns(10)
    kept = [
        (source, second)
        for second in range(30)
        for source in range(100)
        if turns.takes(source, second + source / 100)
    ]
    counts = Counter(source for source, _ in kept)
    assert set(counts) == set(range(100))
    assert max(Counter(second for _, second in kept).values()) == 10
    assert max(counts.values()) - min(counts.values()) <= 2


def test_few_sources_are_not_passed_over():
    turns = Turns(10)
    assert all(turns.takes(source, float(second)) for second in range(50) for source in range(10))


def test_who_has_gone_is_forgotten():
    turns = Turns(10)
    for moment in range(100):
        for source in range(1_000):
            turns.takes((moment, source), float(moment))
    assert len(turns._kept) <= 1_000
