import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from physical.mmsi import HIGHEST, KINDS, digits, entity_name, kind_by_range, kind_of


@pytest.mark.parametrize(
    ("mmsi", "kind"),
    [
        (2442103, "BaseStation"),
        (244660274, "Vessel"),
        (775999999, "Vessel"),
        (992446001, "AidToNavigation"),
        (982445123, "AssociatedCraft"),
        (824412345, "HandheldRadio"),
        (111232512, "SearchAndRescueAircraft"),
        (970010119, "DistressBeacon"),
        (972010119, "DistressBeacon"),
        (974010119, "DistressBeacon"),
        (971010119, "UnknownStation"),
        (24466031, "UnknownStation"),
        (111111111, "UnknownStation"),
        (1193046, "UnknownStation"),
        (123456789, "UnknownStation"),
        (776000000, "UnknownStation"),
        (0, "UnknownStation"),
    ],
)
def test_the_range_of_its_number_says_what_a_station_is(mmsi, kind):
    assert kind_by_range(mmsi) == kind


@pytest.mark.parametrize(
    ("mmsi", "msg_type", "kind"),
    [
        (244660274, 1, "Vessel"),
        (244660274, 18, "Vessel"),
        (244660274, 21, "AidToNavigation"),
        (244660274, 4, "BaseStation"),
        (244660274, 9, "SearchAndRescueAircraft"),
        (2442103, 17, "BaseStation"),
        (992446001, 1, "AidToNavigation"),
        (970010119, 1, "DistressBeacon"),
        (1193046, 3, "Vessel"),
        (1193046, 11, "UnknownStation"),
    ],
)
def test_a_special_number_decides_then_a_special_message_then_the_number(mmsi, msg_type, kind):
    assert kind_of(mmsi, msg_type) == kind


@given(st.integers(0, HIGHEST), st.integers(1, 27))
def test_every_station_has_a_kind_and_a_name_that_starts_with_a_letter(mmsi, msg_type):
    assert kind_of(mmsi, msg_type) in KINDS
    assert re.fullmatch(r"mmsi\d{9}", entity_name(mmsi))


@pytest.mark.parametrize("mmsi", [-1, HIGHEST + 1])
def test_a_number_beyond_nine_digits_is_refused(mmsi):
    with pytest.raises(ValueError, match="nine digits"):
        digits(mmsi)
