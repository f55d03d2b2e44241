"""How an operator finds, filters, hears, notes and saves: stories, with a server that shows what a test says."""

import time

from page_harness import alert, entity, world

TITLE = "text => document.title.includes(text)"


def test_an_operator_finds_things_and_moments_by_one_input(operates):
    ana = operates()
    finds_a_target_by_the_digits_of_its_mmsi(ana)
    finds_a_place_and_a_vehicle_in_natural_order(ana)
    finds_what_was_done_and_goes_to_that_moment(ana)
    is_told_that_nothing_is_called_so(ana)


def finds_a_target_by_the_digits_of_its_mmsi(ana):
    ana.told(entities={"mmsi263999001": entity(37.4, -8.1, named=False)})
    ana.presses("/", *"39990", "Enter")
    ana.sees(".chosen-name", "mmsi263999001")
    ana.sees(".card.entity", "mmsi263999001")


def finds_a_place_and_a_vehicle_in_natural_order(ana):
    ana.presses("/", *"uav")
    ana.sees("#found li", "uav0")
    assert [each.split()[0] for each in ana.texts("#found li")[:3]] == ["uav0", "uav1", "uav10"]
    ana.presses("ArrowDown", "ArrowDown", "Enter")
    ana.sees(".chosen-name", "uav10")
    ana.presses("/", *"searcharea", "Enter")
    ana.sees(".chosen-name", "searchArea0")


def finds_what_was_done_and_goes_to_that_moment(ana):
    returned = ana.harness.state["actions"]["2"]["time"]
    ana.presses("/", *"rui", "Enter")
    ana.sees(".screen.past")
    assert [each["time"] for each in ana.asked() if each["type"] == "seek"] == [returned]
    ana.presses("l")


def is_told_that_nothing_is_called_so(ana):
    ana.presses("/", *"nowhere", "Enter")
    ana.sees(".notice", "Nothing here is called “nowhere”")
    ana.presses("Escape")
    assert ana.focused("e => e.id") != "find"


def test_targets_are_hidden_by_kind_motion_and_distance(operates):
    state = world()
    others = {
        "near": (36.99, {}),
        "far": (39.0, {}),
        "still": (36.98, {"speed": 0.1}),
        "tug": (36.98, {"kind": "Tug"}),
    }
    for name, (north, more) in others.items():
        state["entities"][name] = entity(north, -8.7, named=False, **more)
    ana = operates(state)
    for choose, hidden in (
        (lambda: ana.page.get_by_label("moving only").check(), 1),
        (lambda: ana.page.get_by_label("Within").select_option("10"), 2),
        (lambda: ana.page.get_by_label("Kind").select_option("Tug"), 3),
    ):
        ana.page.evaluate("document.querySelector('.targets').open = true")
        choose()
        ana.sees(".targets summary", f"{hidden} hidden")


def test_an_alarm_is_in_the_title_and_can_be_muted_for_good(operates):
    ana = operates(world() | {"alerts": {}})
    ana.sees_that(TITLE, "spill_watch")
    ana.told(alerts={"9": alert(time.time(), "lost link", "uav1", "nothing was heard for 31 s", "")})
    ana.sees_that(TITLE, "(1) uav1: lost link")
    ana.presses("s")
    ana.sees("[aria-label='sound of alarms'][aria-pressed=false]")
    ana.page.reload()
    ana.sees("[aria-label='sound of alarms'][aria-pressed=false]")


def test_a_note_is_recorded_with_a_name_and_the_map_and_the_report_are_saved(operates):
    ana = operates()
    ana.page.locator("#note").fill("a fishing boat crosses")
    ana.presses("Enter")
    ana.sees(".notice.confirmed", "note a fishing boat crosses: done")
    ana.sees(".fates li", "note a fishing boat crosses · Ana")
    assert ana.asked() == [{"note": {"text": "a fishing boat crosses"}}]
    with ana.page.expect_download() as saved:
        ana.clicks("button", "Map as PNG")
    assert saved.value.suggested_filename == "spill_watch-map.png"
    with open(saved.value.path(), "rb") as picture:
        assert picture.read(8) == b"\x89PNG\r\n\x1a\n"


def test_one_tab_leaves_the_map_and_the_verdict_says_its_whole_name(operates):
    ana = operates()
    ana.sees(".map-leaflet.leaflet-container")
    ana.presses("m")
    ana.sees_that("() => document.activeElement.matches('.map-leaflet')")
    ana.presses("Tab")
    assert ana.focused("e => e.matches('.map-leaflet')") is False
    name = ana.page.locator(".verdict summary").aria_snapshot()
    assert "verified · 2 properties, 1 on a broken assumption" in name
