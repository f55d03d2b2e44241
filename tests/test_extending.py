"""docs/how-to/extending.md: what it names exists, and a command that is added as it says is known everywhere."""

import ast
import json
import os
import re
import shutil
import subprocess
import sys

import pytest
from repository import ROOT, read

PAGE = read("docs/how-to/extending.md")
ROW = re.compile(r"^\| `(?P<file>[\w./]+)`(?:: `(?P<symbol>\w+)`)? \| .+ \| (?P<found>.*) \|$", re.MULTILINE)


def rows():
    return [found.groupdict() for found in ROW.finditer(PAGE)]


def defined(file):
    """Return the names that a file defines, in whatever class."""
    text = read(file)
    if not file.endswith(".py"):
        return set(re.findall(r"^[?]?(\w+):", text, re.MULTILINE))
    nodes = list(ast.walk(ast.parse(text)))
    targets = {each.target for each in nodes if isinstance(each, ast.AnnAssign)}
    targets |= {target for each in nodes if isinstance(each, ast.Assign) for target in each.targets}
    names = {each.id for each in targets if isinstance(each, ast.Name)}
    return names | {each.name for each in nodes if isinstance(each, ast.FunctionDef | ast.ClassDef)}


def test_every_row_of_the_page_is_read():
    tables = [line for line in PAGE.splitlines() if line.startswith("| `")]
    assert len(rows()) == len(tables)
    assert all(each["found"] for each in rows())


@pytest.mark.parametrize("row", rows(), ids=lambda row: row["file"])
def test_each_place_that_the_page_names_is_there(row):
    assert (ROOT / row["file"]).is_file()
    if row["symbol"]:
        assert row["symbol"] in defined(row["file"])


@pytest.mark.parametrize("found", sorted({row["found"] for row in rows()} - {"`mypy`"}))
def test_each_test_that_the_page_names_is_there(found):
    file, _, name = found.strip("`").partition("::")
    assert name in defined(file)


# --- a command is added as the page says ------------------------------------------------------------------------------

SWAP = '''
def swap(host: Name, entity: Name, other: Name) -> Sides:
    """Let two entities change places. The host has control authority over both."""
    x, y = PlaceVariable("x"), PlaceVariable("y")
    c, d = LinkVariable("c", CONTROL_AUTHORITY), LinkVariable("d", CONTROL_AUTHORITY)
    nodes, links = (host, entity, other), ((c, host), (c, entity), (d, host), (d, other))
    before, after = ((entity, x), (other, y)), ((entity, y), (other, x))
    return Pattern(nodes, before, links), Pattern(nodes, after, links)


'''
MISSION = """\
signature {
  kind Place contains Uav, Station
  kind Uav driven
  kind Station
}
world {
  east: Place = box (37.2, -8.5) (37.1, -8.6)
  west: Place = box (37.2, -8.7) (37.1, -8.8)
  u0: Uav = point (37.15, -8.55) linked control:g0
  u1: Uav = point (37.15, -8.75) linked control:g0
  g0: Station = point (37.0, -8.5) linked control:g0
}
BigActor a hosted_at g0 with_behavior {
  control(SWAP u0 WITH u1)
}
check {
  local_consistency
  deadlock_freedom
  reachable "swapped": u0 in west and actually u1 in east
}
"""
SCRIPT = """
import json, sys
from pathlib import Path
from checker import Engine, Reduction, check, report_json
from semantics import Control
from specs import MissionError, Source, format_mission, parse
from specs.elaboration import Variation, elaborate
from specs.language_reference import language_reference

text = sys.stdin.read()

def load(text, control=Control.ATOMIC):
    source = Source("swap.mission", text)
    return elaborate(parse(source), source, Path(), Variation(None, control))

def told(text):
    try:
        load(text)
    except MissionError as error:
        return [f"{each.code.number}: {each.message}; {each.hint}" for each in error.diagnostics]

def checked(engine, control, reduce=()):
    mission = load(text, control)
    report = check(mission.initial, mission.properties, engine=engine, reduce=reduce)
    return [report.configurations, report.transitions, *(each.outcome.value for each in report.verdicts)]

print(json.dumps({
    "atomic": [checked(engine, Control.ATOMIC) for engine in (Engine.REFERENCE, Engine.FAST)],
    "timed": [checked(engine, Control.TIMED) for engine in (Engine.REFERENCE, Engine.FAST)],
    "reduced": [checked(engine, Control.ATOMIC, (Reduction.POR,)) for engine in (Engine.REFERENCE, Engine.FAST)],
    "formatted": format_mission(text),
    "reference": language_reference(),
    "named": told(text.replace("u1", "SWAP")),
    "place": told(text.replace("WITH u1", "WITH west")),
    "half": told(text.replace("WITH u1", "")),
}))
"""


