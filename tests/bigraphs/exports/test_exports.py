"""What is exported: exact texts of small systems, and probabilities that Storm computes from them."""

import base64
import hashlib
import json
import re
import subprocess
import sys
from xml.etree import ElementTree

import pytest

from bigraphs.exploration import explore
from bigraphs.exports import graph_svg, prism_files, storm_files, to_dot, to_html, to_json
from bigraphs.notation import read_system

GAMBLER = """
atomic ctrl Coin = 0; ctrl Purse = 0; ctrl Bank = 0;
big start = Purse.Coin | Bank.(Coin | Coin);
react win = Purse.(Coin | id) | Bank.(Coin | id) -[ %s ]-> Purse.(Coin | Coin | id) | Bank.id;
react lose = Purse.(Coin | id) | Bank.(Coin | id) -[ %s ]-> Purse.id | Bank.(Coin | Coin | id);
big broke = Purse.1;
big rich = Bank.1;
begin %s
  init start;
  rules = [ {win, lose} ];
  preds = { broke, rich };
end
"""


def gambler(kind="pbrs", win="2", lose="1"):
    return explore(read_system(GAMBLER % (win, lose, kind)))


CHOICE = """
atomic ctrl A = 0; atomic ctrl B = 0; atomic ctrl C = 0;
big start = A;
action safe[1] react walk = A -[ 1 ]-> B; end
action bold[5] react leap = A -[ 1 ]-> B; react fall = A -[ 3 ]-> C; end
big home = B;
begin nbrs init start; rules = [ {walk, leap, fall} ]; preds = { home[2] }; end
"""


def test_a_markov_chain_is_written_for_prism():
    files = prism_files(gambler())
    assert sorted(files) == [".csl", ".lab", ".srew", ".tra"]
    # States: 1 coin, then 2 and 0 in the purse, then 3. Two thirds to win, as the weights say.
    assert files[".tra"] == (
        "4 6\n0 1 0.6666666666666666\n0 2 0.3333333333333333\n"
        "1 0 0.3333333333333333\n1 3 0.6666666666666666\n2 2 1\n3 3 1\n"
    )
    assert files[".lab"] == '0="init" 1="deadlock" 2="broke" 3="rich"\n0: 0\n2: 1 2\n3: 1 3\n'
    assert files[".csl"] == 'label "broke" = x=2;\nlabel "rich" = x=3;\n'


def test_a_decision_process_is_written_with_its_choices_and_rewards():
    system = explore(read_system(CHOICE))
    files = prism_files(system)
    assert files[".tra"] == "3 4 5\n0 0 1 0.25 bold\n0 0 2 0.75 bold\n0 1 1 1 safe\n1 0 1 1\n2 0 2 1\n"
    assert files[".trew"] == "3 4 3\n0 0 1 5\n0 0 2 5\n0 1 1 1\n"
    assert files[".srew"] == "3 1\n1 2\n"
    storm = storm_files(system)
    assert storm[".tra"] == "mdp\n0 0 1 0.25\n0 0 2 0.75\n0 1 1 1\n1 0 1 1\n2 0 2 1\n"
    assert storm[".lab"] == "#DECLARATION\ninit deadlock home\n#END\n0 init\n1 deadlock home\n2 deadlock\n"


CHECK = """
import sys, stormpy
folder, formula = sys.argv[1:]
from pathlib import Path
rewards = {"state_rewards": ".srew", "transition_rewards": ".trew"}
files = {name: f"{folder}/model{suffix}" for name, suffix in rewards.items()}
given = {name: file for name, file in files.items() if Path(file).exists()}
model = stormpy.build_model_from_explicit(f"{folder}/model.tra", f"{folder}/model.lab", **given)
(wanted,) = stormpy.parse_properties(formula)
print(model.model_type, stormpy.model_checking(model, wanted).get_value(model.initial_states[0]))
"""


