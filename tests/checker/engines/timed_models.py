"""Missions with times as other model checkers read them, with questions, and TChecker's answers where it is."""

import os
import re
import subprocess

from checked_missions import load
from hypothesis import assume
from hypothesis import strategies as st
from timed_missions import timed_missions, timings, with_timing

from checker import Limits, check
from checker.engines.choose import explore
from checker.engines.contract import Engine
from checker.engines.zones.automaton_export import model_of
from checker.verdicts import Outcome
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property
from semantics.properties.propositions import Ended

ENDURANCE = Property(PropertyKind.ENDURANCE, "endurance")


def timed_verdicts(verdicts):
    return [each for each in verdicts if each.property.kind in (PropertyKind.WITHIN, PropertyKind.ENDURANCE)]


def written(c, asked):
    found = explore(c, engine=Engine.FAST)
    return model_of(found.times, asked, "a mission")


def agree(c, asked, judge):
    for verdict in timed_verdicts(check(c, asked).verdicts):
        assert judge(written(c, verdict.property)) is verdict.outcome


EQUAL = """
BigActor a hosted_at gcs0 with_behavior { send("on", b) send("on", b) send("on", b) }
BigActor b hosted_at gcs0 with_behavior { react { case "on" => } react { case "on" => } react { case "on" => } }
scheduler unordered
"""


@st.composite
def asked_of(draw, c):
    ended = st.sampled_from([Ended(agent) for agent in c.alpha.names()])
    then = draw(st.none() | ended)
    return Property(PropertyKind.WITHIN, "within", draw(ended), bound=draw(st.integers(0, 5)), then=then)


@st.composite
def questions(draw):
    equal = load(EQUAL).initial
    c = draw(timed_missions() | timings(equal.setting).map(lambda timing: with_timing(equal, timing)))
    assume(explore(c, limits=Limits(configurations=300)).complete)
    return c, draw(asked_of(c))


def found_by_tchecker(text, folder, algorithm="covreach"):
    """Ask TChecker whether what is labelled is reachable."""
    said = asked_of_tchecker(text, folder, "-a", algorithm, "-l", "wrong")
    return Outcome.VIOLATED if "REACHABLE true" in said else Outcome.HOLDS


def reached_by_tchecker(text, folder, algorithm):
    """Ask TChecker for the reachable tuples of locations; copies of a location count as one."""
    graph = asked_of_tchecker(text, folder, "-a", algorithm, "-C", "graph")
    tuples = re.findall(r'vloc="<([^>]*)>"', graph)
    return {tuple(re.findall(r"[lu](\d+)(?:_\d+)?(?:,|$)", each)) for each in tuples}


def asked_of_tchecker(text, folder, *options):
    model = folder / "model.tck"
    model.write_text(text, encoding="utf-8")
    program = [os.environ["TCHECKER"], *options, str(model)]
    return subprocess.run(program, capture_output=True, text=True, check=True).stdout
