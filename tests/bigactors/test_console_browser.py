"""The console in a browser, from the first packet to the replay: a real run, and a simulated plane in a hurry."""

import socket
from contextlib import contextmanager

import pytest
from browsers import DESK, PATIENCE, Watch, chromium, until
from consoles import begun, free_port, link_of

from adapters.recording.recording_reader import read_recording
from bigactors.live_demo import MISSION
from specs.missions import shipped_missions

pytestmark = pytest.mark.long

SPEED = 50
PLANE = '''
import asyncio, os, sys
from pathlib import Path
from adapters.simulated import Kind, Simulator, Vehicle, run
from bigactors.live_demo import AIRFIELD
from physical import PhysicalProperty, circle, write_geojson

SPILL = PhysicalProperty("oilSpill0", "OilSpill", circle((37.0, -8.7), 650.0))

async def reports(plane, folder):
    """Tell of the spill, as a vision system does, once the plane has been over the search area for a minute."""
    while plane.body.latitude > 37.02:
        await asyncio.sleep(1.0)
    await asyncio.sleep(60.0)
    while True:
        (folder / "part").write_text(write_geojson([SPILL]), encoding="utf-8")
        os.replace(folder / "part", folder / "spill.geojson")
        await asyncio.sleep(120.0)

async def flies(to, folder):
    plane = Vehicle(Kind.PLANE, AIRFIELD, enforce=False)
    reporting = asyncio.ensure_future(reports(plane, folder / "camera"))
    flying = asyncio.ensure_future(Simulator(to, [plane]).run())
    while not (folder / "battery is low").exists():
        await asyncio.sleep(1.0)
    plane.parameters |= {"BATT_FS_LOW_ACT": 1.0, "BATT_LOW_TIMER": 1.0, "BATT_LOW_VOLT": 30.0}
    await asyncio.gather(flying, reporting)

run(flies(sys.argv[1], Path(sys.argv[2])), float(sys.argv[3]))
'''


@pytest.fixture(scope="module")
def browser():
    with chromium() as found:
        yield found


@contextmanager
def opened(browser, link):
    watch = Watch()
    page = watch.over(browser.new_page(viewport=DESK), link.partition("#")[0])
    page.set_default_timeout(4 * PATIENCE)  # the plane flies for minutes on a busy machine
    page.goto(link)
    yield page, watch
    page.close()
    watch.saw_nothing()


@contextmanager
def flying(folder):
    """Fly the demonstration's mission with a console; yield the process of the run."""
    (folder / "camera").mkdir()
    port = free_port(socket.SOCK_DGRAM)
    line = ["-m", "bigactors", "run", MISSION, f"--vehicle=uav0=udp:127.0.0.1:{port}", "--unverified"]
    line += [f"--feed=ais=file:{shipped_missions()[MISSION].with_suffix('.nmea')}"]
    line += [f"--feed=detections=folder:{folder / 'camera'}", "--name=mmsi:263999001=drifter0"]
    line += ["--name=mmsi:263999002=drifter1", f"--socket={folder / 's'}", f"--record={folder / 'run.mcap'}"]
    line += [f"--console=127.0.0.1:{free_port()}", "--at-once"]
    with begun("-c", PLANE, f"udpout:127.0.0.1:{port}", folder, SPEED), begun(*line) as process:
        yield process


def hold(page, button):
    """Press a button until it has acted, after a second."""
    page.locator(button).hover()
    page.mouse.down()
    page.locator(f"{button}.pressed").wait_for()
    page.locator(f"{button}.pressed").wait_for(state="detached")
    page.mouse.up()


def has(page, selector, text):
    page.locator(selector, has_text=text).first.wait_for()


