"""Ways on the page: the invariants with their figures, the broken ones first."""

FIGURE = "uav0 may come within 42 m of uav1; at least 50 m"
NEAR = {
    "holds": True,
    "figure": "uav0 is at most 812 m from gcs0; within 1000 m",
    "entities": ["uav0", "gcs0"],
}
APART = {
    "holds": False,
    "figure": FIGURE,
    "entities": ["uav0", "uav1"],
    "points": [[37.0, -8.7], [37.0004, -8.7]],
}
WAY = {"to": "spillArea", "points": [[37.0, -8.7], [37.02, -8.72]], "strays": 60.0}


def test_invariants_about_ways_are_listed_with_their_figures_the_broken_ones_first(operates):
    ana = operates()
    ana.sees_no(".ways")
    ana.told(invariants={"near": NEAR | {"points": []}, "apart": APART}, ways={"uav0": WAY})
    ana.sees(".ways li.bad", f"✖ apart: {FIGURE}")
    assert [each.split()[:2] for each in ana.texts(".ways li")] == [["✖", "apart:"], ["✓", "near:"]]
    ana.told(invariants={"apart": APART | {"holds": True, "points": []}})
    ana.sees_no(".ways li.bad")
