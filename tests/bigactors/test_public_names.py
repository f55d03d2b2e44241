"""The public API: one import, one home for each name."""

import subprocess
import sys
from importlib import import_module

import pytest

import bigactors

ROOMS = ("adapters", "bigactors", "bigraphs", "checker", "physical", "semantics", "specs")


@pytest.mark.parametrize("name", bigactors.__all__)
def test_each_public_name_is_what_its_home_has(name):
    homes = [home for home, names in bigactors.HOMES.items() if name in names]
    assert len(homes) == 1
    value = getattr(bigactors, name)
    assert value is getattr(import_module(homes[0]), name)


@pytest.mark.parametrize("name", bigactors.__all__)
def test_each_public_name_is_defined_in_the_room_of_its_home(name):
    home = next(home for home, names in bigactors.HOMES.items() if name in names)
    assert getattr(bigactors, name).__module__.split(".")[0] == home.split(".")[0]


@pytest.mark.parametrize("room", ROOMS)
def test_what_a_room_offers_is_its_own(room):
    package = import_module(room)
    offered = {name: getattr(package, name) for name in getattr(package, "__all__", [])}
    modules = {name: value.__module__.split(".")[0] for name, value in offered.items() if callable(value)}
    own = {room, "types", "typing", "builtins"}  # unions and aliases do not say where they are from
    assert room == "bigactors" or {name: home for name, home in modules.items() if home not in own} == {}


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        bigactors.nothing  # noqa: B018 - the access is the test


def test_the_names_are_listed():
    assert set(bigactors.__all__) <= set(dir(bigactors))


def loaded_by(code):
    script = f"import sys; {code}; print(*sorted({{name.split('.')[0] for name in sys.modules}}))"
    return set(
        subprocess.run(
            [sys.executable, "-c", script], capture_output=True, text=True, check=True
        ).stdout.split()
    )


def test_importing_the_package_loads_no_room_and_no_library():
    assert not loaded_by("import bigactors") & {"shapely", "pyproj", "lark", "matplotlib", *ROOMS[2:]}


@pytest.mark.usefixtures("missions")
def test_no_picture_no_matplotlib():
    found = loaded_by(
        "import bigactors.cli, bigactors.drawings; bigactors.cli.main(['check', 'holds.mission', '--json', 'r.json'])"
    )
    assert "shapely" in found
    assert "matplotlib" not in found
    assert "hypothesis" not in found
