"""The rendezvous with any number of robots, as a mission and as the same model in Promela.

Five robots are `rendezvous.mission`, as it ships.
"""

from collections.abc import Sequence
from string import Template

FEWEST = 2

COUNTS = {2: (18, 21), 3: (167, 341), 4: (1_685, 5_128), 5: (18_051, 73_275), 6: (197_233, 999_394)}
"""Configurations and transitions of the full search, where it was run to its end; SPIN counts the same."""


def mission_text(robots: int) -> str:
    """Write the rendezvous of so many robots as a mission.

    Raises:
        ValueError: There are too few to meet.
    """
    _check(robots)
    rooms = [f"  room{i}: Room = {_box(i)}" for i in range(robots)]
    there = [
        f"  robot{i}: Robot = point ({38.7361 + i * 0.0004:.4f}, -9.13795) linked wifi" for i in range(robots)
    ]
    tells = "\n".join(f'      send ("leader", HOST) to r{i}' for i in range(1, robots))
    middle = "\n".join(_agent(i, f"announce(r{i - 1})") for i in range(1, robots - 1))
    last = _agent(robots - 1, f'send ("first", SELF) to r{robots - 2}')
    return f"""\
mission rendezvous

signature {{
  kind Room contains Robot
  kind Robot driven
}}

world {{
{chr(10).join([*rooms, *there])}
}}

def announce(before) = {{
  react {{
    case ("first", other) => send ("first", SELF) to before
  }}
}}

def rendezvous(leader) = {{
  observe(PARENT(leader))
  react {{
    case obs => control(MOVE_HOST_TO parent(leader, obs))
  }}
}}

def follow() = {{
  react {{
    case ("leader", leader) => rendezvous(leader)
  }}
}}

BigActor r0 hosted_at robot0 with_behavior {{
  react {{
    case ("first", other) =>
{tells}
  }}
}}

{middle}
{last}

check {{
  local_consistency
  deadlock_freedom
  reachable "all meet": forall r: Robot . actually r in room0
}}
"""


def _check(robots: int) -> None:
    if robots < FEWEST:
        raise ValueError(f"a rendezvous has at least {FEWEST} robots, not {robots}")


def _box(number: int) -> str:
    south = 38.736 + number * 0.0004
    return f"box ({south + 0.0002:.4f}, -9.1378) ({south:.4f}, -9.1381)"


def _agent(number: int, first: str) -> str:
    return f"BigActor r{number} hosted_at robot{number} with_behavior {{\n  {first}\n  follow()\n}}\n"


def promela_text(robots: int) -> str:
    """Write the same rendezvous in Promela: a process for each robot, whose location is its code, and the network.

    Raises:
        ValueError: There are too few to meet.
    """
    _check(robots)
    everyone = range(robots)
    processes = [*(_robot(k, robots) for k in everyone), _courier(robots)]
    return _PROMELA.substitute(robots=robots, processes="\n".join(processes))


def _kinds(robot: int, robots: int) -> list[str]:
    """Return which messages a robot gets: the last one is the first that tells, the first one leads."""
    return [*(["FIRST"] if robot < robots - 1 else []), *(["LEADER"] if robot else [])]


def _robot(number: int, robots: int) -> str:
    tells = [("LEADER", k) for k in range(1, robots)] if number == 0 else [("FIRST", number - 1)]
    asks = [f"ASK({kind}, {to}); /* req_snd */" for kind, to in tells]
    lines = (
        [] if number == 0 else [f"byte at = {number}, in = {number}, line; /* P, L, and what is in line */"]
    )
    if 0 < number < robots - 1:
        lines.append("true; /* fun: announce(before) */")
    if number < robots - 1:
        lines.append(f"RECEIVE(FIRST, {number}); /* rcv_msg */")
    lines += asks
    if number:
        lines += ["true; /* fun: follow() */", f"RECEIVE(LEADER, {number}); /* rcv_msg */", "MEET"]
    return _process(f"robot{number}", [*lines, "false"])


def _courier(robots: int) -> str:
    delivers = [f":: DELIVER({kind}, {k}) /* snd */" for k in range(robots) for kind in _kinds(k, robots)]
    return _process("network", ["do", *delivers, "od"])


def _process(name: str, lines: Sequence[str]) -> str:
    return "\n".join([f"active proctype {name}() {{", *(f"  {line}" for line in lines), "}", ""])


_PROMELA = Template("""\
/* The rendezvous of $robots robots: each rule is one step, each cell of a configuration that varies stands in the state
   vector; what a store holds follows from the location. The leader never moves. */
#define FIRST 1 /* it is asked to deliver it; one more, and it is in the mailbox */
#define LEADER 3
byte post[$robots]; /* of the messages to each robot there is one at a time */
#define ASK(kind, to) post[to] = kind
#define DELIVER(kind, to) d_step { post[to] == kind -> post[to] = kind + 1 }
#define RECEIVE(kind, to) d_step { post[to] == kind + 1 -> post[to] = 0 }
#define NOTHING 0
#define OBS 1
#define READY 2
#define CTR 3
#define MEET \\
    true; /* fun: rendezvous(leader) */ \\
    line = OBS; /* req_obs */ \\
    line = READY; /* sense */ \\
    line = NOTHING; /* rcv_obs */ \\
    line = CTR; /* req_ctr */ \\
    d_step { at = 0; in = 0; line = NOTHING } /* actuate */;

$processes
""")
