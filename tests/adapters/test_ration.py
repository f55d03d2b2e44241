from adapters.ration import Ration


def test_so_much_of_each_source_is_kept_in_a_second_and_the_rest_counted():
    ration = Ration(2)
    assert [ration.takes("a", 1.0 + k / 10) for k in range(4)] == [True, True, False, False]
    assert ration.takes("b", 1.5)
    assert ration.left_out(1.9) == ()  # the second is not over
    assert ration.takes("a", 2.0)
    assert ration.left_out(2.0) == (("a", 2),)
    assert ration.left_out(2.0) == ()


def test_in_the_end_all_is_told():
    ration = Ration(0)
    assert not ration.takes("a", 1.0)
    assert ration.left_out() == (("a", 1),)
