"""Plugins of other packages: found by their entry points, loaded when they are asked for, blamed by name."""

import sys

import pytest

from adapters.addresses import SCHEMES
from bigactors.arguments import parse_arguments
from bigactors.cli import main
from bigactors.commands.run.connections import plugins_of
from bigactors.commands.run.feeds import FEEDS
from bigactors.installed_plugins import find_detector
from bigactors.mission_lookup import open_mission
from bigactors.mistakes import Mistake
from semantics.state.setting import Control, Scheduler
from specs.elaboration import Variation

LIVE = Variation(Scheduler.FCFS, Control.TIMED)
MODULE = """
from physical import PhysicalError

class Boat:
    def __init__(self, name, address="", vehicles=()):
        self.name, self.address, self.vehicles = name, address, vehicles
    async def run(self, world): ...
    async def command(self, command): ...
    def owns(self, entity):
        return entity in {each.entity for each in self.vehicles}

def broken(*asked):
    return {}["harbour"]

def nothing(*asked):
    pass

def stranger(name, address, vehicles):
    return Boat(name, address)

def picky(name, address, vehicles):
    raise PhysicalError("boat", f"{address!r} is no harbour", "write HOST:PORT")

def renamed(name, address, vehicles):
    return Boat("boat", address, vehicles)


def hulls(frame):
    return ()
"""
DECLARED = """
[bigactors.plugins.vehicles]
boat = boats:Boat
broken = boats:broken
lost = no_such_module:Boat
nothing = boats:nothing
picky = boats:picky
renamed = boats:renamed
stranger = boats:stranger
twice = boats:Boat

[bigactors.plugins.feeds]
buoys = boats:Boat

[bigactors.plugins.detectors]
hulls = boats:hulls
"""


@pytest.fixture
def boats(tmp_path, monkeypatch):
    """Install a package, and another that declares one scheme of it again."""
    for package, version, declared in (
        ("boats", "1.2", DECLARED),
        ("others", "3", "[bigactors.plugins.vehicles]\ntwice = others:Boat\n"),
    ):
        folder = tmp_path / f"{package}-{version}.dist-info"
        folder.mkdir()
        (folder / "METADATA").write_text(
            f"Metadata-Version: 2.1\nName: {package}\nVersion: {version}\nSummary: {package} by a line\n"
        )
        (folder / "entry_points.txt").write_text(declared)
    (tmp_path / "boats.py").write_text(MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    yield
    sys.modules.pop("boats", None)


def made(*line):
    options = parse_arguments(["run", "spill_watch", *line])
    return plugins_of(options, open_mission("spill_watch", LIVE))


@pytest.mark.usefixtures("boats")
def test_the_scheme_of_an_installed_plugin_chooses_it_and_it_is_told_what_to_drive():
    (plugin, feed), owners = made(
        "--vehicle=uav0=boat:here:1", "--feed=buoys=there", "--time-to-live=vehicles=12"
    )
    assert (plugin.name, plugin.address, owners) == ("boat:here:1", "here:1", {"uav0": "boat:here:1"})
    (uav0,) = plugin.vehicles
    assert (uav0.entity, uav0.kind, uav0.time_to_live) == ("uav0", "UAV", 12.0)
    assert uav0.channels == ("control:gcs0",)
    assert uav0.fence is not None
    assert (feed.name, feed.address) == ("buoys1", "there")


@pytest.mark.usefixtures("boats")
@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("--vehicle=uav0=baot:1", ["'baot' is no way to connect a vehicle", "did you mean 'boat'?"]),
        (
            "--vehicle=uav0=zeppelin:1",
            ["'zeppelin' is no way to connect", "udp, tcpin", "boat", "bigactors plugins"],
        ),
        ("--vehicle=uav0=lost:1", ["'lost' cannot be loaded: ModuleNotFoundError", "a fault of boats 1.2"]),
        ("--vehicle=uav0=broken:1", ["'broken' cannot be made: KeyError: 'harbour'", "a fault of boats 1.2"]),
        ("--vehicle=uav0=nothing:1", ["'nothing' makes a NoneType", "a fault of boats 1.2"]),
        ("--vehicle=uav0=stranger:1", ["'stranger' does not own uav0", "a fault of boats 1.2"]),
        ("--vehicle=uav0=renamed:1", ["'renamed' is named 'boat', not 'renamed:1'", "a fault of boats 1.2"]),
        ("--vehicle=uav0=picky:1", ["'1' is no harbour", "write HOST:PORT"]),
        ("--vehicle=uav0=twice:1", ["'twice' is declared by", "boats 1.2", "others 3"]),
        ("--vehicle=uav0:3=boat:1", ["'uav0' has an id of MAVLink"]),
        ("--feed=buoy=1", ["there is no feed 'buoy'", "did you mean 'buoys'?"]),
    ],
)
def test_a_run_with_a_plugin_that_cannot_be_made_does_not_begin_and_says_whose_fault_it_is(
    line, says, capsys
):
    more = [] if "vehicle" in line else ["--vehicle=uav0=boat:1"]
    assert main(["run", "spill_watch", "--unverified", line, *more]) == 2
    error = capsys.readouterr().err
    assert [each for each in says if each not in error] == []


@pytest.mark.usefixtures("boats")
def test_the_list_has_each_plugin_with_its_package_and_loads_none(capsys):
    assert main(["plugins"]) == 0
    lines = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert lines.count("--vehicle NAME=boat:ADDRESS boats 1.2 boats by a line") == 1
    assert [line for line in lines if line.startswith("--feed buoys=ADDRESS boats 1.2 ")]
    assert "boats" not in sys.modules


def test_the_list_has_all_that_bigactors_connects_itself(capsys):
    assert main(["plugins"]) == 0
    out = capsys.readouterr().out
    assert [scheme for scheme in SCHEMES if f"NAME={scheme}:" not in out] == ["file"]
    assert [kind for kind in FEEDS if f"--feed {kind}=" not in out] == []


@pytest.mark.usefixtures("boats")
def test_an_installed_detector_is_found_by_its_name_and_listed(capsys):
    found = find_detector("hulls")
    assert (found.__module__, found.__name__) == ("boats", "hulls")
    assert main(["plugins"]) == 0
    assert "--detector hulls" in capsys.readouterr().out
    with pytest.raises(Mistake, match="there is no detector 'hull'"):
        find_detector("hull")
