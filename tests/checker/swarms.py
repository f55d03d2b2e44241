"""Missions of robots that start in one place and run one behaviour, written and drawn at random."""

from checked_missions import load
from hypothesis import strategies as st

from semantics import Scheduler

WORLD = """
signature {{
  kind Room contains Robot, Station, Crate
  kind Robot driven carries Crate
  kind Station
  kind Crate
}}
world {{
  dock0: Room = box (37.01, -8.69) (36.99, -8.71)
  room0: Room = box (37.05, -8.69) (37.03, -8.71)
  gcs0: Station = point (37.04, -8.70) linked mesh
{robots}
}}
"""


def swarm(body, robots=2, rest="", places=None):
    """Return a mission of robots that start in one place and run one behaviour."""
    where = places or ["point (37.00, -8.70) linked mesh"] * robots
    there = "\n".join(f"  robot{number}: Robot = {place}" for number, place in enumerate(where))
    agents = "\n".join(f"BigActor r{i} hosted_at robot{i} with_behavior {{ visit() }}" for i in range(robots))
    return f"{WORLD.format(robots=there)}def visit() = {{ {body} }}\n{agents}\n{rest}"


def mission(*arguments, **more):
    return load(swarm(*arguments, **more), "")


LOOKS = "observe(PARENT(HOST)) react { case obs => control(MOVE_HOST_TO room0) }"
TELLS = 'send ("here", HOST) to base control(MOVE_HOST_TO room0)'
BASE = (
    "BigActor base hosted_at gcs0 with_behavior "
    '{ react { case ("here", who) => react { case ("here", again) => send ("come", again) to base } } }'
)

LISTENS = """
BigActor r hosted_at gcs0 with_behavior { react { case m: Message => skip } }
environment { says "go" to r0 says "go" to r1 says "go" to r2 }
"""
ORBITS = {
    "look": (LOOKS, "", 3),
    "tell": (TELLS, BASE, 2),
    "answered": (
        'react { case ("come", who) => control(MOVE_HOST_TO room0) case "go" => send ("come", HOST) to r }',
        LISTENS,
        3,
    ),
}

STEPS = (
    "control(MOVE_HOST_TO room0)",
    "control(MOVE_HOST_TO dock0)",
    "control(MOVE_HOST_TO dock0 VIA room0)",
    "control(CONNECT_HOST_TO gcs0)",
    "control(DISCONNECT_HOST_FROM gcs0)",
    "observe(PARENT(HOST)) react { case o => skip }",
    "observe(CHILDREN(dock0)) react { case o => send o to base }",
    'send ("at", HOST, SELF) to base',
    'react { case "go" => skip }',
    "migrate(gcs0)",
    "for p in [room0, dock0, room0] { control(MOVE_HOST_TO p) }",
    "send [HOST, dock0] to base",
    "let r = [HOST, gcs0] for h in r + [HOST] { observe(PARENT(h)) react { case o => skip } }",
)
BASES = (
    "BigActor base hosted_at gcs0 with_behavior { loop { react { case m: Message => skip } } }",
    'BigActor base hosted_at gcs0 with_behavior { react { case ("at", h, a) => send "go" to a } }',
    "BigActor base hosted_at gcs0 with_behavior { observe(HOSTED_AT(ALL)) react { case o => skip } }",
    "BigActor base hosted_at gcs0 with_behavior { observe(LINKED_TO(HOST)) react { case o: Observation => skip } }",
)
AROUND = (
    "",
    'environment { says "go" to r1 says "go" to r0 }',
    "environment { mesh drops and returns }",
    "environment { robot0 vanishes robot1 vanishes }",
    "environment { robot0 leaves mesh and returns robot1 leaves mesh and returns }",
    "environment { observe may miss Robot }",
)


@st.composite
def swarms(draw):
    body = " ".join(draw(st.lists(st.sampled_from(STEPS), min_size=1, max_size=2)))
    varied = f"control {draw(st.sampled_from(['atomic', 'timed']))}\n"
    varied += f"scheduler {draw(st.sampled_from([each.value for each in Scheduler]))}\n"
    return swarm(body, 2, varied + draw(st.sampled_from(BASES)) + "\n" + draw(st.sampled_from(AROUND)))