def test_a_flight_is_operated_from_its_first_order_to_its_end_and_then_replayed(browser, tmp_path):
    with flying(tmp_path) as run, opened(browser, link_of(run)) as (page, watch):
        stops_it_on_its_way_and_lets_it_go_on(page)
        looks_back_while_it_is_over_the_spill(page)
        says_handover_and_gives_it_back_after_a_fail_safe(page, tmp_path)
        has(page, ".badge", "ENDED")
        assert page.locator(".held:enabled").count() == 0
        assert run.wait(60) == 0
        has(page, ".offline", "The run has ended, and this console with it")
        watch.forgive("ERR_CONNECTION_REFUSED")
    told = read_recording(tmp_path / "run.mcap")
    assert [message.data["by"] for message in told.of("given_back")] == ["Ana", "Ana"]
    assert [message.data["message"] for message in told.of("sayings")] == ["handover"]
    assert [message.data["by"] for message in told.of("acknowledged")] == ["Ana"]
    line = ("-m", "bigactors", "console", tmp_path / "run.mcap", f"--listen={free_port()}")
    with begun(*line) as console, opened(browser, link_of(console, "watch")) as (page, _):
        plays_the_recording(page)


def stops_it_on_its_way_and_lets_it_go_on(page):
    has(page, ".top h1", "spill_watch")
    has(page, ".verdict", "not verified")
    has(page, ".badge", "LIVE")
    has(page, "[data-name=uav0]", "under way to searchArea0")
    page.locator(".map-canvas.moving").wait_for()
    page.locator("#who-name").fill("Ana")
    page.locator("#who-name").press("Enter")
    hold(page, "[aria-label^='Hold uav0']")
    has(page, "[data-name=uav0] .ordered", "to hold, by Ana: confirmed by the vehicle")
    has(page, "[data-name=uav0]", "held by the operator (Ana)")
    hold(page, "[aria-label^='Give back uav0']")
    has(page, "[data-name=uav0] .fate", "give back by Ana")
    page.locator("[data-name=uav0]", has_not_text="Taken over").wait_for()


def looks_back_while_it_is_over_the_spill(page):
    page.locator("[data-name=uav0] .place", has_text="oilSpill0").filter(has_not_text="under").wait_for()
    page.keyboard.press("[")
    has(page, ".badge", "PAST")
    assert page.locator(".held").count() == 0
    page.locator("input[type=range]").focus()
    page.keyboard.press("Home")
    page.locator("[data-name=uav0] .place", has_not_text="oilSpill0").wait_for()
    page.keyboard.press("l")
    has(page, ".badge", "LIVE")
    has(page, "[data-name=uav0] .place", "oilSpill0")


def says_handover_and_gives_it_back_after_a_fail_safe(page, folder):
    hold(page, "[aria-label^='say “handover” to tower']")
    has(page, ".fates li", "handover")
    has(page, "[data-name=uav0]", "under way to airfield0")
    (folder / "battery is low").touch()
    has(page, ".alert", "uav0")
    has(page, "[data-name=uav0]", "RTL")
    page.locator(".acknowledge").click()
    has(page, "[data-name=uav0]", "Taken over")
    hold(page, "[aria-label^='Give back uav0']")
    has(page, "[data-name=uav0] .fate", "give back by Ana")


COUNTS = "[...document.querySelectorAll('.legend .quiet')].map((each) => Number(each.textContent))"
ALL_READ = f"{COUNTS}.filter((each) => each > 0).length === 5"


def plays_the_recording(page):
    has(page, ".role", "you watch")
    assert page.locator(".held").count() == 0
    until(page, ALL_READ)
    page.locator("#speed").select_option("100")
    has(page, ".badge", "ENDED")
    page.locator("input[type=range]").focus()
    page.keyboard.press("Home")
    has(page, "[data-name=uav0] .place", "airfield0")
    has(page, ".badge", "PAST")
    page.keyboard.press("]")
    has(page, "[data-name=uav0]", "searchArea0")
    page.locator("#speed").select_option("10")
    has(page, ".badge", "PAST, PAUSED")
    page.keyboard.press("Space")
    has(page, ".badge", "PAST 10×")
    page.keyboard.press("Space")
    has(page, ".badge", "PAST, PAUSED")
    page.keyboard.press("Space")
    has(page, ".badge", "PAST 10×")
    has(page, ".badge", "ENDED")
    has(page, "[data-name=uav0]", "airfield0")
