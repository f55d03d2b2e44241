"""Missions of a few hundred configurations, made of the features of the language that a row chooses."""

import random

NO, YES = "no", "yes"

LANGUAGE = {
    "scheduler": ("program_order", "unordered", "fcfs"),
    "control": ("atomic", "timed"),
    "timing": (NO, YES),
    "drift": (NO, "among", "within"),
    "cargo": (NO, YES),
    "misses": (NO, "kind", "few"),
    "channels": (NO, "drop", "return", "leave"),
    "messages": (NO, YES),
    "migration": (NO, YES),
    "spawn": (NO, YES),
    "families": (NO, YES),
    "races": (NO, YES),
    "regions": (NO, "plain", "strays"),
    "ltl": (NO, "plain", "fair"),
    "ctl": (NO, YES),
    "progress": (NO, YES),
}
"""What a mission may have."""

OPTIONS = {
    "engine": ("reference", "fast"),
    "threads": ("1", "2"),
    "reduction": (NO, "por", "symmetry", "both"),
    "resumed": (NO, YES),
    "spill": (NO, YES),
    "rows": ("plain", "compressed"),
    "clock": ("local", "global"),
}
"""How it may be checked."""

SIGNATURE = """
signature {
  kind Sea contains Slick, Boat, UAV, Station, Drum
  kind Slick contains UAV, Drum
  kind Boat carries Drum
  kind UAV driven
  kind Drum
  kind Station
}
"""


def text_of(row, seed):
    """Return the mission that a row chooses; the seed varies places and programs."""
    draw = random.Random(f"{sorted(row.items())} {seed}")
    parts = (SIGNATURE, _world(row, draw), _programs(row, draw), _environment(row), _timing(row), _asked(row))
    return "".join((*parts, f"scheduler {row['scheduler']}\ncontrol {row['control']}\n"))


def _world(row, draw):
    spots = [draw.choice(["point (0.0002, 0.0002)", "point (0.0002, 0.0008)"]) for _ in "ab"]
    boat = ("boat0: Boat = point (0.0007, 0.0005) linked wifi", "drum0: Drum carried by boat0")
    return f"""world {{
  channel wifi
  sea0: Sea = box (0.0, 0.0) (0.001, 0.001)
  sea1: Sea = box (0.0, 0.0015) (0.001, 0.0025)
  slick0: Slick = box (0.0004, 0.0004) (0.0006, 0.0006)
  gcs0: Station = point (0.0009, 0.0001) linked wifi
  uav0: UAV = {spots[0]} linked wifi
  uav1: UAV = {spots[1]} linked wifi
  {boat[0] if row["cargo"] == YES or row["drift"] == "within" else ""}
  {boat[1] if row["cargo"] == YES else ""}
}}
"""


def _programs(row, draw):
    go = draw.choice(["sea1", "slick0"])
    go += " VIA sea0" if row["regions"] != NO and draw.random() < 0.5 else ""
    looking = f"observe(CHILDREN(sea0)) react {{ case o => control(MOVE_HOST_TO {go}) }}"
    cases = f"case o if not (uav0 in o) => control(MOVE_HOST_TO {go}) case o => skip"
    tested = f"observe(CHILDREN(sea1)) react {{ {cases} }}"
    extras = sum(
        row[each] != NO for each in ("drift", "cargo", "channels", "messages", "migration", "spawn", "timing")
    )
    first = (
        draw.choice([f"control(MOVE_HOST_TO {go})", looking]) if extras < 3 else f"control(MOVE_HOST_TO {go})"
    )
    ends = 'send "done" to base' if row["messages"] == YES else ""
    programs = [
        f"BigActor a hosted_at uav0 with_behavior {{ {first} {ends} }}",
    ]
    if extras < 4:  # else there is enough to interleave
        programs.append(f"BigActor b hosted_at uav1 with_behavior {{ {draw.choice([tested, looking])} }}")
    if row["families"] == YES:
        programs = [f"BigActor w[i] for u in UAV hosted_at u with_behavior {{ {first} {ends} }}"]
    base = ['react { case "done" => skip }'] if row["messages"] == YES else []
    if row["migration"] == YES:
        base = ["migrate(uav0)", *base]
    if row["spawn"] == YES:
        base = ["spawn look0 hosted_at HOST with_behavior look()", *base]
    crew = ["control(PUT drum0 IN sea0)"] if row["cargo"] == YES else []
    if crew and base and row["timing"] == YES:  # one agent does both: ticks count each moment of each agent
        programs.append(f"BigActor base hosted_at boat0 with_behavior {{ {' '.join(crew + base)} }}")
    else:
        hosts = {"base": ("gcs0", base), "crew": ("boat0", crew)}
        programs += [
            f"BigActor {name} hosted_at {host} with_behavior {{ {' '.join(does)} }}"
            for name, (host, does) in hosts.items()
            if does
        ]
    looks = "def look() = { observe(LINKED_TO(HOST)) }" if row["spawn"] == YES else ""
    return "\n".join([looks, *programs, ""])


