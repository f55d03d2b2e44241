"""An operator's journey in a browser: real runs, simulated autopilots over MAVLink, from the start panel to the end.

Each screen is looked at by axe, and photographed in three sizes, light and dark, into the test's folder or the one that
BIGACTORS_SCREENSHOTS names.
"""

import os
import signal
import socket
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from browsers import DESK, PATIENCE, PHONE, Watch, chromium, overflow, until
from consoles import begun, free_port, link_of

from bigactors.cli import main

pytestmark = pytest.mark.long

AXE = Path(__file__).parents[2] / "adapters/console/page/node_modules/axe-core/axe.min.js"
SIZES = {"desk": DESK, "tablet": {"width": 1024, "height": 768}, "phone": PHONE}
FAULTS = """async () => (await axe.run(document, { resultTypes: ["violations"] })).violations
  .map(({ id, nodes }) => `${id}: ${nodes[0].html}`)"""
SPEED = 5
"""Of the vehicles' seconds in one of the run's: each flight takes longer than a busy machine needs to look at it."""

FLEET = '''
import asyncio, sys
from pathlib import Path
from adapters.simulated import Kind, Simulator, Vehicle, run
from adapters.simulated.serving import NONE, Disturbance

async def flies(folder, *links):
    """Fly a copter for each link; files in a folder say what befalls it."""
    fleet = [Vehicle(Kind.COPTER, (37.09, -8.6 + n / 1000, 20.0)) for n in range(len(links))]
    simulators = [Simulator(to, [copter]) for to, copter in zip(links, fleet)]
    flying = [asyncio.ensure_future(each.run()) for each in simulators]
    while not any(each.done() for each in flying):
        for n, (copter, simulator) in enumerate(zip(fleet, simulators)):
            befalls = {what for what in ("compass", "silence", "battery") if (folder / f"{what} {n}").exists()}
            copter.fault = "Compass not calibrated" if "compass" in befalls else ""
            simulator.disturbance = Disturbance(loss=1.0) if "silence" in befalls else NONE
            if "battery" in befalls:
                copter.parameters |= {"BATT_FS_LOW_ACT": 2.0, "BATT_LOW_TIMER": 1.0, "BATT_LOW_VOLT": 30.0}
        await asyncio.sleep(0.5)

run(flies(Path(sys.argv[1]), *sys.argv[3:]), float(sys.argv[2]))
'''
SIGNATURE = """
signature {
  kind Location contains Location, UAV, Station
  kind UAV driven
  kind Station
}
"""
PATROL = f"""mission patrol {SIGNATURE}
world {{
  sea0: Location = box (37.10, -8.50) (36.98, -8.70)
  west0: Location = box (37.06, -8.66) (37.02, -8.69)
  mid0: Location = box (37.06, -8.60) (37.02, -8.63)
  east0: Location = box (37.06, -8.53) (37.02, -8.56)
  base0: Location = circle (37.09, -8.60) radius 500 m
  gcs0: Station = point (37.0905, -8.60) linked control:gcs0
  uav0: UAV = point (37.09, -8.600) linked control:gcs0
  uav1: UAV = point (37.09, -8.599) linked control:gcs0
  uav2: UAV = point (37.09, -8.598) linked control:gcs0
}}
def watch(place) = {{
  control(MOVE_HOST_TO place)
  react {{ case "home" => control(MOVE_HOST_TO base0) }}
}}
BigActor west hosted_at uav0 with_behavior watch(west0)
BigActor mid hosted_at uav1 with_behavior watch(mid0)
BigActor east hosted_at uav2 with_behavior watch(east0)
environment {{
  uav0 arrives
  uav1 arrives
  uav2 arrives
  says "home" to west at most once
  says "home" to mid at most once
  says "home" to east at most once
}}
live {{ on broken assumption: continue }}
check {{
  local_consistency
  race_freedom
}}
"""
RELAY = f"""mission relay {SIGNATURE}
world {{
  west0: Location = box (37.11, -8.59) (37.07, -8.61)
  east0: Location = box (37.11, -8.45) (37.07, -8.47)
  gcs0: Station = point (37.06, -8.60) linked control:gcs0, internet
  gcs1: Station = point (37.06, -8.59) linked control:gcs1, internet
  uav0: UAV = point (37.09, -8.6) linked control:gcs0
}}
BigActor op0 hosted_at gcs0 with_behavior {{
  loop {{ react {{ case "handover" => control(HAND uav0 TO gcs1)
                                    observe(LINKED_TO_HOST)
                                    react {{ case view => send "yours" to op1 }} }} }}
}}
BigActor op1 hosted_at gcs1 with_behavior {{
  loop {{ react {{ case "yours" => observe(LINKED_TO_HOST)
                                 react {{ case view => control(MOVE uav0 TO east0) }} }} }}
}}
environment {{
  uav0 arrives
  says "handover" to op0 at most once
}}
live {{ on broken assumption: continue }}
check {{
  local_consistency
  race_freedom
  deadlock_freedom
}}
"""


