"""The patrol: UAVs that search for a drifting spill on a grid, as a mission and as the same model in Promela.

Every rule of the calculus is one step of the Promela and every cell that varies is in its state vector, so both have
the same configurations and transitions (monitor cells off). Cells are numbered row by row from the south-west.
"""

from collections.abc import Iterator
from string import Template

SPILL_CELLS = 3
"""The spill drifts among the first three cells."""

STATIONS = 3
"""Among which a UAV is handed over; at first each is on the one of its number, round and round."""

MOST_AGENTS = 4
"""Each starts in a corner of its own."""

COUNTS = {
    (1, 2, False): (171, 549),
    (1, 3, False): (390, 1_287),
    (1, 6, False): (1_659, 5_589),
    (1, 2, True): (777, 2_574),
    (1, 3, True): (1_434, 4_788),
    (2, 2, False): (14_232, 62_157),
    (2, 3, False): (66_264, 300_432),
    (2, 2, True): (342_876, 1_585_857),
    (2, 3, True): (1_051_404, 4_899_462),
    (2, 6, False): (1_076_964, 5_044_005),
    (3, 2, False): (1_634_778, 8_966_151),
    (2, 6, True): (11_536_584, 54_378_969),
    (3, 3, False): (15_330_840, 87_525_372),
}
"""Configurations and transitions by UAVs, side and hand-over, as SPIN counts them."""

_PITCH, _HALF = (
    20,
    5,
)  # ten-thousandths of a degree between the centres of cells, and from a centre to its border


def neighbours(cell: int, side: int, rows: int | None = None) -> tuple[int, ...]:
    """Return the cells east, west, north and south of one, as far as the grid has them; without rows it is square.

    >>> neighbours(0, 2), neighbours(4, 3)
    ((1, 2), (5, 3, 7, 1))
    """
    row, column = divmod(cell, side)
    beside = ((row, column + 1), (row, column - 1), (row + 1, column), (row - 1, column))
    return tuple(r * side + c for r, c in beside if 0 <= r < (rows or side) and 0 <= c < side)


def starts(agents: int, side: int) -> tuple[int, ...]:
    """Return the corner in which each UAV starts.

    Raises:
        ValueError: There are more UAVs than corners, or fewer cells than the spill needs.
    """
    if not 1 <= agents <= MOST_AGENTS or side * side < SPILL_CELLS:
        raise ValueError(
            f"a patrol has 1 to {MOST_AGENTS} UAVs on a side of 2 or more, not {agents} on {side}"
        )
    return (0, side * side - 1, side - 1, side * (side - 1))[:agents]


def mission_text(agents: int, side: int, handover: bool = False, *, together: bool = False) -> str:
    """Write the patrol as a mission: all start where later moves lead to, so that no placement occurs only once.

    Args:
        agents: How many UAVs.
        side: Of the square grid, in cells.
        handover: Whether a UAV that has found the spill hands itself over to one of three stations.
        together: Whether all start in the first corner, any number of them: they are alike then.
    """
    places = [f"  cell{cell}: Cell = {box(cell, side)}" for cell in range(side * side)]
    first = (0,) * agents if together else starts(agents, side)
    uavs = [f"  uav{i}: UAV = point {centre(cell, side)}" for i, cell in enumerate(first)]
    found = "      case obs if spill0 in obs => skip"
    if handover:
        uavs = [f"{uav} linked control:gcs{i % STATIONS}" for i, uav in enumerate(uavs)]
        uavs += [f"  gcs{g}: Station = {_station(g)} linked control:gcs{g}" for g in range(STATIONS)]
        hands = (f"{{ control(hand(HOST, gcs{g})) }}" for g in range(STATIONS))
        found = f"      case obs if spill0 in obs =>\n        choose {' or '.join(hands)}"
    cases = [line for cell in range(side * side) for line in _case(cell, side)]
    actors = [f"BigActor a{i} hosted_at uav{i} with_behavior {{ patrol() }}" for i in range(agents)]
    return _MISSION.substitute(
        kinds="  kind Station\n" if handover else "",
        places="\n".join([*places, *uavs]),
        spill=centre(0, side),
        rule=_RULE if handover else "",
        cases="\n".join([found, *cases]),
        actors="\n".join(actors),
        drifts=", ".join(f"cell{cell}" for cell in range(SPILL_CELLS)),
    )


def _station(number: int) -> str:
    return f"point {_position(-5 * _PITCH, number * _PITCH)}"


def centre(cell: int, side: int) -> str:
    """Write the middle of a cell of a grid with so many cells in a row."""
    row, column = divmod(cell, side)
    return _position(row * _PITCH, column * _PITCH)


def box(cell: int, side: int) -> str:
    """Write a cell's box."""
    row, column = divmod(cell, side)
    north_east = _position(row * _PITCH + _HALF, column * _PITCH + _HALF)
    return f"box {north_east} {_position(row * _PITCH - _HALF, column * _PITCH - _HALF)}"


def _position(north: int, east: int) -> str:
    return f"({north / 10_000:.4f}, {east / 10_000:.4f})"


def _case(cell: int, side: int) -> Iterator[str]:
    moves = (f"{{ control(MOVE_HOST_TO cell{there}) }}" for there in neighbours(cell, side))
    yield f"      case obs if cell{cell} in obs =>"
    yield f"        choose {' or '.join(moves)}"


