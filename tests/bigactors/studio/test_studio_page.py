"""The studio in a browser: an author writes, checks, draws and explores a mission, and nothing leaves the machine."""

import json
import os
import re
import time
from contextlib import contextmanager

import pytest
from browsers import (
    DESK,
    PATIENCE,
    PHONE,
    TABLET,
    Watch,
    chromium,
    faults,
    overflow,
    playwright,
    says,
    spilled,
)
from threaded import loop_beside

from adapters.console.access import Access
from adapters.console.console_server import Site, listening
from bigactors.studio.studio_server import StudioService, lacks_parts
from checker import check, to_json
from semantics.state.setting import Control, Scheduler
from specs.elaboration import read_mission

MISSION = """\
mission patrol
signature {
  kind Location contains UAV, Buoy
  kind UAV driven
  kind Buoy
}
world {
  west0: Location = box (37.02, -8.64) (37.00, -8.66)
  east0: Location = circle (37.01, -8.60) radius 900 m
  uav0: UAV = point (37.01, -8.65)
}
BigActor a hosted_at uav0 with_behavior {
  control(MOVE_HOST_TO east0)
}
check {
  local_consistency
  reachable "there": uav0 in east0
}
"""
PLACES = {
    "type": "FeatureCollection",
    "features": [
        {
            "type": "Feature",
            "properties": {"name": "buoy7", "kind": "Buoy"},
            "geometry": {"type": "Point", "coordinates": [-8.61, 37.01]},
        }
    ],
}


@pytest.fixture(scope="module")
def browser():
    if lacks_parts():
        pytest.skip("the studio's page has no parts: npm makes them")
    with chromium() as found:
        yield found


@contextmanager
def studio(loop, file, run):
    """Serve the studio of a file, and of a run in another one; yield its link."""
    access, site = Access(), Site(0)
    serving = listening(StudioService(access, site, file, run), site)
    port = loop(serving.__aenter__())
    yield f"http://127.0.0.1:{port}", access.act
    loop(serving.__aexit__(None, None, None))


@pytest.fixture
def opened(browser, tmp_path):
    """Return what opens the studio of a file in this test's folder, in a page that may ask nobody else."""
    watch = Watch()
    with loop_beside() as loop:
        contexts = []

        def open_file(name, text=None, theme="light", size=DESK, run=None):
            file = tmp_path / name
            if text is not None:
                file.write_text(text, encoding="utf-8")
            serving = studio(loop, file, run)
            address, token = serving.__enter__()
            page = browser.new_context(viewport=size, color_scheme=theme).new_page()
            contexts.append((page, serving))
            watch.over(page, address)
            page.goto(f"{address}/#token={token}")
            return page

        yield open_file
        for page, serving in contexts:
            page.context.close()
            serving.__exit__(None, None, None)
    watch.saw_nothing()


def expect(page, selector):
    return playwright().expect(page.locator(selector).first)


def shows(page, selector):
    expect(page, selector).to_be_visible(timeout=PATIENCE)


def fixes(page, mark, words):
    """Press a quick fix in the tooltip of a mark; one that the editor has redrawn meanwhile is asked for again."""
    late = pytest.importorskip("playwright.sync_api").TimeoutError
    for patience in (5_000, 5_000, PATIENCE):
        page.mouse.move(1, 1)
        page.hover(mark)
        try:
            page.click(f".cm-tooltip-hover .cm-diagnosticAction >> text={words}", timeout=patience)
            return
        except late:
            if patience == PATIENCE:
                raise


def until(page, expression):
    """Wait until an expression is true in the page, whose policy refuses playwright's own way of asking."""
    end = time.monotonic() + PATIENCE / 1000
    while not page.evaluate(expression):
        assert time.monotonic() < end, expression
        page.wait_for_timeout(100)


def picture(page, name):
    """Keep a picture of the page where a person asks for one, to look at it."""
    if folder := os.environ.get("STUDIO_PICTURES"):
        page.screenshot(path=f"{folder}/{name}.png")