@pytest.fixture(scope="module")
def browser():
    if not AXE.exists():
        pytest.skip("axe-core is not there: `make parts` fetches it")
    with chromium() as found:
        yield found


class Operator:
    """An operator before the console of a real run."""

    def __init__(self, page, name, folder):
        self.page, self.name = page, name
        self.folder = Path(os.environ.get("BIGACTORS_SCREENSHOTS", folder))
        page.set_default_timeout(3 * PATIENCE)  # vehicles fly on a busy machine

    def sees(self, selector, text=""):
        self.page.locator(selector, has_text=text).first.wait_for()

    def is_titled(self, text):
        until(self.page, "text => document.title.includes(text)", text, 3 * PATIENCE)

    def presses(self, label):
        """Press a button until it has acted, after a second."""
        button = f"button[aria-label^='{label}']"
        self.page.locator(button).first.hover()
        self.page.mouse.down()
        self.page.locator(f"{button}.pressed").wait_for()
        self.page.locator(f"{button}.pressed").wait_for(state="detached")
        self.page.mouse.up()

    def opens(self, vehicle):
        if not self.page.locator(f".card[data-name={vehicle}]").count():
            self.page.locator(f"[data-row={vehicle}] .name").first.click()
        self.sees(f".card[data-name={vehicle}]")

    def acknowledges(self, message):
        self.sees(".alert .message", message)
        self.page.locator(".acknowledge:enabled").click()
        self.page.locator(".alert .message", has_text=message).wait_for(state="detached")

    def looks(self, what):
        """Photograph the screen, and let axe look at it, in three sizes, light and dark."""
        for size, viewport in SIZES.items():
            self.page.set_viewport_size(viewport)
            for scheme in ("light", "dark"):
                self.page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
                self.sees(f".screen.{'phone' if size == 'phone' else 'desk'}")
                self._looks(f"{what}-{self.name}-{size}-{scheme}")
                if size == "phone":
                    self.page.locator("#tab-vehicles").click()
                    self.sees("#cards")
                    self._looks(f"{what}-{self.name}-{size}-{scheme}-vehicles")
                    self.page.locator("#tab-map").click()
        self.page.set_viewport_size(DESK)
        self.sees(".screen.desk")

    def _looks(self, name):
        self.page.screenshot(path=self.folder / f"{name}.png")
        assert overflow(self.page) == 0, name
        assert self.page.evaluate(FAULTS) == [], name


@contextmanager
def seated(browser, link, name, folder):
    """Seat an operator before a console; at the end, nothing may have gone wrong in the page."""
    watch = Watch()
    context = browser.new_context(
        viewport=DESK, bypass_csp=True
    )  # the page's policy lets no test's script in
    page = watch.over(context.new_page(), link.partition("#")[0])
    page.goto(link)
    page.locator("#who-name").fill(name)
    page.locator("#who-name").press("Enter")
    page.add_script_tag(path=AXE)
    yield Operator(page, name, folder)
    context.close()
    watch.forgive("ERR_CONNECTION")  # a run may end before its page
    watch.saw_nothing()


