"""The rendezvous with any number of robots, as a mission and in Promela, in full and reduced.

    python benchmarks/rendezvous.py [--most N] [ROBOTS ...]

Five robots are `rendezvous.mission`, as it ships. The full search is left out where it is known to visit more than N
configurations, and given up there otherwise (default 2,000,000; with 0 there is none). Its counts are asserted where
they are known.
"""

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from string import Template

from checker import Exploration, Limits, Reduction, explore
from checker.reduction import Reduced
from specs import parse_bytes
from specs.elaboration import ElaboratedMission, elaborate

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


def promela_text(robots: int, *, channels: bool = False) -> str:
    """Write the same rendezvous in Promela: a process for each robot, whose location is its code, and the network.

    Args:
        robots: How many.
        channels: Whether messages go through channels that one process writes and one reads: SPIN's partial-order
            reduction looks for these. The state vector is twice as long then.

    Raises:
        ValueError: There are too few to meet.
    """
    _check(robots)
    everyone = range(robots)
    couriers = [(k,) for k in everyone] if channels else [tuple(everyone)]
    processes = [_robot(k, robots, channels=channels) for k in everyone]
    processes += [_courier(number, to, robots, channels=channels) for number, to in enumerate(couriers)]
    names = " ".join(f"chan {name} = [1] of {{ mtype }};" for k in everyone for name in _channels(k, robots))
    return _PROMELA.substitute(
        robots=robots,
        transport=_CHANNELS.substitute(channels=names) if channels else _POST.substitute(robots=robots),
        processes="\n".join(processes),
    )


def _kinds(robot: int, robots: int) -> list[str]:
    """Return which messages a robot gets: the last one is the first that tells, the first one leads."""
    return [*(["FIRST"] if robot < robots - 1 else []), *(["LEADER"] if robot else [])]


def _channels(robot: int, robots: int) -> list[str]:
    return [f"mail{robot}", *(f"{kind}{robot}" for kind in _kinds(robot, robots))]


def _robot(number: int, robots: int, *, channels: bool) -> str:
    tells = [("LEADER", k) for k in range(1, robots)] if number == 0 else [("FIRST", number - 1)]
    asks = [f"ASK({kind}, {to}); /* req_snd */" for kind, to in tells]
    lines = (
        [] if number == 0 else [f"byte at = {number}, in = {number}, line; /* P, L, and what is in line */"]
    )
    if channels:
        lines.append(f"xr mail{number}; xs {', '.join(f'{kind}{to}' for kind, to in tells)};")
    if 0 < number < robots - 1:
        lines.append("true; /* fun: announce(before) */")
    if number < robots - 1:
        lines.append(f"RECEIVE(FIRST, {number}); /* rcv_msg */")
    lines += asks
    if number:
        lines += ["true; /* fun: follow() */", f"RECEIVE(LEADER, {number}); /* rcv_msg */", "MEET"]
    return _process(f"robot{number}", [*lines, "false"])


def _courier(number: int, to: Sequence[int], robots: int, *, channels: bool) -> str:
    delivers = [f":: DELIVER({kind}, {k}) /* snd */" for k in to for kind in _kinds(k, robots)]
    own = [f"xs mail{number}; xr {', '.join(f'{kind}{number}' for kind in _kinds(number, robots))};"]
    return _process(f"network{number}", [*(own if channels else []), "do", *delivers, "od"])


def _process(name: str, lines: Sequence[str]) -> str:
    return "\n".join([f"active proctype {name}() {{", *(f"  {line}" for line in lines), "}", ""])


_POST = Template("""\
#define FIRST 1 /* it is asked to deliver it; one more, and it is in the mailbox */
#define LEADER 3
byte post[$robots]; /* of the messages to each robot there is one at a time */
#define ASK(kind, to) post[to] = kind
#define DELIVER(kind, to) d_step { post[to] == kind -> post[to] = kind + 1 }
#define RECEIVE(kind, to) d_step { post[to] == kind + 1 -> post[to] = 0 }
""")

_CHANNELS = Template("""\
mtype = { FIRST, LEADER };
$channels
#define ASK(kind, to) kind##to!kind
#define DELIVER(kind, to) d_step { kind##to?kind -> mail##to!kind }
#define RECEIVE(kind, to) mail##to?kind
""")

_PROMELA = Template("""\
/* The rendezvous of $robots robots: each rule is one step, each cell of a configuration that varies stands in the state
   vector; what a store holds follows from the location. The leader never moves. */
$transport
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


def rendezvous(robots: int) -> ElaboratedMission:
    """Return the mission of so many robots."""
    source, tree = parse_bytes("rendezvous.mission", mission_text(robots).encode())
    return elaborate(tree, source, Path())


def reduced(mission: ElaboratedMission) -> Exploration:
    """Explore a mission with partial-order reduction, nothing that its properties see left out."""
    formulas = [each.formula for each in mission.properties if each.kind.has_proposition]
    reducer = Reduced(mission.initial, [Reduction.POR], formulas)
    return explore(mission.initial, limits=Limits(configurations=None), reduce=reducer)


def full(mission: ElaboratedMission, robots: int, most: int) -> Exploration | None:
    """Explore all of a mission; None where it has more configurations than are to be visited."""
    if not most or COUNTS.get(robots, (0, 0))[0] > most:
        return None
    found = explore(mission.initial, limits=Limits(configurations=most))
    if not found.complete:
        return None
    if robots in COUNTS and (len(found.configurations), found.transitions) != COUNTS[robots]:
        raise SystemExit(
            f"{robots} robots: {len(found.configurations)}, {found.transitions} is not {COUNTS[robots]}"
        )
    return found


def row(robots: int, most: int) -> str:
    """Measure one number of robots and return its line of the table."""
    mission = rendezvous(robots)
    began = time.monotonic()
    less = reduced(mission)
    seconds = time.monotonic() - began
    everything = full(mission, robots, most)
    part = f"{len(less.configurations):,} | {less.transitions:,} | {seconds:.2f}"
    if everything is None:
        return f"| {robots} | not searched in full | | | {part} | |"
    count = len(everything.configurations)
    whole = f"{count:,} | {everything.transitions:,} | {everything.seconds:.2f}"
    return f"| {robots} | {whole} | {part} | {count / len(less.configurations):,.0f} |"


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure the numbers of robots that were asked for and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("robots", nargs="*", type=int, default=[3, 4, 5], metavar="ROBOTS")
    parser.add_argument("--most", type=int, default=2_000_000, metavar="N")
    given = parser.parse_args(arguments)
    sys.stdout.write(
        "| robots | configurations | transitions | s | reduced | transitions followed | s | ratio |\n"
        "| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n"
    )
    for robots in given.robots:
        sys.stdout.write(row(robots, given.most) + "\n")
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