def text_of(page):
    return page.evaluate("studio.editor.text")


def put_cursor(page, words, behind=True):
    """Put the cursor behind or before words of the text."""
    page.evaluate(
        """([words, behind]) => {
          const at = studio.editor.text.indexOf(words) + (behind ? words.length : 0);
          studio.editor.view.dispatch({ selection: { anchor: at }, scrollIntoView: true });
          studio.editor.view.focus();
        }""",
        [words, behind],
    )


def look_at(page, name):
    """Look at a screen in three sizes: nothing is cut at its side, and axe finds no fault."""
    for size in (TABLET, PHONE, DESK):
        page.set_viewport_size(size)
        page.wait_for_timeout(200)  # a map follows its frame
        picture(page, f"{name}-{size['width']}")
        assert spilled(page) == [], (name, size)
        assert overflow(page) == 0, (name, size)
        if size is not TABLET:
            assert faults(page) == [], (name, size)


def replace(page, words, other):
    """Write other words over those that are selected, as a person does."""
    put_cursor(page, words)
    page.evaluate(
        """(length) => {
          const { head } = studio.editor.view.state.selection.main;
          studio.editor.view.dispatch({ selection: { anchor: head - length, head } });
        }""",
        len(words),
    )
    page.keyboard.type(other)
    assert other in text_of(page)


def drag(page, handle, to):
    """Drag a handle of the map to a point of it; wait until the text and the handles have followed."""
    shapes = "JSON.stringify(studio.shapes.value)"
    shows(page, handle)
    before = page.evaluate(shapes)
    there = page.locator("#map").bounding_box()
    page.hover(handle)  # once it rests: handles are drawn anew with each answer
    page.mouse.down()
    page.mouse.move(there["x"] + to[0], there["y"] + to[1], steps=5)
    page.mouse.up()
    until(page, f"{shapes} !== {json.dumps(before)}")


@pytest.mark.long
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_an_author_comes_from_an_empty_file_to_a_flight(opened, tmp_path, theme):
    page = opened("patrol.mission", "\n", theme=theme)
    shows(page, "form.begin")
    says(page, ".begin p", re.compile(rf"NAME.mission is written into {re.escape(str(tmp_path))}\..*"))
    look_at(page, f"1-begin-{theme}")
    page.click("form button")
    shows(page, ".verdicts .verdict-holds")
    shows(page, ".bigraph svg")
    look_at(page, f"2-template-{theme}")
    mends_a_mistake(page, theme)
    draws_a_place(page, theme)
    breaks_a_property_and_mends_it(page, theme)
    explores(page, theme)
    flies(page, theme)


def mends_a_mistake(page, theme):
    replace(page, "MOVE_HOST_TO bay0", "MOVE_HOST_TO bayy0")
    says(page, ".verdicts > [role=status]", "Not checked: the text has mistakes.")
    says(page, ".explorer .problem", "the text has mistakes: this is still the text before them")
    says(page, ".unflown", "Fly: mend the mistakes of the text first.")
    look_at(page, f"3-mistake-{theme}")
    fixes(page, ".cm-lintRange-error", "Write 'bay0'")
    all_holds(page)


def all_holds(page):
    until(page, "studio.verdicts.value.state === 'done' && studio.verdicts.value.report.exit_code === 0")


def draws_a_place(page, theme):
    page.click("text=Draw")
    page.select_option("[aria-label=kind]", "Location")
    page.click("text=Add")
    says(page, ".chosen-name", "location0 ×")
    x, y = page.evaluate("studio.map.pixelOf([37.13, -8.584])")
    drag(page, ".handle-move", (x, y))
    drag(page, ".handle-radius", (x + 9, y))
    all_holds(page)
    look_at(page, f"4-drawn-{theme}")
    page.click("text=Draw")