@contextmanager
def fleet(folder, count, form):
    """Fly copters; yield the addresses that runs give for them."""
    ports = [free_port(socket.SOCK_DGRAM) for _ in range(count)]
    links = [form.format(port) for port in ports]
    with begun("-c", FLEET, folder, SPEED, *links):
        yield [("udp" if form.startswith("udpout") else "udpout") + f":127.0.0.1:{port}" for port in ports]


def verified(folder, text):
    """Write a mission, and the verdict on it."""
    mission = folder / "m.mission"
    mission.write_text(text)
    line = [
        "check",
        "--no-traces",
        "--control",
        "timed",
        "--verdict",
        str(folder / "m.verdict.json"),
        str(mission),
    ]
    assert main(line) == 0
    return mission


def run_line(folder, mission, name, *more):
    console = f"127.0.0.1:{free_port()}"
    return [
        "-m",
        "bigactors",
        "run",
        mission,
        f"--socket={folder / name}.sock",
        f"--console={console}",
        *more,
    ]


def test_an_operator_flies_three_vehicles_through_their_misfortunes(browser, tmp_path):
    mission = verified(tmp_path, PATROL)
    (tmp_path / "compass 1").touch()
    with fleet(tmp_path, 3, "udpout:127.0.0.1:{}") as addresses:
        vehicles = [f"--vehicle=uav{n}={address}" for n, address in enumerate(addresses)]
        with (
            begun(*run_line(tmp_path, mission, "run", *vehicles, f"--record={tmp_path / 'r.mcap'}")) as run,
            seated(browser, link_of(run), "Ana", tmp_path) as ana,
        ):
            starts_though_one_refuses_to_arm(ana)
            sees_that_it_does_not_set_out(ana, tmp_path)
            sees_how_long_a_link_is_lost_and_that_it_comes_back(ana, tmp_path)
            sees_why_another_flies_home_and_what_follows(ana, tmp_path)
            holds_one_and_sends_it_home(ana)
            run.send_signal(signal.SIGINT)
            ana.sees(".badge", "ENDED")
            ana.looks("7-ended")
            assert run.wait(60) == 3


def starts_though_one_refuses_to_arm(ana):
    ana.sees(".preflight .bad", "PreArm: Compass not calibrated")
    ana.sees(".calm", "uav1, it refuses to arm: PreArm: Compass not calibrated")
    ana.sees(".preflight .start:enabled")
    ana.sees(".actions .none", "The run has not started: press Start first.")
    assert ana.page.locator(".held:not(.start)").count() == 0
    ana.looks("1-start")
    ana.presses("Start the run")
    ana.page.locator(".preflight").wait_for(state="detached")


def sees_that_it_does_not_set_out(ana, folder):
    ana.sees("[data-row=uav0]", "base0 → under way to west0")
    ana.sees("[data-row=uav1]", "it has not set out to mid0: PreArm: Compass not calibrated")
    ana.sees(".calm", "1 to be watched: uav1, it has not set out to mid0")
    ana.looks("2-not-set-out")
    (folder / "compass 1").unlink()
    ana.opens("uav1")
    ana.sees(".card[data-name=uav1] dd", "GUIDED · armed")


def sees_how_long_a_link_is_lost_and_that_it_comes_back(ana, folder):
    (folder / "silence 0").touch()
    ana.sees(".alert .cause", "uav0: nothing was heard of uav0")
    ana.sees(".alert .consequence", "orders reach it once it is heard")
    ana.is_titled("uav0: lost link")
    ana.sees("[data-row=uav0] .link", "link lost")
    ana.looks("3-lost")
    (folder / "silence 0").unlink()
    ana.sees(".alert .consequence", "it is heard again")
    ana.acknowledges("nothing was heard of uav0")
    ana.acknowledges("uav0: is not on control:gcs0")
    until(ana.page, "!document.title.startsWith('(')", patience=3 * PATIENCE)


