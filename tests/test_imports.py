"""The arrows between the rooms, and which library each room may use: the table of the design, walked."""

import ast
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

import pytest
from repository import ROOT, name_of, parsed

MAY_IMPORT = {
    "bigraphs": set(),
    "physical": set(),
    "semantics": {"bigraphs", "physical"},
    "specs": {"semantics", "bigraphs", "physical"},
    "checker": {"semantics", "bigraphs", "physical"},
    "adapters": {"semantics", "bigraphs", "physical"},
    "bigactors": {"adapters", "checker", "specs", "semantics", "bigraphs", "physical"},
}

LAYERS = (
    "checker.limits",
    "checker.steps",
    "checker.recording",
    "checker.reduction",
    "checker.engines.fast.compiled",
    "checker.engines",  # the contract of all engines, graphs, the reference engine
    "checker.properties",
    "checker.engines.fast.model",
    "checker.engines.fast.store",
    "checker.engines.fast.reduce",
    "checker.engines.fast.search",
    "checker.engines.fast.survey",
    "checker.engines.fast",
    "checker.engines.cluster",
    "checker.engines.zones",
    "checker.engines.timed",
    "checker.traces",
    "checker.verdicts",
    "checker.reports",
    "checker.transition_system",
    "checker.models",
    "checker.engines.choose",
    "checker.handover",
    "checker.check",
    "checker.compile_loops",
)
"""The parts of the checker: each may import those above it in this list."""

UPWARD = {
    ("checker.engines", "checker.engines.timed"),  # for types
    ("checker.engines", "checker.transition_system"),  # methods of `Exploration`
    ("checker.engines.zones", "checker.engines.timed"),
    ("checker.properties", "checker.engines.timed"),  # first runs, and answers about time
    ("checker.properties", "checker.traces"),
    ("checker.properties", "checker.verdicts"),
}
"""The imports among these parts that go the other way; remove one from here when its last import is gone."""

ROWS_KNOW = {"columns", "decision_leaves", "decision_trees", "learned_model"}
"""Modules of the learned rules that the store of rows may import: the form of rows and tables, not the rules."""

LEAF = "physical.svg"
"""The package that every room may import, since it imports none."""

# Where a library may be imported: a room, a folder or a file.
LIBRARIES = {
    "shapely": ("physical/", "adapters/camera/votes.py", "adapters/simulated/camera.py"),
    "pyproj": ("physical/",),
    "lark": ("specs/", "bigraphs/notation/"),
    "pandas": ("checker/transition_system.py", "checker/engines/contract.py"),  # there for types
    "networkx": ("bigraphs/", "checker/", "specs/elaboration/bodies.py"),  # where a graph is a graph
    "numpy": (
        "bigraphs/simulation.py",  # independent streams of random numbers
        "checker/",
        "bigactors/commands/big/states_file.py",
        "bigactors/commands/big/temporal.py",
        "adapters/console/closest_approach.py",  # all pairs of vehicles and targets at once
        "adapters/camera/",
        "adapters/console/closest_approach.py",  # all pairs of a fleet and its targets
        "adapters/ros/position_messages.py",  # arrays of ROS's messages
        "adapters/simulated/camera.py",
        "physical/extents.py",  # arrays of shapely's coordinates, here and below
        "physical/geodesic_areas.py",
        "physical/geodesic_distances.py",
        "physical/gnomonic.py",
        "physical/line_foot.py",
        "physical/region_outlines.py",
        "physical/resting_regions.py",
    ),
    "cv2": ("adapters/camera/libraries.py",),
    "rasterio": ("adapters/camera/libraries.py",),
    "numba": ("checker/",),
    "llvmlite": ("checker/engines/fast/compiled/prefetch.py",),  # what numba has no name for
    "ray": ("checker/engines/cluster/ray_crew.py",),
    "stormpy": ("bigactors/commands/big/storm_worker.py",),
    "pytest": ("bigactors/pytest_plugin.py",),
    "jsonschema": ("bigactors/testing.py",),
    "pyais": ("physical/ais_decode.py",),
    "pymavlink": ("adapters/mavlink/codec.py",),
    "aiohttp": ("adapters/web.py",),
    "serial_asyncio_fast": ("adapters/transport.py",),
    "zenoh": ("adapters/stations/bus.py", "adapters/ros/ros_node.py", "adapters/ros/wire.py"),
    "xxhash": ("adapters/ros/wire.py",),
    "rosbags": ("adapters/ros/",),
    "msgspec": (
        "adapters/location_feed.py",
        "adapters/typed_json.py",
        "adapters/console/browser_requests.py",
        "adapters/recording/type_schemas.py",
        "adapters/stations/",
        "bigactors/studio/page_requests.py",
    ),
    "mcap": ("adapters/recording/mcap_files.py",),
    "zstandard": ("adapters/recording/mcap_files.py",),
    "lz4": ("adapters/recording/mcap_files.py",),
    "pygls": ("bigactors/lsp/language_server.py",),  # which nothing imports before it serves
    "lsprotocol": ("bigactors/lsp/language_server.py",),
    "cryptography": ("bigactors/signatures.py",),
    "hypothesis": ("semantics/hypothesis_strategies.py",),
    "wcwidth": ("bigactors/terminal.py", "checker/reports/lanes.py"),
    "argcomplete": ("bigactors/commands/completion.py",),
    "lazy_loader": tuple(
        f"{room}/__init__.py"
        for room in (
            *MAY_IMPORT,
            "bigraphs/exports",
            "bigraphs/notation",
            "checker/reduction",
            "physical/svg",
        )
    ),
    "resvg_py": ("physical/svg/picture.py",),
}

