"""One meaning a name: each module and each public class has a name of its own, but for the tables here.

A table lists the folders in which a name may stand, once for each place. A new name that stands elsewhere already is
renamed, or is added with its reason.
"""

import ast
from collections import Counter, defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
ROOMS = ("adapters", "bigactors", "bigraphs", "checker", "physical", "semantics", "specs")

CLASSES = {
    "the node of the syntax tree, and its meaning; a file that needs both writes `s.Assign` for the node": {
        "After": "semantics/behaviours specs/syntax",
        "Appears": "semantics specs/syntax",
        "Assign": "semantics/behaviours specs/syntax",
        "Case": "semantics/behaviours specs/syntax",
        "Choose": "semantics/behaviours specs/syntax",
        "ChooseFrom": "semantics/behaviours specs/syntax",
        "Drops": "semantics specs/syntax",
        "Enabled": "semantics/properties specs/syntax",
        "Ended": "semantics/properties specs/syntax",
        "Fairness": "semantics/properties specs/syntax",
        "For": "semantics/behaviours specs/syntax",
        "HostedAt": "semantics/properties specs/syntax",
        "If": "semantics/behaviours specs/syntax",
        "Inside": "semantics/properties specs/syntax",
        "Invariant": "checker/properties specs/syntax",
        "Known": "semantics/properties specs/syntax",
        "Leaves": "semantics specs/syntax",
        "Loop": "semantics/behaviours specs/syntax",
        "Migrate": "semantics/behaviours specs/syntax",
        "Motion": "semantics/timing specs/syntax",
        "Observe": "semantics/behaviours specs/syntax",
        "Present": "semantics/properties specs/syntax",
        "React": "semantics/behaviours specs/syntax",
        "Says": "semantics specs/syntax",
        "Scheduler": "semantics/state specs/syntax",
        "Send": "semantics/behaviours specs/syntax",
        "Spawn": "semantics/behaviours specs/syntax",
        "Steps": "semantics/properties specs/syntax",
        "Taken": "semantics/properties specs/syntax",
        "TimeLimit": "semantics specs/syntax",
        "Timing": "semantics/timing specs/syntax",
        "Vanishes": "semantics specs/syntax",
        "While": "semantics/behaviours specs/syntax",
    },
    "the same concept in another language: missions, `.big` and `.bgm` files, or the logic of either": {
        "Both": "bigraphs semantics/properties",
        "Box": "bigraphs physical specs/syntax",
        "Build": "bigraphs/notation/big specs",
        "Call": "bigraphs/notation/big semantics/behaviours specs/syntax",
        "Either": "bigraphs semantics/properties",
        "Findings": "bigraphs/notation/big specs/elaboration",
        "Kind": "adapters/simulated semantics/state specs/syntax",
        "Literal": "bigraphs/notation/big semantics/behaviours",
        "Names": "bigraphs/notation/big specs/elaboration",
        "Not": "bigraphs semantics/properties",
        "Scoped": "bigraphs bigraphs/notation/bgm",
        "Span": "bigraphs/notation specs/syntax",
        "Variable": "bigraphs/notation/big semantics/behaviours",
    },
    "a public name, beside another room's name for its own thing": {
        "Command": "bigactors/arguments semantics/behaviours specs/syntax",
        "Control": "bigraphs semantics/state specs/syntax",
        "Limits": "adapters/simulated checker",
        "Match": "bigraphs semantics/behaviours semantics/behaviours specs/syntax",
        "Node": "bigraphs specs/syntax",
        "Outcome": "adapters/live adapters/mavlink checker",
        "Place": "adapters/recording physical",
        "Progress": "adapters/mavlink checker/engines specs/syntax",
        "Rule": "bigraphs specs/syntax",
        "Signature": "bigraphs semantics/state specs/syntax",
        "Source": "adapters/camera specs",
        "Transition": "bigraphs semantics/state",
        "Verdict": "adapters/mavlink checker",
        "World": "adapters bigactors bigactors semantics specs/syntax",
    },
    "two jobs in adapters/ or bigactors/, each inside its own folder": {
        "Believes": "adapters specs/syntax",
        "Broken": "adapters adapters/live",
        "Condition": "adapters/mavlink bigraphs",
        "Display": "adapters/console semantics/behaviours specs/syntax",
        "Entry": "adapters/stations bigactors/pictures",
        "Failed": "adapters bigactors",
        "Finding": "adapters/live checker/properties",
        "Frame": "adapters/camera adapters/mavlink bigactors/pages",
        "GiveBack": "adapters adapters/console",
        "Item": "adapters/mavlink bigraphs",
        "Lines": "adapters bigactors/lsp",
        "Link": "adapters/console adapters/mavlink adapters/ros",
        "Live": "adapters/console specs/syntax",
        "Message": "adapters/mavlink adapters/recording adapters/stations",
        "Position": "adapters/mavlink adapters/ros",
        "Preflight": "adapters bigactors/commands/run",
        "Refused": "adapters bigactors/lsp",
        "Route": "bigraphs semantics/behaviours",
        "Row": "bigactors/pictures semantics/state",
        "Sent": "adapters adapters/stations",
        "Telling": "adapters/mavlink bigactors/pages",
        "Text": "adapters/mavlink semantics/behaviours",
        "Underway": "adapters adapters/mavlink",
        "Vehicle": "adapters/mavlink adapters/simulated",
        "View": "adapters/camera adapters/console",
        "Waiting": "adapters/live semantics/properties specs/syntax",
    },
}