def breaks_a_property_and_mends_it(page, theme):
    replace(page, "MOVE_HOST_TO bay0", "MOVE_HOST_TO location0")
    shows(page, ".verdicts .verdict-violated")
    says(page, ".unflown", "Fly: everything has to hold first.")
    put_cursor(page, "reachable")
    look_at(page, f"5-violated-{theme}")
    page.set_viewport_size(PHONE)
    page.click(".verdicts li >> nth=0 >> text=Show how")
    expect(page, ".story").to_be_in_viewport(timeout=PATIENCE)
    page.set_viewport_size(DESK)
    page.click(".controls [aria-label^=first]")
    until(page, "studio.shown.value.at === 0")
    page.click(".cm-margin .sign-violated")
    says(page, ".story li >> nth=0", "uav0 moves from field0 to location0, as pilot wants at step 2")
    says(page, ".story li >> nth=1", "not true here: uav0 in field0, uav0 in bay0 after step 2")
    until(page, "studio.store.section('entities').get('uav0').believed === 'location0'")
    look_at(page, f"6-run-{theme}")
    replace(page, "uav0 in field0 or uav0 in bay0", "uav0 in field0 or uav0 in location0")
    replace(page, "actually uav0 in bay0 and", "actually uav0 in location0 and")
    all_holds(page)
    assert page.locator(".verdict-violated").count() == 0


def explores(page, theme):
    page.click(".controls [aria-label^=first]")
    says(page, ".caption", "the beginning")
    for steps in (1, 2):
        page.click(".choices button >> text=pilot on uav0" if steps == 1 else ".choices button >> nth=0")
        until(page, f"studio.shown.value.at === {steps}")
    page.fill("[aria-label='go to where this is true']", "not actually boat0 in bay0")
    page.click("text=Go to where")
    until(page, "studio.store.section('entities').get('boat0').actual !== 'bay0'")
    page.get_by_role("tab", name="Graph").click()
    shows(page, ".graph .node")
    look_at(page, f"7-explored-{theme}")


def flies(page, theme):
    says(page, ".unflown", "Fly: save the text first.")
    page.keyboard.press("Control+s")
    says(page, ".top [role=status]", "saved")
    page.click("button.fly")
    shows(page, ".top a")
    page.context.route(lambda url: not url.startswith("http://127.0.0.1:"), lambda route: route.abort())
    with page.context.expect_page() as found:
        page.click(".top a")
    console, watch = found.value, Watch()
    watch.over(console, "http://127.0.0.1:")
    console.fill(".who-asks input", "Ana")
    console.get_by_role("button", name="Act as Ana").click()
    says(console, "h1", "patrol.mission")
    look_at(console, f"8-before-the-start-{theme}")
    start = console.get_by_role("button", name="Start the run")
    start.focus()
    console.keyboard.down("Enter")
    start.wait_for(state="detached", timeout=PATIENCE)
    console.keyboard.up("Enter")
    shows(console, ".card >> text=under way to location0")
    look_at(console, f"9-under-way-{theme}")
    expect(console, ".badge.ended").to_be_visible(timeout=4 * PATIENCE)
    look_at(console, f"10-ended-{theme}")
    console.close()
    watch.forgive("net::ERR_CONNECTION")
    watch.saw_nothing()
    says(
        page, ".top [role=status] >> nth=1", re.compile(r"The flight has ended: Open a run takes .*run\.mcap")
    )
    assert page.locator(".top a").count() == 0
    look_at(page, f"11-after-the-flight-{theme}")


def test_what_a_flight_refuses_is_said_with_what_to_do(opened):
    somewhere = "actually uav0 in west0 or actually uav0 in east0"
    page = opened(
        "patrol.mission", MISSION.replace("  reachable", f'  invariant "somewhere": {somewhere}\n  reachable')
    )
    shows(page, ".verdicts .verdict-holds")
    page.click("button.fly")
    says(
        page,
        ".trouble",
        "the flight does not begin:\n"
        f"bigactors: not all holds where a flight takes time: somewhere: not true here: {somewhere}\n"
        "  hint: write the line control timed into the text: Show how then shows the run ×",
    )