# Libraries that take long to load or are extras: imported in the functions that need them, never with the module.
LAZY = {"resvg_py"}
"""Of what every installation has, what takes long to load."""

NEED_THEIR_EXTRA = {
    "bigactors/lsp/language_server.py",
    "bigactors/pytest_plugin.py",
    "bigactors/testing.py",
    "semantics/hypothesis_strategies.py",
}
"""Modules that nothing imports where their extra is not installed."""


def always_installed() -> set[str]:
    """Return the names of the libraries that come with every installation."""
    given = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["dependencies"]
    return {re.split(r"[^\w-]", each)[0].replace("-", "_") for each in given}


class Import(NamedTuple):
    """An import statement: where it stands, what is imported, and whether the module's import runs it."""

    file: str
    line: int
    module: str
    at_import: bool

    @property
    def top(self) -> str:
        """The room or library that it imports from."""
        return self.module.split(".")[0]

    def __str__(self) -> str:
        return f"{self.file}:{self.line} imports {self.module}"


def walk(node: ast.AST, *, at_import: bool = True) -> Iterator[tuple[ast.AST, bool]]:
    """Yield statements with whether they run when the module is imported; what only type checkers read does not."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.expr):  # nothing is imported there
            continue
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            yield from ((below, False) for below, _ in walk(child))
            continue
        inside = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef)
        yield child, at_import
        yield from walk(child, at_import=at_import and not inside)


def module_of(file: str) -> str:
    return re.sub(r"(/__init__)?\.pyi?$", "", file).replace("/", ".")


FILES = [
    path
    for room in MAY_IMPORT
    for path in sorted((ROOT / room).rglob("*.py")) + sorted((ROOT / room).rglob("*.pyi"))
]
MODULES = {module_of(name_of(path)) for path in FILES}


def imports_of(path: Path) -> Iterator[Import]:
    """Yield every import of a file, those in functions too."""
    file = name_of(path)
    for node, at_import in walk(parsed(path)):
        if isinstance(node, ast.Import):
            yield from (Import(file, node.lineno, alias.name, at_import) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            package = file.rsplit("/", node.level)[0].replace("/", ".") if node.level else ""
            module = ".".join(filter(None, [package, node.module]))
            yield Import(file, node.lineno, module, at_import)
            within = [f"{module}.{alias.name}" for alias in node.names]
            yield from (Import(file, node.lineno, each, at_import) for each in within if each in MODULES)


@cache
def imports() -> list[Import]:
    """Return every import of every file, read once and by the tests of it only."""
    return [found for path in FILES for found in imports_of(path)]


# Values whose operators, texts and pictures are worked out by what is built on them.
DELEGATES = {
    "bigraphs.bigraph": {"bigraphs.algebra", "bigraphs.drawing", "bigraphs.text"},
    "checker.engines.contract": {"checker.transition_system"},
    "semantics.state.configuration": {"semantics.state.printing"},
}


def room_of(found: Import) -> str:
    return found.file.split("/")[0]


def is_of_leaf(module: str) -> bool:
    return f"{module}.".startswith(f"{LEAF}.")


def test_the_package_that_every_room_may_import_imports_none():
    own = [found for found in imports() if is_of_leaf(module_of(found.file))]
    assert own
    assert [str(found) for found in own if found.top in MAY_IMPORT and not is_of_leaf(found.module)] == []


def test_the_walk_sees_the_rooms():
    assert {room_of(found) for found in imports()} >= set(MAY_IMPORT) - {"adapters"}
    assert len(imports()) > 300


@pytest.mark.parametrize("room", MAY_IMPORT)
def test_a_room_imports_the_rooms_below_it_only(room):
    others = set(MAY_IMPORT) - MAY_IMPORT[room] - {room}
    strays = (
        found
        for found in imports()
        if room_of(found) == room and found.top in others and not is_of_leaf(found.module)
    )
    assert [
        str(found) for found in strays if found.module not in DELEGATES.get(module_of(found.file), ())
    ] == []


def test_each_library_stays_in_the_room_that_needs_it():
    known = sys.stdlib_module_names | set(MAY_IMPORT)
    strays = [
        str(found)
        for found in imports()
        if found.top not in known and not found.file.startswith(LIBRARIES.get(found.top, ("nowhere",)))
    ]
    assert strays == []


def test_what_takes_long_to_load_is_imported_where_it_is_needed():
    assert [str(found) for found in imports() if found.top in LAZY and found.at_import] == []


def test_each_module_can_be_imported_without_any_extra():
    there = always_installed() | sys.stdlib_module_names | set(MAY_IMPORT)
    strays = [found for found in imports() if found.at_import and found.top not in there]
    assert [str(found) for found in strays if found.file not in NEED_THEIR_EXTRA] == []


def test_nobody_imports_the_strategies_but_tests_and_the_module_that_offers_them():
    importing = {
        found.file for found in imports() if found.module.startswith("semantics.hypothesis_strategies")
    }
    assert importing == {"bigactors/strategies.py"}
    assert [str(found) for found in imports() if found.module.startswith("bigactors.strategies")] == []


def test_the_rooms_are_the_packages_that_are_built():
    folders = {path.parent.name for path in ROOT.glob("*/__init__.py")}
    assert folders == set(MAY_IMPORT)


@pytest.mark.parametrize("room", sorted(MAY_IMPORT.keys() - {"bigactors"}))
def test_what_a_room_offers_is_its_own(room):
    package = import_module(room)
    offered = {name: getattr(package, name) for name in getattr(package, "__all__", [])}
    modules = {name: value.__module__.split(".")[0] for name, value in offered.items() if callable(value)}
    own = {room, "types", "typing", "builtins"}  # unions and aliases do not say where they are from
    assert {name: home for name, home in modules.items() if home not in own} == {}


def test_a_function_is_not_hidden_by_the_module_of_its_name():
    program = "import checker.check, semantics.successors; from checker import check; print(check.__name__)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == "check\n"


def layer_of(module: str) -> str | None:
    return max((each for each in LAYERS if f"{module}.".startswith(f"{each}.")), key=len, default=None)


def test_the_arrows_in_the_checker_go_one_way_but_for_those_that_remain():
    found: dict[tuple[str, str], str] = {}
    for each in imports():
        one, other = layer_of(module_of(each.file)), layer_of(each.module)
        if one and other and LAYERS.index(one) < LAYERS.index(other):
            found[one, other] = str(each)
    assert [text for pair, text in found.items() if pair not in UPWARD] == []
    assert UPWARD - found.keys() == set()


def test_every_module_of_the_checker_is_in_a_layer():
    modules = {each for each in MODULES if each.startswith("checker.")}
    assert [each for each in modules if layer_of(each) is None] == []


def test_the_store_of_rows_knows_nothing_of_rules():
    store, model = "checker.engines.fast.store.", "checker.engines.fast.model."
    used = {each.module for each in imports() if module_of(each.file).startswith(store)}
    assert {each.removeprefix(model) for each in used if each.startswith(model)} == ROWS_KNOW


def test_the_arrows_have_no_cycle():
    for room, below in MAY_IMPORT.items():
        assert all(room not in MAY_IMPORT[other] for other in below)


def test_no_modules_import_each_other_in_a_circle():
    """Imports for types and in functions count; a package's own names for its modules (`__init__`) don't."""
    graph: dict[str, set[str]] = {module: set() for module in MODULES}
    for found in imports():
        module = module_of(found.file)
        if "__init__.py" not in found.file and found.module not in DELEGATES.get(module, ()):
            graph[module].add(found.module)
    assert list(TopologicalSorter(graph).static_order())  # it raises CycleError, with the circle


def test_the_walk_tells_what_runs_at_import():
    text = "import a\ndef f():\n    import b\nclass C:\n    import c\nif TYPE_CHECKING:\n    import d\n"
    found = {
        alias.name: at_import
        for node, at_import in walk(ast.parse(text))
        if isinstance(node, ast.Import)
        for alias in node.names
    }
    assert found == {"a": True, "b": False, "c": True, "d": False}
