"""What curves of links cross, counted on the geometry that is drawn."""

import random

import pytest

from bigraphs.layout import layout
from bigraphs.link_curves import route
from bigraphs.link_detours import innermost, label_boxes
from bigraphs.relational_bigraphs import from_relations


def crowd(size, seed):
    """Return places, stations and movers as missions have them: each mover on a station's link, or on the network."""
    chance = random.Random(seed)
    stations = [f"gcs{n}" for n in range(max(1, size // 12))]
    places = [f"area{n}" for n in range(size // 9)]
    movers = [
        f"{chance.choice(['uav', 'vessel', 'drifter'])}{n}" for n in range(size - len(stations) - len(places))
    ]
    kinds = {"uav": "UAV", "vessel": "Vessel", "drifter": "Drifter", "gcs": "Station", "area": "Location"}
    controls = {name: kinds[name.rstrip("0123456789")] for name in (*stations, *places, *movers)}
    parents = {name: chance.choice([None, None, *places]) for name in (*stations, *movers)}
    links = {f"control:{station}": [station] for station in stations} | {"network": list(stations)}
    for mover in movers:
        links[chance.choice(sorted(links))].append(mover)
    return from_relations(controls, parents, links)


def spots_along(curve, parts=24):
    """Return spots along cubic Bézier curves in a row."""
    for start in range(0, len(curve) - 1, 3):
        (ax, ay), (bx, by), (cx, cy), (dx, dy) = curve[start : start + 4]
        for part in range(parts + 1):
            t = part / parts
            a, b, c, d = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3
            yield a * ax + b * bx + c * cx + d * dx, a * ay + b * by + c * cy + d * dy


def crosses(curve, box, inset=2.5):
    """Tell whether a curve goes through a box, and not only along its border or to it."""
    return any(
        box.x + inset < x < box.x + box.width - inset and box.y + inset < y < box.y + box.height - inset
        for x, y in spots_along(curve)
    )


def crossings(bigraph):
    """Count the pairs of a curve and a node, a label or a name on the rim that it goes through."""
    plan = layout(bigraph)
    boxes = [*innermost(plan), *label_boxes(plan), *(box for _, box in plan.outer)]
    curves = [curve for each in route(plan) for curve in each.curves]
    return sum(crosses(curve, box) for curve in curves for box in boxes), len(curves)


@pytest.mark.parametrize("seed", range(6))
def test_links_of_36_nodes_cross_no_node_and_no_label(seed):
    assert crossings(crowd(36, seed))[0] == 0


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_few_links_of_100_nodes_cross_a_node_or_a_label(seed):
    crossed, curves = crossings(crowd(100, seed))
    assert crossed <= curves / 20


def test_a_link_goes_around_the_label_of_the_place_that_it_leaves():
    world = from_relations(
        {
            "airfield0": "Location",
            "gcs0": "Station",
            "uav0": "UAV",
            "oilSpill0": "OilSpill",
            "searchArea0": "Location",
        },
        {"gcs0": "airfield0", "uav0": "airfield0", "oilSpill0": "searchArea0"},
        {"control:gcs0": ["gcs0", "uav0"]},
    )
    assert crossings(world) == (0, 2)


def test_a_link_goes_around_the_names_in_the_rows_below_its_own():
    world = from_relations(
        {"shore0": "Location", "gcs0": "Station", "gcs2": "Station", "sea0": "Location", "uav0": "UAV"},
        {"gcs0": "shore0", "gcs2": "shore0", "uav0": "sea0"},
        {"control:gcs0": ["gcs0"], "control:gcs2": ["gcs2", "uav0"], "internet": ["gcs0", "gcs2"]},
    )
    rows = {box.y for _, box in layout(world).outer}
    assert (len(rows), crossings(world)) == (2, (0, 5))
