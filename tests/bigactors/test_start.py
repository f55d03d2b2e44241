"""What a command loads before it answers: the time that it takes to start, as something that can be counted."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from bigactors.commands import NAMES

ROOT = Path(__file__).parents[2]
KNOWN = {
    *(
        "aiohttp",
        "cryptography",
        "hypothesis",
        "lark",
        "lazy_loader",
        "llvmlite",
        "mcap",
        "networkx",
        "numba",
    ),
    *("numpy", "pyais", "pymavlink", "pyproj", "ray", "resvg_py", "scipy", "shapely", "zenoh"),
}
SCRIPT = """
import contextlib, io, json, sys
before = set(sys.modules)
from bigactors.cli import main
with contextlib.redirect_stdout(io.StringIO()):
    code = main(sys.argv[1:])
print(json.dumps([code, sorted(set(sys.modules) - before)]))
"""
COLLECTIONS = """
import contextlib, gc, io, sys
from bigactors.cli import main
before = gc.get_stats()
with contextlib.redirect_stdout(io.StringIO()):
    main(sys.argv[1:])
sys.exit(gc.get_stats() != before)
"""
MISSION = """
signature { kind Location contains UAV  kind UAV driven }
world { a: Location = box (0, 0) (1, 1)  u: UAV = point (0.5, 0.5) }
BigActor pilot hosted_at u with_behavior { observe(ALL) }
"""


@pytest.fixture
def start(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.mission").write_text(MISSION)
    (tmp_path / "one.big").write_text("ctrl A = 0; big a = A.1; begin brs init a; rules = []; end")

    def start(*line):
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT, *line], capture_output=True, text=True, check=True
        )
        code, modules = json.loads(done.stdout)
        assert code == 0, done.stderr
        return set(modules)

    return start


def libraries(modules):
    """Return the libraries among them that the project names itself."""
    return {name.split(".")[0] for name in modules} & KNOWN


def commands(modules):
    """Return the commands whose modules are among them."""
    return {name.split(".")[2] for name in modules if name.startswith("bigactors.commands.")}


def test_the_arguments_of_all_commands_load_nothing_of_their_work():
    script = "import sys; from bigactors.arguments import make_parser; make_parser(); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert commands(loaded) == {name.replace("-", "_") for name in NAMES}
    assert libraries(loaded) == set()
    rooms = {"adapters", "bigraphs", "checker", "physical", "semantics", "specs"}
    assert {name for name in loaded if name.split(".")[0] in rooms} == set()


FAST = "checker.engines.fast"
SMALL = "lazy_loader lark numpy pyproj shapely"
STARTS = [
    ("--help", "", set(), ""),
    ("--version", "", set(), ""),
    ("check --help", "", {"check"}, "checker specs"),
    ("--color never hold --help", "", {"hold"}, ""),
    ("explain LS201", "lazy_loader", {"explain"}, "specs.syntax specs.grammar semantics.state.configuration"),
    (
        "fmt --stdout m.mission",
        "lazy_loader lark",
        {"fmt"},
        (
            "specs.elaboration semantics.state.configuration physical.shape checker semantics.behaviours.statements "
            "specs.common_mistakes specs.syntax_errors"
        ),
    ),
    (
        "big full one.big",
        "lazy_loader",
        {"big"},
        "hashlib pickle random tempfile bigraphs.notation.bgm checker.engines semantics",
    ),
    (
        "check m.mission --json r.json",
        SMALL,
        {"check"},
        (
            "adapters bigactors.signatures checker.engines.fast.explorer checker.engines.cluster.ray_crew "
            "checker.properties.temporal checker.reduction.reducer checker.reports.sarif physical.ais_reports xml "
            "matplotlib"
        ),
    ),
    (
        "check --engine fast m.mission",
        f"{SMALL} llvmlite numba scipy",
        {"check"},
        f"scipy.linalg checker.reduction.reducer {FAST}.search.crosscheck {FAST}.reduce.ample_kernel",
    ),
]


@pytest.mark.parametrize(("line", "used", "named", "unused"), STARTS, ids=[row[0] for row in STARTS])
def test_a_line_loads_the_libraries_and_the_command_that_it_needs_alone(start, line, used, named, unused):
    if "one.big" in line:
        start("big", "validate", "one.big")  # the tables are kept from now on, if they were not
    loaded = start(*line.split())
    assert libraries(loaded) == set(used.split())
    assert commands(loaded) == named
    assert loaded & set(unused.split()) == set()


def test_what_is_loaded_is_not_looked_through_for_garbage(tmp_path):
    mission = tmp_path / "m.mission"
    mission.write_text(MISSION)
    subprocess.run([sys.executable, "-c", COLLECTIONS, "check", str(mission)], check=True)


@pytest.mark.parametrize("call", ["script()", "main(sys.argv[1:])"])
def test_at_its_end_a_process_does_not_look_through_what_was_loaded(call):
    program = (
        f"import gc, sys; from bigactors.cli import main, script; {call}; sys.exit(gc.get_freeze_count() > 0)"
    )
    line = [sys.executable, "-c", program, "explain", "LS201"]
    done = subprocess.run(line, capture_output=True, check=False)
    assert bool(done.returncode) == (call == "script()")
