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
    with pytest.raises(NameClash, match="name:uav0 would be called uav0, as mavlink:1 is"):
        naming.name("name:uav0")


@pytest.mark.parametrize(
    "table", [{"mavlink:1": "uav0", "mmsi:244660274": "uav0"}, {"tail number": "uav0"}, {"mmsi:": "uav0"}]
)
def test_a_table_with_a_clash_or_without_identities_is_an_error(table):
    with pytest.raises(PhysicalError):
        NamingService(table)


def test_no_flood_of_identities_uses_up_names_or_memory():
    naming = NamingService({"mmsi:244660274": "tanker0"})
    before = dict(naming._names)
    assert all(naming.name(f"mmsi:{number:09}") == f"mmsi{number:09}" for number in range(200_000))
    assert naming.name("name:oilSpill0") == "oilSpill0"
    assert naming._names == before


@pytest.mark.parametrize("name", ["mmsi244660274", "mavlink1", "serial2F003B"])
def test_who_comes_with_a_name_cannot_have_that_of_a_number(name):
    with pytest.raises(NameClash, match=f"{name} is the name of a number"):
        NamingService().name(f"name:{name}")


def test_who_calls_an_entity_by_another_kind_speaks_of_something_else():
    naming = NamingService(
        {"mmsi:244660274": "drifter0"}, kinds={"drifter0": "Drifter", "oilSpill0": "OilSpill"}
    )
    assert naming.name("name:oilSpill0", "OilSpill") == "oilSpill0"
    with pytest.raises(NameClash, match="oilSpill0 is of kind OilSpill in the mission, not Location"):
        naming.name("name:oilSpill0", "Location")
    assert naming.name("name:oilSpill9", "Location") == "oilSpill9"
    assert naming.name("mmsi:244660274", "Vessel") == "drifter0"  # the table says who it is
    assert (naming.kind_of("drifter0", "Vessel"), naming.kind_of("boat0", "Vessel")) == ("Drifter", "Vessel")