def _environment(row):
    slick = "slick0 drifts among point (0.0005, 0.0005), point (0.0005, 0.002)"
    clauses = {
        ("drift", "among"): slick,
        ("drift", "within"): "boat0 drifts within sea0",
        ("channels", "drop"): "wifi drops",
        ("channels", "return"): "wifi drops and returns",
        ("channels", "leave"): "uav1 leaves wifi and returns",
        ("control", "timed"): "uav0 arrives",
    }
    clauses |= {
        ("misses", "kind"): "observe may miss UAV",
        ("misses", "few"): "observe may miss slick0, uav1",
    }
    clauses["regions", "strays"] = "UAV strays at most 5 m"
    chosen = [clause for choice, clause in clauses.items() if choice in row.items()]
    return "environment {\n  " + "\n  ".join(chosen) + "\n}\n" if chosen else ""


def _timing(row):
    if row["timing"] == NO:
        return ""
    drifts = {
        "among": "slick0 drifts at most every 10 s",
        "within": "boat0 drifts at most every 10 s",
        NO: "",
    }
    drops = {"drop": "wifi drops at most every 10 s", "return": "wifi drops and returns within 5 s"}
    drops["leave"] = "uav1 leaves wifi at most every 10 s"
    text = f"""timing {{
  tick 5 s
  UAV flies at 20 m/s to 25 m/s
  agents react within 5 s
  sense within 5 s
  messages over wifi take 5 s to 10 s
  PUT within 5 s
  {drifts[row["drift"]]}
  {drops.get(row["channels"], "")}
}}
"""
    if row["families"] == row["spawn"] == row["cargo"] == YES:  # many agents: ticks count each moment of each
        text = (
            text.replace("tick 5 s", "tick 10 s")
            .replace("5 s to 10 s", "10 s")
            .replace("within 5 s", "within 10 s")
        )
    return text


def _asked(row):
    asked = [
        "local_consistency",
        "deadlock_freedom",
        'reachable "away": actually uav0 in sea1',
        'reachable "both": actually uav0 in sea1 and actually uav1 in sea1',
        'invariant "one at a time": not (actually uav0 in slick0 and actually uav1 in slick0)',
    ]
    if row["regions"] != NO:
        asked += [
            'invariant "apart": forall x, y: UAV . x != y -> x at least 5 m from y',
            'invariant "no way over it": not possibly uav0 in slick0',
            'reachable "over it": possibly uav1 in slick0 and not actually uav1 in slick0',
            'reachable "surely there": surely uav0 in sea1',
            'invariant "in range": actually uav0 in sea0 -> uav0 within 150 m of gcs0',
        ]
    asked += ["race_freedom"] if row["races"] == YES else []
    asked += ['time "gone": actually uav1 in sea1'] if row["timing"] == YES else []
    fair = {"plain": "", "fair": " under weak fairness of agents, requests"}
    if row["ltl"] != NO:
        if row["regions"] != NO:
            asked.append('ltl "parts": <> uav0 at least 60 m from uav1 or [] not possibly uav0 in slick0')
        asked.append(f'ltl "leaves"{fair[row["ltl"]]}: <> not actually uav0 in sea0')
        asked.append(
            f'ltl "stays away"{fair[row["ltl"]]}: [] (actually uav0 in sea1 -> [] actually uav0 in sea1)'
        )
    asked += (
        ['ctl "may leave": AG EF actually uav0 in sea1', 'ctl "next": EX EX actually uav0 in sea0']
        if row["ctl"] == YES
        else []
    )
    asked += ["progress"] if row["progress"] == YES else []
    return "check {\n  " + "\n  ".join(asked) + "\n}\n"
