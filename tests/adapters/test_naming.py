"""Names for identities: each keeps its own, and nobody takes another's."""

import pytest

from adapters.naming import NameClash, NamingService
from physical import PhysicalError


def test_own_names_are_taken_before_the_table_and_all_that_is_heard():
    own = {"mavlink:3": "uav0", "place:sea0": "sea0"}
    naming = NamingService({"mavlink:3": "uav0", "mmsi:244660274": "tanker0"}, own)
    assert naming.name("mmsi:244660274") == "tanker0"
    for identity in ("name:uav0", "name:sea0"):
        with pytest.raises(NameClash):
            naming.name(identity)
    with pytest.raises(NameClash, match="mmsi:244660274 would be called uav0, as mavlink:3 is"):
        NamingService({"mmsi:244660274": "uav0"}, own)


def test_an_identity_keeps_its_name_and_two_cannot_have_one():
    naming = NamingService({"mavlink:1": "uav0"})
    assert naming.name("mavlink:1") == "uav0"
    assert naming.name("mmsi:244660274") == naming.name("mmsi:244660274") == "mmsi244660274"
    assert naming.identity("uav0") == "mavlink:1"
    with pytest.raises(NameClash, match="name:uav0 would be called uav0, as mavlink:1 is"):
        naming.name("name:uav0")


@pytest.mark.parametrize(
    "table", [{"mavlink:1": "uav0", "mmsi:244660274": "uav0"}, {"tail number": "uav0"}, {"mmsi:": "uav0"}]
)
def test_a_table_with_a_clash_or_without_identities_is_an_error(table):
    with pytest.raises(PhysicalError):
        NamingService(table)