@pytest.fixture
def swapping(tmp_path):
    """Return what is told by a copy of semantics/ whose table of commands has one more."""
    copy = tmp_path
    shutil.copytree(ROOT / "semantics", copy / "semantics", ignore=shutil.ignore_patterns("__pycache__"))
    table = copy / "semantics" / "behaviours" / "commands.py"
    text = table.read_text(encoding="utf-8")
    head, comma, rows = text.partition("COMMANDS: Final")
    last = '        Command("DISCONNECT_HOST_FROM node", disconnect_host_from),\n'
    row = '        Command("SWAP entity WITH other", swap),\n'
    assert last in rows
    table.write_text(head + SWAP.lstrip() + comma + rows.replace(last, last + row), encoding="utf-8")
    path = os.pathsep.join(map(str, (copy, ROOT)))
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT], input=MISSION, env=os.environ | {"PYTHONPATH": path},
        capture_output=True, text=True, check=False, cwd=copy,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


@pytest.mark.long
def test_a_command_more_is_run_written_shown_and_hinted_at(swapping):
    holding = ["holds"] * 4
    assert swapping["atomic"] == swapping["reduced"] == [[3, 2, *holding]] * 2
    assert swapping["timed"] == [[4, 3, *holding]] * 2
    assert "\n  control(SWAP u0 WITH u1)\n" in swapping["formatted"]
    assert "\n- `SWAP entity WITH other`: let two entities change places." in swapping["reference"]
    assert '\n       | "SWAP" expression "WITH" expression\n' in swapping["reference"]
    assert "`SWAP`" in swapping["reference"].partition("## Words")[2]
    message = "LS111: 'SWAP' is a word of the language and cannot be a name; choose another name"
    assert swapping["named"][0] == message
    assert swapping["place"] == [
        "LS506: nothing can drive 'west' (a Place); these entities are driven: u0, u1"
    ]
    assert swapping["half"] == [
        "LS109: expected 'WITH', found ')'; control actions are SWAP entity WITH other"
    ]


# --- a command of the program is added as the page says ---------------------------------------------------------------


@pytest.fixture
def counting(tmp_path):
    """Return a program whose copy of bigactors/ has the command of the page."""
    copy = tmp_path
    shutil.copytree(ROOT / "bigactors", copy / "bigactors", ignore=shutil.ignore_patterns("__pycache__"))
    commands = copy / "bigactors" / "commands"
    text = re.search(r"<!-- file: count.py -->\n```python\n(.+?)```", PAGE, re.DOTALL)[1]
    (commands / "count.py").write_text(text, encoding="utf-8")
    table = (commands / "__init__.py").read_text(encoding="utf-8")
    first = '        "new": '
    assert first in table
    (commands / "__init__.py").write_text(
        table.replace(first, f'        "count": "count the bigActors of a mission",\n{first}'),
        encoding="utf-8",
    )
    path = os.pathsep.join(map(str, (copy, ROOT)))

    def run(*words):
        return subprocess.run(
            [sys.executable, "-m", "bigactors", *words], env=os.environ | {"PYTHONPATH": path},
            capture_output=True, text=True, check=False, cwd=copy,
        )  # fmt: skip

    return run


def test_a_command_of_the_program_more_works_and_is_in_the_help_and_hinted_at(counting):
    done = counting("count", "oil_spill")
    assert (done.returncode, done.stdout, done.stderr) == (0, "1\n", "")
    assert "\n  count       count the bigActors of a mission\n" in counting("--help").stdout
    assert "\nexamples:\n  bigactors count oil_spill\n" in counting("count", "--help").stdout
    assert counting("cuont").stderr.endswith("hint: did you mean 'count'?\n")


# --- a model is explored as the page says (tests/checker/test_models.py) ---------------------------------------------


def test_the_model_of_the_page_is_the_example():
    text = re.search(r"<!-- file: philosophers.py -->\n```python\n(.+?)```", PAGE, re.DOTALL)[1]
    assert text == read("examples/philosophers.py")
    assert len(text.splitlines()) <= 60
