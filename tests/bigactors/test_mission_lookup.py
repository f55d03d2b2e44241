import os
from collections import Counter
from itertools import product
from pathlib import Path

import pytest
from geojson import collection, feature
from scale import crossed

from bigactors.mission_lookup import canonical, digest_of, locate, open_mission
from bigactors.mistakes import Mistake
from physical import circle
from semantics.state.setting import Control, Scheduler
from specs.elaboration import Variation
from specs.missions import shipped_missions

AGENT = "BigActor a hosted_at boat0 with_behavior { skip }\n"


@pytest.fixture
def with_file(missions):
    """Write a mission whose world is a file, and return the path of that."""
    text = 'signature { kind Boat driven }\nworld { from "a.geojson" }\n' + AGENT
    (missions / "with_file.mission").write_text(text)
    (missions / "a.geojson").write_text(collection(feature("boat0", "Boat", [1, 3])))
    return missions / "a.geojson"


def test_the_digest_is_of_the_text_and_of_what_the_files_say(with_file):
    first = digest_of(open_mission("with_file.mission", Variation()))
    assert first == digest_of(open_mission("with_file.mission", Variation()))
    with_file.write_text(collection(feature("boat0", "Boat", [2, 3])))
    assert digest_of(open_mission("with_file.mission", Variation())) != first
    assert digest_of(open_mission("holds.mission", Variation())) != digest_of(
        open_mission("race.mission", Variation())
    )


def test_the_digest_does_not_depend_on_where_the_mission_is(missions):
    (missions / "sub").mkdir()
    (missions / "sub" / "same.mission").write_text((missions / "holds.mission").read_text())
    assert digest_of(open_mission("sub/same.mission", Variation())) == digest_of(
        open_mission("holds.mission", Variation())
    )


def test_long_polygons_are_told_apart():
    assert canonical(circle((1, 1), 500)) != canonical(circle((1, 1), 501))


def test_a_file_goes_before_a_shipped_mission_of_its_name(missions):
    assert locate("oil_spill") == shipped_missions()["oil_spill"]
    (missions / "oil_spill").write_text("")
    assert str(locate("oil_spill")) == "oil_spill"


@pytest.mark.usefixtures("missions")
@pytest.mark.parametrize("word", ["", "no\0where", "x" * 5000, "no/such.mission"])
def test_what_is_no_mission_is_told(word):
    with pytest.raises(Mistake):
        locate(word)


def test_what_a_mission_takes_for_a_path_may_not_be_readable(missions, refused):
    path = missions / "big.mission"
    path.write_bytes(b"x" * 2_000_000)
    assert "LS001" in refused("check", "big.mission")


BELIEVING = """
signature { kind Location contains Location, UAV  kind UAV driven }
world {
  sea0: Location = box (37.2, -8.5) (36.9, -8.9)
  bay0: Location = box (37.1, -8.6) (37.0, -8.8)
  uav0: UAV = point (37.05, -8.7)
}
believes { bay0 unknown }
BigActor a hosted_at uav0 with_behavior { observe(ALL) react { case obs => skip } }
"""


@crossed(
    [*shipped_missions(), "believing.mission"],
    {f"{scheduler}-{control}": (scheduler, control) for scheduler, control in product(Scheduler, Control)},
)
def test_a_mission_read_once_is_under_another_scheduler_what_it_would_be_read_again(
    missions, name, variation
):
    (missions / "believing.mission").write_text(BELIEVING, encoding="utf-8")
    read, (scheduler, control) = open_mission(name, Variation()), variation
    may_be_atomic = read.setting.timing is None and read.setting.regions is None
    control = control if may_be_atomic else Control.TIMED
    again = open_mission(name, Variation(scheduler, control))
    assert digest_of(read.under(scheduler, control)) == digest_of(again)


@pytest.mark.parametrize(
    ("line", "reads"),
    [
        ("check with_file.mission --verdict v.json --control timed --output sarif:x.sarif", (1, 1)),
        ("simulate with_file.mission", (1, 1)),
        ("replay run.json", (0, 1)),
        ("show --trace run.json --against run.json", (0, 2)),
        ("show with_file.mission", (1, 1)),
    ],
)
@pytest.mark.usefixtures("with_file")
def test_every_command_reads_a_mission_and_its_files_once(bigactors, monkeypatch, line, reads):
    """A trace has its mission's text; two traces are of two missions."""
    assert bigactors("simulate", "with_file.mission", "--json", "run.json")[0] == 0
    opened, really_open = Counter(), os.open

    def counting(path, *more):
        opened[Path(path).name] += 1
        return really_open(path, *more)

    monkeypatch.setattr(os, "open", counting)
    assert bigactors(*line.split())[0] == 0
    assert (opened["with_file.mission"], opened["a.geojson"]) == reads