@pytest.mark.parametrize("theme", ["light", pytest.param("dark", marks=pytest.mark.long)])
def test_from_an_empty_folder_to_a_verdict_and_a_counterexample(opened, tmp_path, theme):
    page = opened("mission", theme=theme)
    page.fill("[name=name]", "9th")
    page.click("text=Begin >> nth=-1")
    says(
        page,
        ".trouble",
        "'9th' is no name\n  hint: a mission's name has letters, digits and _, a letter first ×",
    )
    page.fill("[name=name]", "patrol")
    page.click("form button")
    shows(page, ".verdicts .verdict-holds")
    assert (tmp_path / "patrol.mission").read_text(encoding="utf-8") == text_of(page)
    assert page.locator(".verdict-violated").count() == 0
    shows(page, ".bigraph svg")
    picture(page, f"begun-{theme}")
    put_cursor(page, "check {")
    page.keyboard.type('\n  invariant "it stays": not uav0 in bay0')
    shows(page, ".verdicts .verdict-violated")
    says(page, ".verdicts .verdict-violated .name", "it stays")
    assert page.locator(".cm-margin .sign-violated").count() == 1
    page.click(".verdict-violated .run")
    shows(page, ".explorer .controls")
    until(page, "studio.shown.value.at > 0")
    assert page.evaluate("studio.store.section('entities').get('uav0').believed") == "bay0"
    assert f"run={page.evaluate('studio.shown.value.run')}" in page.url
    assert overflow(page) == 0
    picture(page, f"violated-{theme}")
    page.keyboard.press("Control+s")
    says(page, ".top [role=status]", "saved")
    assert "it stays" in (tmp_path / "patrol.mission").read_text(encoding="utf-8")
    shown = page.evaluate("studio.shown.value")
    page.reload()
    shows(page, ".explorer .controls")
    assert page.evaluate("studio.shown.value") == shown


def test_a_mistake_is_shown_where_it_stands_with_its_quick_fix(opened):
    page = opened("patrol.mission", MISSION.replace("MOVE_HOST_TO east0", "MOVE_HOST_TO esat0"))
    shows(page, ".cm-lint-marker-error")
    says(page, ".verdicts > [role=status]", "Not checked: the text has mistakes.")
    page.hover(".cm-lintRange-error")
    shows(page, ".cm-tooltip-hover .cm-diagnosticAction")
    picture(page, "mistake")
    fixes(page, ".cm-lintRange-error", "Write 'east0'")
    shows(page, ".verdicts .verdict-holds")
    assert text_of(page) == MISSION
    shows(page, ".cm-margin .sign-holds")
    put_cursor(page, "  reachable")
    page.keyboard.type("x")
    says(page, ".verdicts > [role=status]", "Not checked: the text has mistakes.")
    assert page.locator(".cm-margin .sign-holds").count() == 0


def test_a_name_is_explained_completed_and_renamed_by_the_language_server(opened):
    page = opened("patrol.mission", MISSION)
    shows(page, ".cm-name-enumMember")
    page.hover(".cm-name-enumMember >> text=east0")
    says(page, ".cm-tooltip-hover", playwright_pattern("east0"))
    put_cursor(page, "uav0 in ea")
    page.keyboard.press("Control+Space")
    shows(page, ".cm-tooltip-autocomplete >> text=east0")
    page.keyboard.press("Escape")
    put_cursor(page, "MOVE_HOST_TO ea")
    page.keyboard.press("F2")
    page.fill(".cm-lsp-rename-panel input", "coast0")
    page.keyboard.press("Enter")
    until(page, "studio.editor.text.includes('coast0')")
    assert text_of(page) == MISSION.replace("east0", "coast0")


