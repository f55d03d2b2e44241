"""The paper's Figures 4, 5 and 6 as golden tests; its Figures 2 and 8 are shipped missions (tests/missions)."""

from bigraphs.text import draw_text
from physical import PhysicalProperty, Waypoint, box, circle, contains, distance, point, polygon
from semantics import COMMANDS, CTR, Configuration, Kind, Program, Setting, Signature, initial
from semantics.brr_driver import mobility_commands
from semantics.control import realisations
from semantics.state.abstraction import abstraction, merged, placement_of

KINDS = Signature.of(
    [
        Kind("Location", contains=frozenset({"Location", "OilSpill", "UAV", "Vessel", "Drifter", "Station"})),
        Kind("OilSpill", contains=frozenset({"UAV", "Vessel", "Drifter"})),
        Kind("UAV", driven=True),
        Kind("Vessel", driven=True, carries=frozenset({"Station", "Drifter"})),
        Kind("Drifter"),
        Kind("Station"),
    ]
)


def seen(entity, kind, geometry, channels=(), **more):
    by, time, source = (more.get(name) for name in ("by", "time", "source"))
    return PhysicalProperty(entity, kind, geometry, None, tuple(sorted(channels)), by, time, source, None)


SEARCH_AREA = seen("searchArea0", "Location", box((37.04, -8.59), (36.94, -8.79)))
SPILL = seen("oilSpill0", "OilSpill", circle((37.00, -8.70), 700))


def test_figure_4_a_bigraph_is_generated_from_what_vehicles_and_sensors_publish():
    published = [
        SEARCH_AREA,
        SPILL,
        seen("airfield0", "Location", circle((37.149, -8.584), 900)),
        seen("uav0", "UAV", point(36.99, -8.66), ["control:gcs2", "network"]),
        seen("drifter0", "Drifter", point(37.001, -8.701), ["ais"]),
        seen("drifter1", "Drifter", point(36.96, -8.60), ["ais"]),
        seen("vessel0", "Vessel", point(36.97, -8.65), ["ais", "network"]),
        seen("gcs0", "Station", point(37.150, -8.586), ["control:gcs0", "network"]),
        seen("gcs2", "Station", point(36.97, -8.65), ["control:gcs2", "network"], by="vessel0"),
    ]
    assert draw_text(abstraction(published, KINDS)).splitlines() == [
        "region 0",
        "├─ airfield0: Location",
        "│  └─ gcs0: Station [control:gcs0, network]",
        "└─ searchArea0: Location",
        "   ├─ drifter1: Drifter [ais]",
        "   ├─ oilSpill0: OilSpill",
        "   │  └─ drifter0: Drifter [ais]",
        "   ├─ uav0: UAV [control:gcs2, network]",
        "   └─ vessel0: Vessel [ais, network]",
        "      └─ gcs2: Station [control:gcs2, network]",
        "ais ─ drifter0, drifter1, vessel0",
        "control:gcs0 ─ gcs0",
        "control:gcs2 ─ gcs2, uav0",
        "network ─ gcs0, gcs2, uav0, vessel0",
    ]


AT_GCS0 = [
    SEARCH_AREA,
    seen("gcs0", "Station", point(37.150, -8.586), ["control:gcs0", "internet"], time=100, source="gcs0"),
    seen("uav0", "UAV", point(36.99, -8.66), ["control:gcs0"], time=100, source="gcs0"),
]
AT_GCS1 = [
    seen("vessel0", "Vessel", point(36.97, -8.65), time=101, source="gcs1"),
    seen(
        "gcs1",
        "Station",
        point(36.97, -8.65),
        ["control:gcs1", "internet"],
        by="vessel0",
        time=101,
        source="gcs1",
    ),
]


def test_figure_5_an_operator_does_not_know_where_the_uav_is_before_stations_share():
    alone = abstraction(merged(AT_GCS1), KINDS)
    assert "uav0" not in draw_text(alone)


def test_figure_5_stations_that_share_their_observations_have_the_same_bigraph():
    one, other = abstraction(merged(AT_GCS0, AT_GCS1), KINDS), abstraction(merged(AT_GCS1, AT_GCS0), KINDS)
    assert one == other
    assert draw_text(one).splitlines() == [
        "region 0",
        "├─ gcs0: Station [control:gcs0, internet]",
        "└─ searchArea0: Location",
        "   ├─ uav0: UAV [control:gcs0]",
        "   └─ vessel0: Vessel",
        "      └─ gcs1: Station [control:gcs1, internet]",
        "control:gcs0 ─ gcs0, uav0",
        "control:gcs1 ─ gcs1",
        "internet ─ gcs0, gcs1",
    ]


def test_figure_5_the_newest_property_wins_whoever_tells_it():
    handed = seen("uav0", "UAV", point(36.97, -8.64), ["control:gcs1"], time=130, source="gcs1")
    for sources in ([AT_GCS0, [*AT_GCS1, handed]], [[*AT_GCS1, handed], AT_GCS0]):
        assert "uav0: UAV [control:gcs1]" in draw_text(abstraction(merged(*sources), KINDS))


def scene(spill: PhysicalProperty) -> Configuration:
    properties = [SEARCH_AREA, spill, seen("uav0", "UAV", point(37.03, -8.60))]
    setting = Setting(KINDS, {each.entity: each.kind for each in properties}, Program(reactions=COMMANDS))
    placements = {each.entity: placement_of(each) for each in properties}
    return initial(setting, placements, {}, {"a": ("uav0", ())})


def commands_of(c: Configuration):
    (found,) = realisations(c, CTR("a", COMMANDS["MOVE_HOST_TO"]("uav0", "oilSpill0")))
    return mobility_commands(c, found)


def test_figure_6_a_rule_becomes_a_waypoint_at_the_centroid_of_the_spill():
    (told,) = commands_of(scene(SPILL))
    assert isinstance(told, Waypoint)
    assert told.entity == "uav0"
    assert distance(told.point, point(37.00, -8.70)) < 0.1


def test_figure_6_the_same_rule_becomes_another_waypoint_when_the_spill_has_moved():
    moved = seen("oilSpill0", "OilSpill", circle((36.97, -8.65), 700))
    (told,) = commands_of(scene(moved))
    assert distance(told.point, point(36.97, -8.65)) < 0.1


def test_figure_6_the_waypoint_of_a_bent_spill_lies_inside_it():
    bent = polygon(
        [(36.98, -8.72), (36.98, -8.68), (37.01, -8.68), (37.01, -8.685), (36.985, -8.685), (36.985, -8.72)]
    )
    (told,) = commands_of(scene(seen("oilSpill0", "OilSpill", bent)))
    assert contains(bent, told.point)
