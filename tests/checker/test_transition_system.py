"""The transition system for other tools: as a graph and as a table."""

import subprocess
import sys

import networkx as nx
import pytest

from checker import Engine, explore
from specs.elaboration import load_mission

SIZES = {"oil_spill": (34, 74), "handover": (23, 34)}


@pytest.fixture(scope="module", params=[Engine.REFERENCE, Engine.FAST])
def engine(request):
    return request.param


@pytest.mark.parametrize("name", SIZES)
def test_the_graph_has_every_configuration_and_transition(name, engine):
    mission = load_mission(name)
    graph = explore(mission.initial, edges=True, engine=engine).to_networkx()
    assert (graph.number_of_nodes(), graph.number_of_edges()) == SIZES[name]
    assert graph.nodes[0]["configuration"] == mission.initial
    assert set(nx.descendants(graph, 0)) | {0} == set(graph)


def test_a_transition_says_what_it_is(engine):
    graph = explore(load_mission("oil_spill").initial, edges=True, engine=engine).to_networkx()
    first = {data["label"]: data for _, _, data in graph.out_edges(0, data=True)}
    label = "⟨req_ctr : a, control(MOVE_HOST_TO searchArea0)⟩"
    about = "control(MOVE_HOST_TO searchArea0)"
    assert first[label] == {"rule": "req_ctr", "agent": "a", "about": about, "label": label}
    assert {data["agent"] for data in first.values() if data["rule"] == "env"} == {None}


def test_the_table_has_a_row_for_each_transition(engine):
    found = explore(load_mission("oil_spill").initial, edges=True, engine=engine)
    table = found.to_pandas()
    assert list(table.columns) == ["source", "target", "rule", "agent", "about", "label"]
    assert len(table) == found.transitions == 74
    assert table["rule"].value_counts().to_dict() == dict(found.rules)
    assert table["source"].is_monotonic_increasing


def test_without_transitions_there_is_no_graph():
    found = explore(load_mission("oil_spill").initial)
    for asked in (found.to_networkx, found.to_pandas):
        with pytest.raises(ValueError, match=r"explore\(\.\.\., edges=True\)"):
            asked()


def test_without_pandas_the_error_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    found = explore(load_mission("oil_spill").initial, edges=True)
    with pytest.raises(ImportError, match=r"pip install '\.\[notebook\]'"):
        found.to_pandas()


def test_exploring_loads_no_pandas():
    script = (
        "import sys; from checker import explore; from specs.elaboration import load_mission;"
        "explore(load_mission('handover').initial, edges=True); print('pandas' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
