"""The oil spill with several UAVs and several spills, as a mission and as the same model in Promela.

One of each is `oil_spill.mission`, as it ships.
"""

from string import Template

MOST_UAVS, MOST_SPILLS = 9, 4

_SPOTS = (
    ((37.0, -8.7), (36.985, -8.725), (36.965, -8.66)),
    ((37.025, -8.775), (37.025, -8.745), (37.0, -8.76)),
    ((37.025, -8.61), (37.025, -8.64), (37.0, -8.62)),
    ((36.955, -8.775), (36.955, -8.745), (36.97, -8.76)),
)
"""For each spill where it is first, and where it may drift to: in the search area, apart from the others."""


def mission_text(uavs: int, spills: int = 1) -> str:
    """Write the oil spill as a mission: each UAV has a start and a station, and thus a control authority, of its own.

    Raises:
        ValueError: There are none, or more than there is room for.
    """
    _check(uavs, spills)
    places = [f"  oilSpill{i}: OilSpill = {_circle(_SPOTS[i][0])}" for i in range(spills)]
    places += [
        f"  gcs{i}: Station = point ({37.152:.3f}, {-8.586 + i * 0.0005:.4f}) linked control:gcs{i}"
        for i in range(uavs)
    ]
    places += [
        f"  uav{i}: UAV = point ({37.147:.3f}, {-8.582 - i * 0.0005:.4f}) linked control:gcs{i}"
        for i in range(uavs)
    ]
    return _MISSION.format(
        places="\n".join(places),
        agents="\n".join(_agent(i, spills) for i in range(uavs)),
        drifts="\n".join(
            f"  oilSpill{i} drifts among {', '.join(map(_circle, _SPOTS[i][1:]))}" for i in range(spills)
        ),
        found=" and ".join(
            f"(uav{i} in oilSpill{j} -> actually uav{i} in searchArea0)"
            for i in range(uavs)
            for j in range(spills)
        ),
    )


def _check(uavs: int, spills: int) -> None:
    if not (1 <= uavs <= MOST_UAVS and 1 <= spills <= MOST_SPILLS):
        raise ValueError(
            f"1 to {MOST_UAVS} UAVs and 1 to {MOST_SPILLS} spills have room, not {uavs} and {spills}"
        )


def _circle(centre: tuple[float, float]) -> str:
    return f"circle {centre} radius 700 m"


def _agent(number: int, spills: int) -> str:
    cases = "\n".join(
        f"    case obs: Observation if oilSpill{j} in obs => control(MOVE_HOST_TO oilSpill{j})"
        for j in range(spills)
    )
    return f"""\
BigActor a{number} hosted_at uav{number} with_behavior {{
  control(MOVE_HOST_TO searchArea0)
  observe(CHILDREN(PARENT(HOST)))
  react {{
{cases}
  }}
}}
"""


_MISSION = """\
mission oil_spill

signature {{
  kind Location contains Location, OilSpill, UAV, Station
  kind OilSpill contains UAV
  kind UAV driven
  kind Station
}}

world {{
  searchArea0: Location = box (37.04, -8.59) (36.94, -8.79)
  airfield0: Location = circle (37.149, -8.584) radius 900 m
{places}
}}

{agents}
environment {{
{drifts}
}}

check {{
  local_consistency
  race_freedom
  deadlock_freedom
  invariant "over the spill or at least near": {found}
  reachable "over the spill": actually uav0 in oilSpill0
}}
"""


def promela_text(uavs: int, spills: int = 1) -> str:
    """Write the same oil spill in Promela: a process for each UAV, whose location is its code, and one for the spills.

    Raises:
        ValueError: There are none, or more than there is room for.
    """
    _check(uavs, spills)
    return _PROMELA.substitute(
        uavs=uavs,
        spills=spills,
        area=len(_SPOTS[0]),
        bits="byte" if uavs <= _BITS else "short",
        shown=" | ".join(f"(SHOWN({j}) << {j})" for j in range(uavs)),
        overlay="; ".join(f"OVERLAY({j})" for j in range(uavs)),
        drifts="\n".join(
            f"  :: d_step {{ spill_at[{j}] != {spot} -> spill_at[{j}] = {spot} }} /* env */"
            for j in range(spills)
            for spot in range(1, len(_SPOTS[j]))
        ),
    )


_BITS = 8  # of a byte

_PROMELA = Template("""\
/* The oil spill with $uavs UAVs and $spills spills: each rule is one step, each cell of a configuration that varies
   stands in the state vector. A process's location is its agent's code; OBS is in line where it is reacting and has
   seen nothing yet. Each sees every spill, and goes to the first. A UAV stays where it is when the spill drifts on. */
#define AREA $area /* below it are the spots of the first spill */
#define AIRFIELD 100
#define SPILL 101
#define REGION 102
#define NONE 255

byte uav_at[$uavs] = AIRFIELD; /* P: where each UAV is */
byte uav_in[$uavs] = AIRFIELD; /* L: its parent */
byte spill_at[$spills] = 0; /* P: at which of its spots each spill is */

#define SHOWN(uav) (uav_at[uav] == AREA || (uav_at[uav] < AREA && uav_at[uav] != spill_at[0]))
#define OVERLAY(uav) uav_in[uav] = (SHOWN(uav) -> AREA : (uav_in[uav] == AREA -> REGION : uav_in[uav]))
#define ENTER d_step { ctr == AREA -> uav_at[_pid] = AREA; uav_in[_pid] = AREA; ctr = NONE }
#define SENSE d_step { ctr == NONE && seen == 0 -> \
    seen = $shown; \
    $overlay }

active [$uavs] proctype uav() {
  byte ctr = NONE; /* the line: what CTR wants, first in line where there is one */
  $bits seen; /* the line: which UAVs READY shows, a bit each; its own is always set */
  ctr = AREA; /* req_ctr */
observing:
  if
  :: true; goto reacting /* req_obs */
  :: ENTER; goto observing /* actuate */
  fi;
reacting:
  if
  :: ENTER; goto reacting /* actuate */
  :: SENSE; goto reacting /* sense */
  :: d_step { seen != 0 -> seen = 0 } /* rcv_obs */
  fi;
  true; /* fun */
  ctr = SPILL; /* req_ctr */
  d_step { uav_at[_pid] = spill_at[0]; uav_in[_pid] = SPILL; ctr = NONE }; /* actuate */
  false
}

active proctype env() {
  do
$drifts
  od
}
""")
