"""UPPAAL's XML: read back by its own words, searched as it is, and by foreign programs where they are."""

import os
import re
import subprocess
from xml.etree import ElementTree as ET

import pytest
from checked_missions import load
from hypothesis import HealthCheck, given
from scale import IS_WHOLE, examples
from shipped import TIMED
from timed_missions import with_timing
from timed_models import ENDURANCE, EQUAL, agree, found_by_tchecker, questions, timed_verdicts, written

from checker import check
from checker.engines.zones.timed_automaton import Constraint, Edge, Location, TimedAutomaton
from checker.engines.zones.uppaal import uppaal_text
from checker.engines.zones.zone_search import Search
from checker.verdicts import Outcome
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import Ended
from semantics.timing.intervals import Interval
from semantics.timing.timing import Timing
from specs.elaboration import load_mission


def verdict_of(text):
    """Tell what a file says of its query: its automaton as it is written, searched with all clocks everywhere."""
    nta = ET.fromstring(text)
    template = nta.find("template")
    declared = template.findtext("declaration", "clock ;").removeprefix("clock ").removesuffix(";")
    clocks = {name: at for at, name in enumerate(filter(None, declared.split(", ")), 1)}

    def label(element, kind):
        return next((each.text for each in element.findall("label") if each.get("kind") == kind), "")

    def comparisons(text):
        return [
            re.fullmatch(r"(x\d+) (<=|>=|>) (\d+)", each).groups()
            for each in filter(None, text.split(" && "))
        ]

    automaton, numbers, invariants = TimedAutomaton(), {}, {}
    first = template.find("init").get("ref")
    every = tuple(automaton.clock(1 << 20, 1 << 20) for _ in clocks)
    query = nta.findtext("queries/query/formula")
    for location in template.findall("location"):
        stands = location.find("urgent") is not None
        bounds = [(clocks[clock], int(most)) for clock, _, most in comparisons(label(location, "invariant"))]
        goal = Constraint(0, 0) if query == f"A[] not mission.{location.findtext('name')}" else None
        name = location.get("id")
        invariants[name] = bounds
        numbers[name] = automaton.add(Location(every, ((0, -1),) if stands else tuple(bounds), goal))
    edges = {name: [] for name in numbers}
    for step, transition in enumerate(template.findall("transition")):
        source, target = (transition.find(end).get("ref") for end in ("source", "target"))
        sets = dict(each.split(" = ") for each in filter(None, label(transition, "assignment").split(", ")))
        assert set(sets.values()) <= {"0"}
        tests = [
            Constraint(clocks[clock], 0, int(bound))
            if relation == "<="
            else Constraint(clocks[clock], int(bound) + (relation == ">"))
            for clock, relation, bound in comparisons(label(transition, "guard"))
        ]
        kept = tuple(0 if clock in sets else at for clock, at in clocks.items())
        entering = [Constraint(clock, 0, most) for clock, most in invariants[target] if kept[clock - 1]]
        edges[source].append(Edge(step, (*tests, *entering), numbers[target], kept))
    for source, several in edges.items():
        automaton.leave(numbers[source], several)
    search = Search(automaton, numbers[first], [0] * len(clocks))
    search.finish(lambda: None)
    return Outcome.HOLDS if search.found < 0 else Outcome.VIOLATED


def read_back(model):
    return verdict_of(uppaal_text(model))


@pytest.mark.parametrize("name", TIMED if IS_WHOLE else [name for name in TIMED if name != "oil_spill_timed"])
def test_a_shipped_mission_read_back_has_its_verdicts(name):
    mission = load_mission(name)
    agree(mission.initial, mission.properties, read_back)


@pytest.mark.parametrize("bound", range(3, 9) if IS_WHOLE else (4, 7))
def test_equal_requests_keep_the_names_of_their_clocks(bound):
    timing = Timing(react=Interval(0, 1), messages=(("", Interval(1, 3)),))
    c = with_timing(load(EQUAL).initial, timing)
    asked = Property(PropertyKind.WITHIN, "within", Ended("b"), bound=bound)
    assert any("_1" in place.name for place in written(c, asked).processes[0].places)
    agree(c, (asked,), read_back)


@examples(90 if IS_WHOLE else 30, deadline=None, suppress_health_check=list(HealthCheck))
@given(questions())
def test_a_generated_mission_read_back_has_its_verdicts(question):
    c, asked = question
    agree(c, (asked, ENDURANCE), read_back)


# --- programs that nobody here wrote


def translated(model, folder):
    """Translate the XML by uppaal-to-tchecker, which reads it by UPPAAL's own parser of its day, and ask TChecker."""
    xml, tck = folder / "model.xml", folder / "translated.tck"
    xml.write_text(uppaal_text(model), encoding="utf-8")
    subprocess.run([os.environ["UTOT"], "-e", str(xml), str(tck)], check=True, capture_output=True)
    text = re.sub(r"[()]", "", tck.read_text(encoding="utf-8"))  # TChecker nests no conjunctions
    assert text.count("location:mission:wrong{") == 1  # and it looks for labels, which UPPAAL does not have
    return found_by_tchecker(re.sub(r"(?<=location:mission:wrong)\{.*", "{labels: wrong}", text), folder)


abroad = pytest.mark.skipif(
    not {"UTOT", "TCHECKER"} <= set(os.environ),
    reason="UTOT and TCHECKER name no programs `utot` and `tck-reach`",
)


@abroad
@pytest.mark.parametrize("name", TIMED)
def test_tchecker_comes_to_the_same_verdicts_of_what_is_translated(tmp_path, name):
    mission = load_mission(name)
    agree(mission.initial, mission.properties, lambda model: translated(model, tmp_path))


@abroad
@examples(200, deadline=None, suppress_health_check=list(HealthCheck))
@given(questions())
def test_tchecker_comes_to_the_same_verdicts_of_generated_missions_that_are_translated(
    tmp_path_factory, question
):
    c, asked = question
    folder = tmp_path_factory.mktemp("abroad")
    agree(c, (asked, ENDURANCE), lambda model: translated(model, folder))


@pytest.mark.skipif("UTAP" not in os.environ, reason="UTAP names no program `syntaxcheck` of UPPAAL's parser")
@pytest.mark.parametrize("name", TIMED)
def test_uppaals_parser_finds_no_fault(tmp_path, name):
    mission = load_mission(name)
    for verdict in (None, *timed_verdicts(check(mission).verdicts)):
        xml = tmp_path / "model.xml"
        text = uppaal_text(written(mission.initial, verdict and verdict.property))
        xml.write_text(text, encoding="utf-8")
        said = subprocess.run([os.environ["UTAP"], str(xml)], capture_output=True, text=True, check=False)
        assert (said.returncode, said.stderr) == (0, "")
