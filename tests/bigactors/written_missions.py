"""Four small missions: one holds, one races, one never ends, one has a mistake."""

HEAD = """\
signature {
  kind Location contains Location, OilSpill, UAV
  kind OilSpill contains UAV
  kind UAV driven
}

world {
  searchArea0: Location = box (37.04, -8.59) (36.94, -8.79)
  base0: Location = box (37.2, -8.59) (37.1, -8.79)
  oilSpill0: OilSpill = circle (37, -8.7) radius 400 m
  uav0: UAV = point (37.15, -8.7)
}
"""

HOLDS = f"""\
mission figure_2

{HEAD}
BigActor a hosted_at uav0 with_behavior {{
  control(MOVE_HOST_TO searchArea0)
  observe(CHILDREN(PARENT(HOST)))
  react {{
    case obs: Observation if oilSpill0 in obs => control(MOVE_HOST_TO oilSpill0)
  }}
}}

check {{
  local_consistency
  race_freedom
  deadlock_freedom
  reachable "found": actually uav0 in oilSpill0
}}
"""

RACE = f"""\
{HEAD}
BigActor a hosted_at uav0 with_behavior {{
  control(MOVE_HOST_TO searchArea0)
}}

BigActor b hosted_at uav0 with_behavior {{
  control(MOVE_HOST_TO oilSpill0)
}}

check {{
  race_freedom
  invariant "stays at home": actually uav0 in base0
}}
"""

ENDLESS = f"""\
{HEAD}
BigActor a hosted_at uav0 with_behavior {{
  let n = 0
  loop {{
    n = n + 1
    observe(ALL)
    react {{
      case obs => skip
    }}
  }}
}}

check {{
  deadlock_freedom
}}
"""

MISTAKEN = HOLDS.replace("MOVE_HOST_TO searchArea0", "MOVE_HOST_TO serchArea0")

TEXTS = {"holds": HOLDS, "race": RACE, "endless": ENDLESS, "mistaken": MISTAKEN}
