"""Bands of altitude."""

import math

import pytest

from physical import Band, PhysicalError, band_contains

OUT = "an altitude is not between -1,000,000 m and 1,000,000 m"


def test_a_band_within_another_is_contained_its_ends_included():
    assert band_contains(Band(0, 100), Band(0, 100))
    assert band_contains(Band(0, 100), Band(0, 0))
    assert not band_contains(Band(0, 100), Band(50, 101))
    assert not band_contains(Band(0, 100), Band(-1, 100))


def test_where_there_is_no_band_there_is_nothing_to_contradict():
    assert band_contains(None, Band(0, 1))
    assert band_contains(Band(0, 1), None)


def test_bands_have_one_spelling():
    assert repr(Band(-0.0, 1)) == "Band(low=0.0, high=1.0)"
    assert hash(Band(-0.0, 1)) == hash(Band(0, 1))


@pytest.mark.parametrize(
    ("low", "high", "message"),
    [
        (2, 1, "the band from 2.0 m to 1.0 m is upside down"),
        (math.nan, 1, OUT),
        (0, math.inf, OUT),
        (0, "1", "the altitude '1' is not a number"),
        (True, 1, "the altitude True is not a number"),
        (0, 10**999, OUT),
    ],
)
def test_what_is_no_band_is_refused(low, high, message):
    with pytest.raises(PhysicalError) as caught:
        Band(low, high)
    assert (caught.value.code, caught.value.message) == ("altitude", message)