def storm(system, formula, folder):
    """Return what Storm computes of an exported system; in a process of its own, as it warns and logs."""
    for suffix, text in storm_files(system).items():
        (folder / f"model{suffix}").write_text(text)
    done = subprocess.run(
        [sys.executable, "-c", CHECK, str(folder), formula], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    kind, value = done.stdout.split()[-2:]
    return kind, float(value)


def test_storm_computes_from_the_file_what_the_gambler_computes_by_hand(tmp_path):
    pytest.importorskip("stormpy", minversion="2.0", reason="stormpy 2.0 is not installed")
    # With p = 2/3, q = 1/3 and 1 of 3 coins, he gets rich with (1 - q/p) / (1 - (q/p)^3) = 4/7.
    kind, value = storm(gambler(), 'P=? [F "rich"]', tmp_path)
    assert (kind, value) == ("ModelType.DTMC", pytest.approx(4 / 7, abs=1e-5))


def test_storm_reads_rates_and_choices(tmp_path):
    pytest.importorskip("stormpy", minversion="2.0", reason="stormpy 2.0 is not installed")
    # Both rules have as many occurrences, so the embedded chain is the same.
    kind, value = storm(gambler("sbrs"), 'P=? [F "rich"]', tmp_path)
    assert (kind, value) == ("ModelType.CTMC", pytest.approx(4 / 7, abs=1e-5))
    system = explore(read_system(CHOICE))
    assert storm(system, 'Pmin=? [F "home"]', tmp_path) == ("ModelType.MDP", pytest.approx(0.25))
    assert storm(system, 'Pmax=? [F "home"]', tmp_path) == ("ModelType.MDP", pytest.approx(1.0))
    assert storm(system, "Rmax=? [C<=1]", tmp_path) == ("ModelType.MDP", pytest.approx(5.0))  # bold's


def test_an_incomplete_system_says_so_wherever_it_is_written():
    system = explore(read_system(GAMBLER % ("2", "1", "pbrs")), max_states=2)
    assert '2="unexpanded"' in prism_files(system)[".lab"]
    assert to_json(system)["complete"] is False
    assert "incomplete: the limit of 2 states was reached" in to_html(system, "gambler")
    assert "style=dashed" in to_dot(system)


def test_a_system_whose_first_state_was_not_found_is_written_too():
    settling = """
    atomic ctrl Off = 0; atomic ctrl On = 0;
    big off = Off;
    react press = Off --> On;
    react again = On --> On;
    begin brs init off; rules = [ (press), {again} ]; end
    """
    system = explore(read_system(settling), max_time=0)
    assert to_json(system)["states"] == []
    assert "incomplete: the limit of 0 seconds was reached" in to_html(system, "settling")
    assert graph_svg(system).startswith("<svg")
    assert all((to_dot(system), prism_files(system), storm_files(system)))


def test_dot_has_each_state_and_transition():
    text = to_dot(gambler())
    assert '  0 [label="0", penwidth=2];' in text
    assert '  0 -> 1 [label="win 0.666667"];' in text
    assert text.count("->") == 4


def test_json_is_plain_data():
    data = to_json(gambler())
    assert json.loads(json.dumps(data)) == data
    assert [state["labels"] for state in data["states"]] == [[], [], ["broke"], ["rich"]]
    assert data["transitions"][0] == {
        "from": 0,
        "to": 1,
        "rules": ["win"],
        "occurrences": 2,
        "weight": pytest.approx(2 / 3),
        "action": None,
    }


def test_the_picture_of_a_state_space_parses_and_has_a_title_for_each_state_and_transition():
    root = ElementTree.fromstring(graph_svg(gambler()))
    titles = [each.text for each in root.iter("{http://www.w3.org/2000/svg}title")]
    assert len([title for title in titles if title.startswith("state ")]) == 4
    assert len([title for title in titles if re.match(r"\d to \d: ", title)]) == 4


def data_of(page):
    return json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1].replace("<\\/", "</"))


def test_a_page_holds_everything_and_asks_nobody():
    page = to_html(gambler(), "a <gambler>")
    assert "<title>a &lt;gambler&gt;</title>" in page
    data = data_of(page)
    assert len(data["states"]) == 4
    assert data["paths"] == [0, 0, 0, 1]
    broke = [data["nodes"][node][0] for node in data["states"][2]]
    assert sorted(broke) == ["Bank", "Coin", "Coin", "Coin", "Purse"]
    assert set(re.findall(r"https?://[\w./]+", page)) == {"http://www.w3.org/2000/svg"}


def test_of_a_large_system_a_page_shows_the_first_states_and_says_so(monkeypatch):
    monkeypatch.setattr("bigraphs.exports.html.MOST_STATES", 3)
    page = to_html(gambler(), "gambler")
    assert "4 states, 4 transitions, complete, shown: the first 3 states" in page
    data = data_of(page)
    assert [move[:2] for move in data["moves"]] == [[0, 1], [0, 2], [1, 0]]


def switches(count):
    """Return the system of switches that can each be on or off: every combination is a state."""
    start = " | ".join(f"On{{s{number}}}" for number in range(count))
    return explore(
        read_system(
            f"atomic ctrl On = 1; atomic ctrl Off = 1; big start = {start};\n"
            "react off = On{x} --> Off{x}; react on = Off{x} --> On{x};\n"
            "begin brs init start; rules = [ {off, on} ]; end"
        )
    )


def test_a_page_of_a_thousand_states_writes_equal_nodes_once():
    page = to_html(switches(10), "switches")
    data = data_of(page)
    assert (len(data["states"]), len(data["moves"]), len(data["nodes"])) == (1_024, 10_240, 20)
    assert len(page) < 300_000


def test_the_first_state_stands_in_the_first_row():
    places = data_of(to_html(gambler(), "gambler"))["places"]
    assert [y for _, y in places] == [30, 105, 105, 180]


def test_the_page_runs_only_its_own_script():
    page = to_html(gambler(), "gambler")
    script = re.findall(r"<script>(.*?)</script>", page, re.S)
    digest = base64.b64encode(hashlib.sha256(script[0].encode()).digest()).decode()
    assert len(script) == 1
    assert f"script-src 'sha256-{digest}'" in page


def test_the_transition_system_is_a_networkx_graph():
    graph = gambler().to_networkx()
    assert graph.nodes[3] == {"labels": ("rich",)}
    assert sorted((a, b, data["rules"], data["occurrences"]) for a, b, data in graph.edges(data=True)) == [
        (0, 1, ("win",), 2),
        (0, 2, ("lose",), 2),
        (1, 0, ("lose",), 2),
        (1, 3, ("win",), 2),
    ]