MODULES = {
    "the syntax, the elaboration and the meaning of one section": {
        "environment": "semantics specs/elaboration",
        "live": "specs/elaboration specs/syntax",
        "statements": "semantics/behaviours specs/elaboration specs/syntax",
    },
    "the same part of another language's reader": {
        "codes": "bigraphs/notation specs",
        "declarations": "bigraphs/notation/big specs/syntax",
        "errors": "bigraphs physical",
        "expressions": "bigraphs/notation/big semantics/behaviours specs/elaboration specs/syntax",
        "formulas": "bigactors/commands/big bigraphs/notation specs/elaboration specs/syntax",
        "grammar": "bigraphs/notation/big specs",
        "names": "bigraphs/notation/big specs/elaboration",
        "parser": "bigactors/arguments bigraphs/notation/bgm bigraphs/notation/big specs",
        "patterns": "bigraphs/engine semantics/behaviours specs/elaboration specs/syntax",
        "rules": "bigraphs bigraphs/notation/big semantics specs/elaboration",
        "signature": "bigraphs semantics/state specs/elaboration",
        "storm": "bigactors/commands/big bigraphs/exports",
        "strategies": "bigactors semantics",
        "syntax": "bigraphs/notation/bgm bigraphs/notation/big",
        "systems": "bigraphs/notation/bgm bigraphs/notation/big",
        "temporal": "bigactors/commands/big semantics/properties specs/elaboration",
        "values": "bigactors/arguments bigraphs/notation/big semantics/behaviours",
    },
    "the same part of another engine": {
        "explorer": "checker/engines/cluster checker/engines/fast checker/engines/zones",
        "kernel": "checker/engines/cluster checker/engines/fast checker/engines/zones",
    },
    "a command, its arguments, and the module that does its work": {
        "completion": "bigactors/commands bigactors/lsp",
        "world": "bigactors/commands specs/elaboration specs/syntax",
    },
    "the same job for another room's values": {
        "drawing": "bigraphs physical",
        "geometry": "physical specs/elaboration",
    },
    "two jobs, each inside its own folder": {
        "actions": "adapters/console specs/syntax",
        "agents": "adapters/console semantics/state",
        "configuration": "bigactors/pictures semantics/state",
        "diagnostics": "bigactors specs",
        "feed": "adapters adapters/camera adapters/ros",
        "fences": "adapters/simulated bigactors/commands/run",
        "limits": "adapters/live checker",
        "link": "adapters/mavlink adapters/ros",
        "messages": "adapters/ros adapters/stations",
        "missions": "adapters/simulated bigactors",
        "occurrences": "bigactors/lsp bigraphs/engine",
        "preflight": "adapters/console bigactors/commands/run",
        "printing": "bigactors semantics/state",
        "reading": "adapters/recording bigactors/lsp",
        "requests": "adapters/console semantics/state",
        "server": "adapters/console bigactors/lsp",
        "sightings": "adapters/camera adapters/live",
        "state": "adapters/live adapters/simulated",
        "stations": "adapters/console bigactors/commands/run",
        "steps": "adapters/console checker",
        "timing": "adapters/live semantics/timing specs/elaboration specs/syntax",
        "vehicle": "adapters/ros adapters/simulated",
        "view": "adapters/camera adapters/console",
        "watchers": "adapters/live bigactors",
    },
}


def sources():
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*.py")):
            if "node_modules" not in path.parts:
                yield path, path.parent.relative_to(ROOT).as_posix()


def classes():
    """Yield the public classes of all modules, each with its folder; a private class serves one file only."""
    for path, folder in sources():
        for statement in ast.parse(path.read_text(encoding="utf-8")).body:
            match statement:
                case ast.ClassDef(name) if not name.startswith("_"):
                    yield name, folder


def modules():
    for path, folder in sources():
        if not path.stem.startswith("_"):
            yield path.stem, folder


def unexplained(named, tables):
    """Return the names that stand more than once, with the folders that no table allows."""
    allowed = {name: folders.split() for table in tables.values() for name, folders in table.items()}
    places = defaultdict(list)
    for name, folder in named:
        places[name].append(folder)
    return {
        name: folders
        for name, folders in places.items()
        if len(folders) > 1 and Counter(folders) - Counter(allowed.get(name, ()))
    }


@pytest.mark.parametrize(("named", "tables"), [(classes, CLASSES), (modules, MODULES)])
def test_a_name_has_one_meaning(named, tables):
    assert unexplained(named(), tables) == {}


@pytest.mark.parametrize(("named", "tables"), [(classes, CLASSES), (modules, MODULES)])
def test_a_table_lists_no_place_where_a_name_no_longer_stands(named, tables):
    standing = Counter(named())
    listed = Counter(
        (name, folder)
        for table in tables.values()
        for name, folders in table.items()
        for folder in folders.split()
    )
    assert listed - standing == Counter()


@pytest.mark.parametrize("tables", [CLASSES, MODULES])
def test_a_name_has_one_reason(tables):
    names = Counter(name for table in tables.values() for name in table)
    assert {name for name, count in names.items() if count > 1} == set()


def test_a_second_place_that_no_table_lists_is_found():
    twice = [("Assign", "semantics/behaviours"), ("Assign", "specs/syntax")]
    assert unexplained(twice, CLASSES) == {}
    assert unexplained([*twice, ("Assign", "checker")], CLASSES).keys() == {"Assign"}
    assert unexplained([("Novel", "checker"), ("Novel", "specs")], CLASSES).keys() == {"Novel"}
