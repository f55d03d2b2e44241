import numpy as np

from checker.fast.pages import Pages


def test_pages_grow_in_place_and_keep_what_was_written():
    pages = Pages(np.uint64, 1000)
    pages.room[999] = 7
    pages.grow(1_000_000)
    assert (pages.room[999], pages.room[999_999]) == (7, 0)


def test_pages_on_which_somebody_still_holds_an_array_grow_all_the_same():
    pages = Pages(np.uint64, 1000)
    pages.room[999] = 7
    held = pages.room[:1000]
    pages.grow(1_000_000)
    pages.room[0] = 5
    assert (held[999], held[0]) == (7, 0)
    assert (pages.room[999], pages.room[0], pages.room[999_999]) == (7, 5, 0)
