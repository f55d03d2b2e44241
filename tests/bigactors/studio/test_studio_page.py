"""The studio in a browser: an author writes, checks, draws and explores a mission, and nothing leaves the machine."""

import json
import os
import re
import time
from contextlib import contextmanager

import pytest
from browsers import DESK, PATIENCE, Watch, chromium, overflow, playwright, says
from threaded import loop_beside

from adapters.console.access import Access
from adapters.console.console_server import PAGE, Site, listening
from bigactors.studio.studio_server import StudioService, lacks_parts
from checker import check, to_json
from semantics.state.setting import Control, Scheduler
from specs.elaboration import read_mission

AXE = PAGE / "node_modules" / "axe-core" / "axe.min.js"
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


@pytest.mark.parametrize("theme", ["light", "dark"])
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
    page.click(".cm-tooltip-hover .cm-diagnosticAction")
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


def test_the_world_is_drawn_on_the_map_and_its_text_follows_until_it_is_undone(opened, tmp_path):
    page = opened("patrol.mission", MISSION)
    shows(page, ".bigraph svg")
    shows(page, ".cm-name-enumMember")
    page.click("text=Draw")
    put_cursor(page, "  east")
    shows(page, ".handle-radius")
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


def test_a_cursor_before_the_language_server_answers_chooses_its_name(opened):
    page = opened("patrol.mission", MISSION)
    until(page, "Boolean(studio.editor)")
    put_cursor(page, "  east")
    assert page.locator(".cm-name-class").count() == 0
    says(page, ".chosen-name", "east0 ×")


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


def test_the_graph_is_seen_without_scrolling(opened):
    page = opened("patrol.mission", MISSION, size={"width": 1280, "height": 800})
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


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_no_fault_in_the_studio(opened, theme):
    if not AXE.exists():
        pytest.skip("axe-core is not there: `make parts` fetches it")
    page = opened("patrol.mission", MISSION, theme=theme)
    shows(page, ".bigraph svg")
    shows(page, ".verdicts .verdict-holds")
    page.click("text=Draw")
    put_cursor(page, "  east")
    shows(page, ".handle-radius")
    page.evaluate(f"{AXE.read_text(encoding='utf-8')};0")
    found = page.evaluate("axe.run(document, { resultTypes: ['violations'] })")
    assert [(each["id"], [node["html"] for node in each["nodes"]]) for each in found["violations"]] == []


def playwright_pattern(words):
    return re.compile(rf".*{words}.*", re.DOTALL)
