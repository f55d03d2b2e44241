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


@pytest.mark.parametrize("line", [["--help"], ["check", "--help"], ["--version"]])
def test_help_loads_nothing(start, line):
    assert libraries(start(*line)) == set()


def commands(modules):
    """Return the commands whose modules are among them."""
    return {name.split(".")[2] for name in modules if name.startswith("bigactors.commands.")}


def test_the_list_of_commands_loads_no_command(start):
    assert commands(start("--help")) == set()


def test_a_line_loads_the_command_that_it_names_alone(start):
    assert commands(start("--color", "never", "hold", "--help")) == {"hold"}


def test_the_arguments_of_all_commands_load_nothing_of_their_work():
    script = "import sys; from bigactors.arguments import make_parser; make_parser(); print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert commands(loaded) == {name.replace("-", "_") for name in NAMES}
    assert libraries(loaded) == set()
    rooms = {"adapters", "bigraphs", "checker", "physical", "semantics", "specs"}
    assert {name for name in loaded if name.split(".")[0] in rooms} == set()


def test_explain_loads_the_codes_alone(start):
    loaded = start("explain", "LS201")
    assert libraries(loaded) == {"lazy_loader"}
    assert not loaded & {"specs.syntax", "specs.grammar", "semantics.state.configuration"}


def test_fmt_loads_the_parser_and_no_meaning(start):
    loaded = start("fmt", "--stdout", "m.mission")
    assert libraries(loaded) == {"lazy_loader", "lark"}
    assert not loaded & {"specs.elaboration", "semantics.state.configuration", "physical.shape", "checker"}
    assert not loaded & {"semantics.behaviours.statements", "specs.common_mistakes", "specs.syntax_errors"}


def test_a_small_big_file_is_explored_without_lark_or_anything_that_it_does_not_ask_for(start, tmp_path):
    (tmp_path / "one.big").write_text("ctrl A = 0; big a = A.1; begin brs init a; rules = []; end")
    start("big", "validate", "one.big")  # the tables are kept from now on, if they were not
    loaded = start("big", "full", "one.big")
    assert libraries(loaded) == {"lazy_loader"}
    assert not loaded & {
        "hashlib",
        "pickle",
        "random",
        "tempfile",
        "bigraphs.notation.bgm",
        "checker.engines",
        "semantics",
    }


def test_a_check_of_a_small_mission_loads_no_compiler(start):
    loaded = start("check", "m.mission")
    assert libraries(loaded) == {"lazy_loader", "lark", "numpy", "pyproj", "shapely"}
    assert not loaded & {
        "adapters",
        "bigactors.signatures",
        "checker.engines.fast.explorer",
        "checker.engines.cluster.ray_crew",
        "checker.properties.temporal",
        "checker.reduction.reducer",
        "checker.reports.sarif",
        "physical.ais_reports",
        "xml",
    }


def test_compiled_loops_load_no_more_than_numba(start):
    loaded = start("check", "--engine", "fast", "m.mission")
    small = {"lazy_loader", "lark", "numpy", "pyproj", "shapely"}
    assert libraries(loaded) == small | {"llvmlite", "numba", "scipy"}
    assert not loaded & {
        "scipy.linalg",
        "checker.reduction.reducer",
        "checker.engines.fast.crosscheck",
        "checker.engines.fast.ample_kernel",
    }


@pytest.mark.parametrize("line", [["fmt", "--stdout"], ["check"]])
def test_what_is_loaded_is_not_looked_through_for_garbage(tmp_path, line):
    mission = tmp_path / "m.mission"
    mission.write_text(MISSION)
    subprocess.run([sys.executable, "-c", COLLECTIONS, *line, str(mission)], check=True)


@pytest.mark.parametrize("own", [True, False], ids=["its own line", "a line that is given"])
def test_at_its_end_a_process_does_not_look_through_what_was_loaded(own):
    line = ["explain", "LS201"]
    given = "" if own else repr(line)
    script = (
        f"import gc, sys; from bigactors.cli import main; main({given}); sys.exit(gc.get_freeze_count() > 0)"
    )
    done = subprocess.run([sys.executable, "-c", script, *line], capture_output=True, check=False)
    assert bool(done.returncode) == own