_RULE = "rule hand(u: UAV, g: Station) { u[c] || g[d] -> u[d] || g[d] }\n\n"

_MISSION = Template("""\
mission patrol

signature {
  kind Cell contains UAV, Spill
  kind UAV driven
  kind Spill
$kinds}

world {
$places
  spill0: Spill = point $spill
}

${rule}def patrol() = {
  loop {
    observe(CHILDREN(PARENT(HOST)))
    react {
$cases
    }
  }
}

$actors

environment {
  spill0 drifts among $drifts
}
""")


def promela_text(agents: int, side: int, handover: bool = False) -> str:
    """Write the same patrol in Promela: a process for each UAV, whose location is its code, and one for the spill."""
    first, everyone = starts(agents, side), range(agents)
    return _PROMELA.substitute(
        agents=agents,
        side=side,
        region=side * side,
        starts=", ".join(map(str, first)),
        spill=agents,
        links=_LINKS.substitute(agents=agents, links=", ".join(str(i % STATIONS) for i in everyone))
        if handover
        else "",
        observing="\n  :: HAND; goto observing /* actuate */" if handover else "",
        reacting="\n  :: HAND; goto reacting /* actuate */" if handover else "",
        found=_hands() if handover else "  true; goto observing /* fun */",
        shown=" | ".join(f"SHOWN(uav_at[{j}], {j})" for j in everyone),
        overlay=" ".join(f"OVERLAY(uav_at[{j}], uav_in[{j}]);" for j in everyone),
        east=f"HERE % {side} < {side - 1}",
        west=f"HERE % {side} > 0",
        north=f"HERE < {side * (side - 1)}",
        south=f"HERE >= {side}",
        drifts="\n".join(
            f"  :: d_step {{ spill_at != {cell} -> spill_at = {cell} }}" for cell in range(SPILL_CELLS)
        ),
    )


def _hands() -> str:
    hands = (f"  :: d_step {{ true -> to = STATION({g}) }}; goto asking" for g in range(STATIONS))
    return "\n".join(["  true; /* fun */", "  if /* fun */", *hands, "  fi;"])


_LINKS = Template("""
byte link_at[$agents] = {$links};   /* P: on whose channel each UAV is */
byte link_in[$agents] = {$links};   /* L */
#define STATION(number) (REGION + 1 + number)
#define HAND d_step { \\
    ctr[_pid] > REGION && ctr[_pid] != NONE && link_in[_pid] == link_at[_pid] -> \\
    link_at[_pid] = ctr[_pid] - STATION(0); link_in[_pid] = link_at[_pid]; ctr[_pid] = NONE }
""")

_PROMELA = Template("""\
/* The patrol of $agents UAVs on $side x $side cells: each rule is one step, each cell of a configuration that varies
   stands in the state vector. A process's location is its agent's code; OBS is in line where it is reacting and has
   seen nothing yet. */
#define REGION $region
#define NONE 255
#define SPILL (1 << $spill)
#define HERE uav_at[_pid]

byte uav_at[$agents] = {$starts};  /* P: where each UAV is */
byte uav_in[$agents] = {$starts};  /* L: its parent */
byte spill_at = 0; /* P */
byte spill_in = 0; /* L */
byte ctr[$agents] = NONE; /* the line: what CTR wants, first in line where there is one */
byte seen[$agents]; /* the line: what READY shows, a bit each; its own is always set */
$links
#define SHOWN(at, bit) ((at == HERE -> 1 : 0) << bit)
#define OVERLAY(at, in) in = (at == HERE -> at : (in == HERE -> REGION : in))
#define MOVE d_step { \\
    ctr[_pid] < REGION && (uav_in[_pid] == REGION || uav_in[_pid] == HERE) -> \\
    HERE = ctr[_pid]; uav_in[_pid] = ctr[_pid]; ctr[_pid] = NONE }
#define SENSE d_step { \\
    ctr[_pid] == NONE && seen[_pid] == 0 -> \\
    seen[_pid] = $shown | SHOWN(spill_at, $spill); \\
    $overlay \\
    OVERLAY(spill_at, spill_in) }

active [$agents] proctype uav() {
  byte to; /* what it chose */
  true; /* fun: patrol() */
observing:
  if
  :: true; goto reacting /* req_obs */
  :: MOVE; goto observing /* actuate */$observing
  fi;
reacting:
  if
  :: MOVE; goto reacting /* actuate */$reacting
  :: SENSE; goto reacting /* sense */
  :: d_step { (seen[_pid] & SPILL) != 0 -> seen[_pid] = 0 }; goto found /* rcv_obs */
  :: d_step { seen[_pid] != 0 && (seen[_pid] & SPILL) == 0 -> seen[_pid] = 0 }; goto missed /* rcv_obs */
  fi;
found:
$found
missed:
  true; /* fun */
  if /* fun */
  :: d_step { $east -> to = HERE + 1 }; goto asking
  :: d_step { $west -> to = HERE - 1 }; goto asking
  :: d_step { $north -> to = HERE + $side }; goto asking
  :: d_step { $south -> to = HERE - $side }; goto asking
  fi;
asking:
  if
  :: d_step { ctr[_pid] = to; to = 0 }; goto observing /* req_ctr */
  fi
}

active proctype env() {
  do
$drifts
  od
}
""")
