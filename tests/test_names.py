"""One meaning a name: each module and each public class has a name of its own, but for the tables here.

A table lists the folders in which a name may stand, once for each place. A new name that stands elsewhere already is
renamed, or is added with its reason. The nodes of the syntax tree have the names of their meanings, and stand in no
table: a file that needs both writes `s.Assign` for the node.
"""

import ast
from collections import Counter, defaultdict

import pytest
from repository import ROOT, parsed, sources

NODES = "specs/syntax"

CLASSES = {
    "the same concept in another language: missions, `.big` and `.bgm` files, or the logic of either": {
        "Both": "bigraphs semantics/properties",
        "Box": "bigraphs physical",
        "Build": "bigraphs/notation/big specs",
        "Call": "bigraphs/notation/big semantics/behaviours",
        "Either": "bigraphs semantics/properties",
        "Findings": "bigraphs/notation/big specs/elaboration",
        "Kind": "adapters/simulated semantics/state",
        "Literal": "bigraphs/notation/big semantics/behaviours",
        "Names": "bigraphs/notation/big specs/elaboration",
        "Not": "bigraphs semantics/properties",
        "Scoped": "bigraphs bigraphs/notation/bgm",
        "Variable": "bigraphs/notation/big semantics/behaviours",
    },
    "a public name, beside another room's name for its own thing": {
        "Command": "bigactors/arguments semantics/behaviours",
        "Control": "bigraphs semantics/state",
        "Exploration": "bigactors/studio checker/engines",
        "Finding": "adapters/live checker/properties",
        "Limits": "adapters/simulated checker",
        "Match": "bigraphs semantics/behaviours semantics/behaviours",
        "Model": "bigraphs/notation/big checker",
        "Outcome": "adapters/live adapters/mavlink checker",
        "Place": "adapters/recording physical",
        "Progress": "adapters/mavlink checker/engines",
        "Region": "adapters/camera physical",
        "Signature": "bigraphs semantics/state",
        "Source": "adapters/camera specs",
        "Transition": "bigraphs semantics/state",
        "Verdict": "adapters/mavlink checker",
        "World": "adapters bigactors bigactors semantics",
    },
}

MODULES = {
    "the syntax, the elaboration and the meaning of one section": {
        "environment": "semantics specs/elaboration",
        "statements": "semantics/behaviours specs/elaboration",
        "timing": "semantics/timing specs/elaboration",
    },
    "the same part of another language's reader": {
        "codes": "bigraphs/notation specs",
        "errors": "bigraphs physical",
        "expressions": "semantics/behaviours specs/elaboration",
        "formulas": "bigraphs/notation specs/elaboration",
        "grammar": "bigraphs/notation/big specs",
        "names": "bigraphs/notation/big specs/elaboration",
        "parser": "bigactors/arguments bigraphs/notation/bgm bigraphs/notation/big specs",
        "patterns": "bigraphs/engine semantics/behaviours specs/elaboration",
        "rules": "bigraphs bigraphs/notation/big semantics specs/elaboration",
        "signature": "bigraphs semantics/state specs/elaboration",
        "storm": "bigactors/commands/big bigraphs/exports",
        "syntax": "bigraphs/notation/bgm bigraphs/notation/big",
        "systems": "bigraphs/notation/bgm bigraphs/notation/big",
        "temporal": "bigactors/commands/big semantics/properties specs/elaboration",
        "values": "bigactors/arguments bigraphs/notation/big semantics/behaviours",
    },
    "the same part of another engine": {
        "explorer": "checker/engines/cluster checker/engines/fast checker/engines/zones",
        "kernel": "checker/engines/cluster checker/engines/fast/store",
    },
    "a command, its arguments, and the module that does its work": {
        "completion": "bigactors/commands bigactors/lsp",
        "world": "bigactors/commands specs/elaboration",
    },
    "the same job for another room's values": {
        "drawing": "bigraphs physical",
        "exploration": "bigactors/studio bigraphs",
        "geometry": "physical specs/elaboration",
    },
}


def folder_of(path):
    return path.parent.relative_to(ROOT).as_posix()


def classes():
    """Yield the public classes of all modules, each with its folder; a private class serves one file only."""
    for path in sources():
        for statement in parsed(path).body:
            match statement:
                case ast.ClassDef(name) if not name.startswith("_"):
                    yield name, folder_of(path)


def modules():
    return [(path.stem, folder_of(path)) for path in sources() if not path.stem.startswith("_")]


def unexplained(named, tables):
    """Return the names that stand more than once, with the folders that no table allows."""
    allowed = {name: folders.split() for table in tables.values() for name, folders in table.items()}
    places = defaultdict(list)
    for name, folder in named:
        places[name].append(folder)
    return {
        name: folders
        for name, folders in places.items()
        if folders.count(NODES) > 1
        or (
            len(others := [each for each in folders if each != NODES]) > 1
            and Counter(others) - Counter(allowed.get(name, ()))
        )
    }


@pytest.mark.parametrize(("named", "tables"), [(classes, CLASSES), (modules, MODULES)])
def test_a_name_has_one_meaning_or_a_place_and_one_reason_in_a_table(named, tables):
    standing = list(named())
    assert unexplained(standing, tables) == {}
    rows = [
        (name, folder)
        for each in tables.values()
        for name, folders in each.items()
        for folder in folders.split()
    ]
    assert Counter(rows) - Counter(standing) == Counter()  # no place where a name no longer stands
    assert [
        name
        for name, count in Counter(name for each in tables.values() for name in each).items()
        if count > 1
    ] == []


def test_a_second_place_that_no_table_lists_is_found():
    twice = [("Kind", "adapters/simulated"), ("Kind", "semantics/state"), ("Kind", NODES)]
    assert unexplained(twice, CLASSES) == {}
    assert unexplained([*twice, ("Kind", "checker")], CLASSES).keys() == {"Kind"}
    assert unexplained([*twice, ("Kind", NODES)], CLASSES).keys() == {"Kind"}
    assert unexplained([("Novel", "checker"), ("Novel", "specs")], CLASSES).keys() == {"Novel"}
