"""The explorer in a browser: an author steps, branches, walks, searches, saves, and comes back by an address."""

import json
import re
from pathlib import Path

import pytest
from browsers import DESK, PHONE, chromium, overflow, playwright

from adapters.console.console_server import PAGE
from bigactors.studio.exploration import Exploration
from checker import replay
from specs.elaboration import load_mission

HOST = "http://studio.example"
STUDIO = Path(__file__).parents[3] / "bigactors" / "studio" / "page"
SHELL = """<!doctype html><meta charset="utf-8"><link rel="stylesheet" href="/parts/style.css">
<link rel="stylesheet" href="/studio/explorer.css"><main style="display:block"></main><script type="module">
import { html, render } from "/parts/ui.js";
import { Explorer } from "/studio/explorer.js";
import { Graph } from "/studio/graph.js";
const ask = async (request) => JSON.parse(await window.answer(JSON.stringify(request)));
const onLook = (look) => { window.look = look; window.show({ run: look.run, at: look.at }); };
let state = JSON.parse(decodeURIComponent(location.hash.slice(1) || "{}"));
window.show = (look) => render(html`<${Explorer} ask=${ask} state=${state} onLook=${onLook}
  graph=${html`<${Graph} ask=${ask} run=${look.run} at=${look.at} onGo=${go} />`} />`, document.querySelector("main"));
const go = (run) => window.show((state = { run }));
window.show({ run: state.run ?? "", at: state.at ?? 0 });
</script>"""


@pytest.fixture(scope="module")
def browser():
    with chromium() as found:
        yield found


@pytest.fixture
def opened(browser):
    """Open the explorer of a mission; at the end, its page may have had no error and asked nobody else."""
    pages, errors = [], []

    def open_mission(name, **state):
        exploration = Exploration(load_mission(name))
        page = browser.new_page(viewport=DESK)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda message: message.type == "error" and errors.append(message.text))
        page.expose_function("answer", lambda asked: json.dumps(exploration.handle(json.loads(asked))))
        page.route("**/*", served)
        page.goto(f"{HOST}/#{json.dumps(state)}")
        pages.append(page)
        return page

    yield open_mission
    for page in pages:
        page.close()
    assert errors == []


def served(route):
    path = route.request.url.removeprefix(HOST).partition("#")[0]
    if path == "/":
        return route.fulfill(body=SHELL, content_type="text/html")
    folder = {"parts": PAGE, "studio": STUDIO}.get(path.split("/")[1])
    return route.abort() if folder is None else route.fulfill(path=folder / path.split("/", 2)[2])


def expect(page, selector):
    return playwright().expect(page.locator(selector).first)


def test_an_author_walks_into_a_race_is_told_its_causes_and_comes_back_by_the_address(opened):
    page = opened("look_before_entry_racy")
    expect(page, ".choices h2").to_have_text("a")
    page.get_by_label("go to where this is true").fill("uav0 in gate0 and uav1 in gate0")
    page.get_by_role("button", name="Go to where").click()
    expect(page, ".story").to_contain_text("looks into gate0, and sees nobody at step")
    expect(page, ".values .bad").to_contain_text("race_freedom")
    assert page.locator(".step .role").all_text_contents() == ["sensed", "changed", "acted"]
    look = page.evaluate("window.look")
    again = opened("look_before_entry_racy", run=look["run"], at=look["at"])
    expect(again, ".controls output").to_have_text(f"step {look['at']} of {look['length']}")
    assert again.evaluate("window.look.view.bigraph.svg") == look["view"]["bigraph"]["svg"]


def test_steps_are_taken_back_and_branched_off_by_keys_and_buttons(opened):
    page = opened("look_before_entry_racy")
    for name in ("a on uav0 asks to look into gate0", "b on uav1 asks to look into gate0"):
        page.get_by_role("button", name=name).click()
        expect(page, ".lanes-pane tr[aria-current]").to_contain_text(name)
    page.locator(".explorer .controls button").first.focus()
    page.keyboard.press("ArrowLeft")
    expect(page, ".controls output").to_have_text("step 1 of 2")
    page.get_by_role("button", name="a on uav0 looks into gate0").click()
    expect(page, ".controls output").to_have_text("step 2 of 2")
    assert page.evaluate("window.look.run") == "0.0"


def test_with_times_the_moment_of_a_step_is_chosen_and_the_saved_trace_replays(opened):
    page = opened("relay_timed")
    expect(page, ".choices .interval").to_have_text("0:00 to 0:10")
    page.get_by_label("seconds at which: eye").fill("10")
    page.get_by_role("button", name="eye on uav0 asks").click()
    expect(page, ".controls output").to_have_text("step 1 of 1 · 0:10")
    page.get_by_role("tab", name="Graph").click()
    expect(page, ".graph output").to_contain_text(", each step as early as it may be")
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save the trace").click()
    trace = replay(load_mission("relay_timed").initial, json.loads(saved.value.path().read_text("utf-8")))
    assert trace.moments == (10_000,)


def test_the_graph_shows_every_configuration_bad_ones_red_and_leads_to_each(opened):
    page = opened("broken_inconsistent")
    page.get_by_role("tab", name="Graph").click()
    expect(page, ".graph output").to_have_text(
        re.compile(r"24 configurations(, \d+ drawn: chains are folded)?")
    )
    assert page.locator(".graph .bad").count() > 0
    page.locator(".graph .bad").first.click()
    expect(page, ".values .bad").to_contain_text("local_consistency")
    page.set_viewport_size(PHONE)
    assert overflow(page) == 0