def test_what_another_editor_saves_is_taken_and_never_over_unsaved_text(opened, tmp_path):
    page = opened("patrol.mission", MISSION)
    shows(page, ".cm-content")
    theirs = MISSION.replace("patrol", "survey")
    (tmp_path / "patrol.mission").write_text(theirs, encoding="utf-8")
    until(page, "studio.editor.text.startsWith('mission survey')")
    put_cursor(page, "mission survey")
    page.keyboard.type("_mine")
    (tmp_path / "patrol.mission").write_text(MISSION, encoding="utf-8")
    shows(page, ".trouble >> text=Another program has saved this file")
    assert text_of(page) == theirs.replace("survey", "survey_mine")
    page.click("text=Keep mine")
    page.keyboard.press("Control+s")
    says(page, ".top [role=status]", "saved")
    assert (tmp_path / "patrol.mission").read_text(encoding="utf-8") == theirs.replace(
        "survey", "survey_mine"
    )


def test_a_name_is_chosen_in_the_text_on_the_map_and_in_the_bigraph_together(opened):
    page = opened("patrol.mission", MISSION)
    until(page, "Boolean(studio.editor)")
    put_cursor(page, "  east")
    assert page.locator(".cm-name-class").count() == 0  # the language server has not answered
    says(page, ".chosen-name", "east0 ×")
    shows(page, ".bigraph svg")
    shows(page, ".cm-name-enumMember")
    put_cursor(page, "  east", behind=True)
    says(page, ".chosen-name", "east0 ×")
    shows(page, ".bigraph rect.chosen")
    assert page.locator(".cm-chosen-name").count() == 3
    box = page.locator(".bigraph svg text", has_text="uav0").first.bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    says(page, ".chosen-name", "uav0 ×")
    x, y = page.evaluate("studio.map.pixelOf([37.003, -8.643])")
    page.locator("#map").click(position={"x": x, "y": y})
    says(page, ".chosen-name", "west0 ×")
    chart = page.evaluate("studio.map.summary()")
    assert "uav0, UAV, 37°00.600′N 008°39.000′W." in chart  # nothing is heard of a design
    assert page.evaluate("studio.editor.view.root.querySelector('.cm-chosen-name').textContent") == "west0"
    picture(page, "chosen")
    for width, height in ((1024, 768), (390, 844)):
        page.set_viewport_size({"width": width, "height": height})
        assert overflow(page) == 0
        picture(page, f"chosen-{width}")
    page.set_viewport_size({"width": 1280, "height": 800})
    sees_the_graph_without_scrolling(page)


def test_the_world_is_drawn_on_the_map_and_its_text_follows_until_it_is_undone(opened, tmp_path):
    page = opened("patrol.mission", MISSION)
    shows(page, ".bigraph svg")
    shows(page, ".verdicts .verdict-holds")
    shows(page, ".cm-name-enumMember")
    page.click("text=Draw")
    put_cursor(page, "  east")
    shows(page, ".handle-radius")
    assert faults(page) == []
    picture(page, "drawing")
    box = page.locator(".handle-radius").bounding_box()
    page.mouse.move(box["x"] + 8, box["y"] + 8)
    page.mouse.down()
    page.mouse.move(box["x"] + 48, box["y"] + 8, steps=4)
    page.mouse.up()
    until(page, "!studio.editor.text.includes('radius 900 m')")
    line = next(each for each in text_of(page).split("\n") if each.startswith("  east0"))
    assert line.startswith("  east0: Location = circle (37.01, -8.60) radius ")
    page.locator(".handle-move").press("ArrowUp")
    until(page, "!studio.editor.text.includes('circle (37.01, ')")
    page.select_option("[aria-label=kind]", "Buoy")
    page.select_option("[aria-label=shape]", "point")
    page.click("text=Add")
    says(page, ".chosen-name", "buoy0 ×")
    assert "\n  buoy0: Buoy = point (" in text_of(page)
    page.set_input_files(
        "input[type=file][accept*=geojson]",
        {"name": "buoys.geojson", "mimeType": "application/geo+json", "buffer": json.dumps(PLACES).encode()},
    )
    until(page, "studio.editor.text.includes('from \"buoys.geojson\"')")
    assert json.loads((tmp_path / "buoys.geojson").read_text(encoding="utf-8")) == PLACES
    until(page, "studio.store.section('places').has('buoy7')")
    picture(page, "drawn")
    for _ in range(4):
        put_cursor(page, "mission")
        page.keyboard.press("Control+z")
    until(page, "studio.editor.text.includes('radius 900 m')")
    assert text_of(page) == MISSION


