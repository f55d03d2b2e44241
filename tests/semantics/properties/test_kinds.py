from semantics.properties.kinds import ABOUT, PropertyKind


def test_every_kind_of_property_has_its_row():
    assert set(ABOUT) == set(PropertyKind)
