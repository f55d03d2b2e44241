"""What no vehicle can do is said before take-off."""

import asyncio
from contextlib import suppress

import pytest
from consoles import free_port

from adapters.simulated import Kind, Simulator, Vehicle, run
from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run.flight import fly, prepare
from bigactors.mistakes import Mistake

WORLD = """
mission carrier
signature {
  kind Location contains Location, Ship, UAV, Buoy, Mast, Pad
  kind Pad contains UAV
  kind Ship carries UAV
  kind UAV driven carries Buoy
  kind Buoy
  kind Mast
}
world {
  west0: Location = box (37.02, -8.64) (37.00, -8.66)
  east0: Location = box (37.02, -8.60) (37.00, -8.62)
  pad0: Pad = circle (37.01, -8.61) radius 40 m
  ship0: Ship = point (37.012, -8.615) linked wifi
  mast0: Mast = point (37.011, -8.616) linked wifi
  gcs0: Mast = point (37.03, -8.63) linked control:gcs0
  gcs1: Mast = point (37.04, -8.63) linked control:gcs1
  uav0: UAV = point (37.01, -8.65) linked control:gcs0
  buoy0: Buoy carried by uav0
}
"""


def mission(folder, *statements):
    path = folder / "carrier.mission"
    body = "\n".join(f"  {each}" for each in statements)
    path.write_text(f"{WORLD}\nBigActor a hosted_at uav0 with_behavior {{\n{body}\n}}\n")
    return str(path)


def line(folder, *statements):
    return ["run", mission(folder, *statements), "--unverified", "--vehicle=uav0=udp:127.0.0.1:0"]


@pytest.mark.parametrize(
    ("statement", "reason"),
    [
        ("control(MOVE_HOST_TO ship0)", "no report can confirm that uav0 is aboard ship0"),
        ("control(PUT buoy0 IN west0)", "no report can confirm that buoy0 is put into west0"),
        ("control(CONNECT_HOST_TO mast0)", "no report can confirm that uav0 joins or leaves a channel"),
        (
            "control({ HOST[c].$0 || gcs1[d].$1 || east0.$2 -> gcs1[d].$1 || east0.(HOST[d].$0 | $2) })",
            "uav0 joins or leaves a channel",  # handed over and moved at once
        ),
        ("control({ HOST || mast0[wifi] -> HOST[wifi] || mast0[wifi] })", "uav0 joins or leaves wifi"),
    ],
)
def test_what_nothing_would_ever_confirm_is_refused_before_anything_is_heard(
    tmp_path, capsys, statement, reason
):
    assert main([*line(tmp_path, statement), "--wait", "0.1"]) == 2
    told = capsys.readouterr().err
    assert "carrier.mission:24: a would request an impossible flight" in told
    assert reason in told
    assert "nothing was heard" not in told


def test_what_only_may_be_asked_for_is_a_warning(tmp_path, capsys):
    options = parse_arguments(
        line(tmp_path, "choose place in {west0, ship0} { control(MOVE_HOST_TO place) }")
    )
    prepare(options)
    told = capsys.readouterr().err
    assert "warning: a may request an impossible flight: MOVE_HOST_TO ship0" in told


async def flown(flight, vehicle):
    task = asyncio.ensure_future(fly(flight, ()))
    link = flight.plugins[-1] if flight.company is None else flight.plugins[-1].plugin
    while not link.local and not task.done():
        await asyncio.sleep(0.05)
    simulator = Simulator(f"udpout:127.0.0.1:{link.local[1]}", [vehicle])
    simulation = asyncio.ensure_future(simulator.run())
    try:
        return await task
    finally:
        simulation.cancel()
        with suppress(asyncio.CancelledError):
            await simulation


def options(folder, *statements):
    return parse_arguments([*line(folder, *statements), "--socket", str(folder / "s"), "--for", "600"])


FENCED = {"FENCE_ENABLE": 1.0}


@pytest.mark.parametrize(
    ("vehicle", "places", "fence", "told"),
    [
        ((Kind.PLANE, {}), ("east0", "pad0"), "world", (25, "pad0 is too small: .* needs a circle of 104 m")),
        ((Kind.PLANE, {}), ("east0",), "west0", (24, "lies outside the fence")),
        (
            (Kind.ROVER, FENCED),
            ("east0",),
            "world",
            (24, "its circle fence of 300 m around home does not hold east0"),
        ),
    ],
    ids=["too small for its circle", "outside the fence", "not held by its own fence"],
)
def test_a_place_where_it_cannot_go_is_refused_before_take_off(
    tmp_path, capsys, vehicle, places, fence, told
):
    (kind, parameters), (line, said) = vehicle, told
    craft = Vehicle(kind, (37.01, -8.65, 20.0), parameters=parameters)
    asked = options(tmp_path, *(f"control(MOVE_HOST_TO {each})" for each in places))
    asked.fence = fence
    with pytest.raises(Mistake, match=said) as error:
        run(flown(prepare(asked), craft))
    assert error.value.place.endswith(f"carrier.mission:{line}")
    warned = "warning: uav0 keeps within 300 m around home (FENCE_RADIUS), too" in capsys.readouterr().err
    assert warned == bool(parameters)
    assert not craft.armed


def test_what_is_passed_outside_the_fence_is_refused_with_its_line_and_may_be_small(tmp_path):
    plane = Vehicle(Kind.PLANE, (37.01, -8.65, 20.0))
    statements = ("control(MOVE_HOST_TO west0 VIA pad0)", "control(MOVE_HOST_TO west0 VIA pad0, far0)")
    asked = options(tmp_path, *statements)
    text = (tmp_path / "carrier.mission").read_text()
    far = "far0: Location = circle (37.09, -8.59) radius 30 m\n  range0: Location = box (37.05, -8.55) (36.95, -8.7)"
    (tmp_path / "carrier.mission").write_text(text.replace("  ship0:", f"  {far}\n  ship0:"))
    asked.fence = "range0"
    with pytest.raises(Mistake, match="VIA pad0, far0: it cannot: far0 lies outside the fence") as error:
        run(flown(prepare(asked), plane))
    assert error.value.place.endswith("carrier.mission:27")
    assert not plane.armed


def test_a_copter_flies_where_a_plane_could_not(tmp_path):
    copter = Vehicle(Kind.COPTER, (37.01, -8.65, 20.0))
    ending = run(flown(prepare(options(tmp_path, "control(MOVE_HOST_TO pad0)")), copter))
    assert ending.reason == "the mission has ended"
    assert ending.state.configuration.structure.logical.parent("uav0") == "pad0"
    assert copter.fence is not None


def test_of_several_stations_each_refuses_what_its_own_vehicles_cannot_do(tmp_path):
    plane = Vehicle(Kind.PLANE, (37.01, -8.65, 20.0))
    (tmp_path / "peers.toml").write_text(
        f'[gcs0]\nconnect = ["tcp/127.0.0.1:{free_port()}"]\nhosts = ["uav0"]\n'
        f'[gcs1]\nconnect = ["tcp/127.0.0.1:{free_port()}"]\n'
    )
    asked = options(tmp_path, "control(MOVE_HOST_TO east0)", "control(MOVE_HOST_TO pad0)")
    asked.station, asked.peers = [("gcs0", None)], str(tmp_path / "peers.toml")
    asked.station_log = str(tmp_path / "gcs0.log")
    with pytest.raises(Mistake, match=r"pad0 is too small: .* the plane needs a circle of 104 m"):
        run(flown(prepare(asked), plane))
    assert not plane.armed