def test_a_run_from_a_file_is_shown_left_and_there_after_a_reload_and_a_change_of_the_text(opened, tmp_path):
    mission = read_mission(MISSION).under(Scheduler.FCFS, Control.TIMED)
    trace = check(mission).verdicts["there"].witness
    data = to_json(trace, "m", "d") | {"scheduler": "fcfs", "control": "timed"}
    (tmp_path / "trace.json").write_text(json.dumps(data), encoding="utf-8")
    page = opened("patrol.mission", MISSION, run=tmp_path / "trace.json")
    says(page, ".explorer .controls output", f"step {len(trace)} of {len(trace)}")
    page.click("text=←")
    page.click(".choices button >> nth=0")
    until(page, f"studio.shown.value.run === '~{len(trace) - 1}.0'")
    page.reload()
    until(page, f"studio.shown.value.run === '~{len(trace) - 1}.0'")
    says(page, ".explorer .controls output", f"step {len(trace)} of {len(trace)}")
    put_cursor(page, "mission patrol")
    page.keyboard.type("_2")
    shows(page, ".verdicts .verdict-holds")
    says(page, ".explorer .controls output", f"step {len(trace)} of {len(trace)}")
    page.set_input_files(".wishes input[type=file]", tmp_path / "patrol.mission")
    shows(page, ".explorer .problem")
    page.set_input_files(".wishes input[type=file]", tmp_path / "trace.json")
    until(page, f"studio.shown.value.run === '~{len(trace)}'")


def sees_the_graph_without_scrolling(page):
    page.get_by_role("tab", name="Graph").click()
    shows(page, ".graph .node")
    picture(page, "graph")
    box = page.locator(".graph .scroll").bounding_box()
    assert box["y"] + box["height"] <= 800
    assert box["height"] > 200
    page.get_by_role("tab", name="Graph").press("ArrowLeft")
    shows(page, ".lanes-pane")
    box = page.locator(".lanes-pane .scroll").bounding_box()
    assert box["y"] + box["height"] <= 800


DROP = """([name, text]) => {
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([text], name));
  const over = (type) => document.querySelector("#map").dispatchEvent(
    new DragEvent(type, { bubbles: true, cancelable: true, dataTransfer }));
  return [over("dragover"), over("drop")];
}"""


def test_a_file_dropped_on_the_map_brings_its_places_and_another_is_refused(opened, tmp_path):
    page = opened("patrol.mission", MISSION)
    shows(page, ".bigraph svg")
    assert page.evaluate(DROP, ["buoys.geojson", json.dumps(PLACES)]) == [False, False]  # both are taken
    until(page, "studio.editor.text.includes('from \"buoys.geojson\"')")
    until(page, "studio.store.section('places').has('buoy7')")
    page.evaluate(DROP, ["bad.geojson", "{"])
    shows(page, ".trouble >> text=bad.geojson: the text is not JSON")
    assert [each.name for each in tmp_path.glob("*.geojson")] == ["buoys.geojson"]


def test_axe_finds_no_fault_in_the_studio_in_the_dark_either(opened):
    page = opened("patrol.mission", MISSION, theme="dark")
    shows(page, ".bigraph svg")
    shows(page, ".verdicts .verdict-holds")
    page.click("text=Draw")
    put_cursor(page, "  east")
    shows(page, ".handle-radius")
    assert faults(page) == []


def playwright_pattern(words):
    return re.compile(rf".*{words}.*", re.DOTALL)