def sees_why_another_flies_home_and_what_follows(ana, folder):
    (folder / "battery 2").touch()
    ana.sees(".alert .cause", "uav2: was taken over: it said 'Battery 1 is low")
    ana.sees(".alert .consequence", "the mission does not command it until it is given back")
    ana.is_titled("uav2: taken over")
    ana.opens("uav2")
    ana.sees(".card[data-name=uav2] .place", "flies home")
    ana.sees(".card[data-name=uav2] .on-return", "Each order overrules the pilot or the fail-safe")
    ana.looks("4-fail-safe")


def holds_one_and_sends_it_home(ana):
    ana.opens("uav1")
    ana.presses("Hold uav1")
    ana.sees(".card[data-name=uav1] .ordered", "to hold, by Ana: confirmed by the vehicle")
    ana.sees("[data-row=uav1]", "watch")
    ana.looks("5-held")
    ana.presses("Return uav1")
    ana.sees(".card[data-name=uav1] .ordered", "to return, by Ana: confirmed by the vehicle")
    ana.sees(".card[data-name=uav1] .place", "flies home")
    ana.sees(".fates li", "return uav1")
    ana.looks("6-returns")


def test_two_stations_hand_a_vehicle_over_and_both_pages_show_who_has_it(browser, tmp_path):
    mission = verified(tmp_path, RELAY)
    peers = tmp_path / "peers.toml"
    peers.write_text(
        "".join(f'[{each}]\nconnect = ["tcp/127.0.0.1:{free_port()}"]\n' for each in ("gcs0", "gcs1"))
    )
    with fleet(tmp_path, 1, "udp:127.0.0.1:{}") as (address,), ExitStack() as stack:
        runs, seats = [], []
        for name, who in (("gcs0", "Ana"), ("gcs1", "Rui")):
            more = [f"--station={name}", f"--peers={peers}", f"--vehicle=uav0={address}"]
            more += [f"--station-log={tmp_path / name}.log", f"--record={tmp_path / name}.mcap"]
            runs.append(stack.enter_context(begun(*run_line(tmp_path, mission, name, *more))))
            seats.append(stack.enter_context(seated(browser, link_of(runs[-1]), who, tmp_path)))
        ana, rui = seats
        start_one_after_the_other(ana, rui)
        see_whom_the_vehicle_obeys(ana, rui, "gcs0")
        for each in seats:
            each.looks("8-before")
        ana.presses("say “handover” to op0")
        see_whom_the_vehicle_obeys(rui, ana, "gcs1")
        for each in seats:
            each.sees(".card .place", "west0 → under way to east0")
        rui.presses("Hold uav0")
        rui.sees(".card .ordered", "to hold, by Rui: confirmed by the vehicle")
        for each in seats:
            each.looks("9-after")
        for run in runs:
            run.send_signal(signal.SIGINT)
            assert run.wait(60) == 3


def start_one_after_the_other(ana, rui):
    for each, other in ((ana, "gcs1"), (rui, "gcs0")):
        each.sees(".preflight .done", f"station {other} is reached")
        each.sees(".preflight .done", "it has not started yet")
    ana.presses("Start the run")
    ana.page.locator("#tab-stations").click()
    ana.sees(".stations tr.bad", "not started")
    rui.page.locator(".preflight .done", has_text="it has not started yet").wait_for(state="detached")
    rui.presses("Start the run")
    ana.page.locator(".stations tr.bad").wait_for(state="detached")
    rui.page.locator("#tab-stations").click()
    ana.page.locator("#tab-actions").click()


def see_whom_the_vehicle_obeys(its, other, station):
    """Look at the page of the station that a vehicle obeys, and at the other's: both say so, and one takes orders."""
    for each in (its, other):
        each.sees(".card dd", station)
    its.sees(".card [aria-label^='Hold uav0']:enabled")
    other.sees(".card .orders", f"obeys {station}: order it there")
    assert other.page.locator(".card .held").count() == 0
