"""Rows packed anew: every column keeps its code."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from checker.engines.fast.model.columns import packing, shifts
from checker.engines.fast.store import repacking


@given(st.data())
def test_rows_that_are_packed_anew_keep_the_code_of_each_column(data):
    sizes = data.draw(st.lists(st.integers(1, 5_000), min_size=1, max_size=30))
    grown = [data.draw(st.integers(size, 3 * size)) for size in sizes]
    old = packing(sizes)
    new = packing(grown, old.words)
    codes = [[data.draw(st.integers(0, size - 1)) for size in sizes] for _ in range(3)]
    words = np.zeros(len(codes) * new.words, np.uint64)
    for row, values in enumerate(codes):
        for word, shift, code in zip(old.word, old.shift, values, strict=True):
            words[row * old.words + word] |= np.uint64(code) << shift
    repacking.repack(words, len(codes), shifts(old, new), old.words, new.words)
    for row, values in enumerate(codes):
        packed = words[row * new.words : (row + 1) * new.words]
        assert list((packed[new.word] >> new.shift) & new.mask) == values
