"""The table of capabilities: each pair runs as the reference engine does, or is refused in the table's own words."""

import ast
import importlib.util

import pytest
from option_pairs import FEATURES, PAIRS, WRONG, folded, marked, of_system, text_of
from repository import name_of, parsed, sources
from scale import long_if

from bigactors.arguments import make_parser
from bigactors.cli import main
from checker import Engine, Reduction
from checker.engines.capabilities import ENGINES, NEEDS, REDUCTIONS, UNSUPPORTED, Feature, pair_of

WORDS = {
    Feature.WORKERS: ["--workers", "2"],
    Feature.THREADS: ["--threads", "2"],
    Feature.CHECKPOINT: ["--checkpoint", "kept"],
    Feature.SPILL: ["--spill", "spilled", "--max-memory", "4G"],
    Feature.PARANOID: ["--paranoid", "5"],
    Feature.TIMING: [],
}
HAS_RAY = importlib.util.find_spec("ray") is not None
CASES = [
    pytest.param(
        *pair, id="-".join(each.name for each in pair), marks=[pytest.mark.long] * (Feature.RAY in pair)
    )
    for pair in PAIRS
]
REDUCED = Feature.POR, Feature.SYMMETRY
REFUSED = [pair for pair in UNSUPPORTED if pair.why.is_refusal and pair.one is not Feature.MODEL]


@pytest.mark.parametrize(("one", "other"), CASES)
def test_each_pair_runs_as_the_reference_engine_does_or_is_refused_by_the_table(one, other):
    pair = pair_of(one, other)
    if Feature.RAY in (one, other) and not HAS_RAY and (pair is None or not pair.why.is_refusal):
        pytest.skip("Ray is not installed")
    mark = marked(one, other)
    assert mark.startswith("✓") or (pair is not None and mark == pair.reason)


@pytest.mark.parametrize(
    "other",
    [pytest.param(each, id=each.name, marks=long_if(each in REDUCED)) for each in FEATURES[2:]],
)
def test_folded_rows_and_systems_of_bigraphs_agree_with_the_reference_too(other):
    assert not folded(other).startswith(WRONG)
    assert not of_system(other).startswith(WRONG)


@pytest.mark.parametrize("pair", REFUSED, ids=lambda pair: f"{pair.one.name}-{pair.other.name}")
def test_the_command_line_refuses_a_pair_in_the_words_of_the_table(pair, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = text_of(2, 1, False, timing=Feature.TIMING in (pair.one, pair.other))
    (tmp_path / "pair.mission").write_text(text)
    words = [word for each in (pair.one, pair.other) for word in WORDS.get(each, each.value.split())]
    assert main(["check", "pair.mission", *words]) == 2
    told = capsys.readouterr().err
    assert told.endswith(f"{pair.reason}\n  hint: {pair.remedy}\n")
    if Feature.TIMING not in (pair.one, pair.other):  # else the mission is read first
        assert [path.name for path in tmp_path.iterdir()] == ["pair.mission"]


NEEDY = list(zip((["--workers", "2"], ["--resume"], ["--spill", "spilled"]), NEEDS, strict=True))


@pytest.mark.parametrize(("words", "need"), NEEDY)
def test_an_option_without_the_one_that_it_needs_is_refused(words, need, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["check", "oil_spill", *words]) == 2
    assert capsys.readouterr().err.endswith(f"{need.reason}\n  hint: {need.remedy}\n")
    assert not list(tmp_path.iterdir())


def test_no_pair_is_refused_outside_the_table():
    """Engines and the command line raise no refusal of their own; reductions refuse single missions."""
    files = {"CombinationError": set(), "EngineError": set(), "RefusedError": set()}
    for path in sources(("checker", "bigactors")):
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
                files.get(ast.unparse(node.exc.func), set()).add(name_of(path))
    assert files["CombinationError"] == {"checker/engines/capabilities.py"}
    assert files["EngineError"] == set()
    assert all(file.startswith("checker/reduction/") for file in files["RefusedError"])


def test_every_engine_and_reduction_is_a_feature():
    options = make_parser()[1]["check"].parse_args
    assert {ENGINES[engine].value for engine in Engine} == {f"--engine {each.value}" for each in Engine}
    assert {REDUCTIONS[each].value for each in Reduction} == {f"--reduce {each}" for each in Reduction}
    assert all(options(["x", "--engine", each.value]).engine == each.value for each in Engine)


def test_each_pair_has_one_row():
    rows = [frozenset({pair.one, pair.other}) for pair in UNSUPPORTED]
    assert len(set(rows)) == len(rows)
