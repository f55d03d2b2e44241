"""Missions in which features of the language meet times: a few vehicles, agents, clauses and bounds, by a number."""

import random

SEAS = ("sea0", "sea1", "sea2")
STATIONS = ("gcs0", "gcs1")
WORDS = ("x", "y")
SIGNATURE = """
signature {
  kind Sea contains Slick, Boat, UAV, Station, Drum
  kind Slick contains UAV, Drum
  kind Boat driven carries Drum, UAV
  kind UAV driven
  kind Drum
  kind Station
}
"""
WORLD = """world {{
  channel wifi
  channel mesh
  sea0: Sea = box (0.0, 0.0) (0.001, 0.001)
  sea1: Sea = box (0.0, 0.0015) (0.001, 0.0025)
  sea2: Sea = box (0.0015, 0.0) (0.0025, 0.001)
  slick0: Slick = box (0.0004, 0.0004) (0.0006, 0.0006)
  gcs0: Station = point (0.0009, 0.0001) linked control:gcs0, wifi
  gcs1: Station = point (0.0009, 0.0024) linked control:gcs1, {channel}
  uav0: UAV = point {spot} linked control:gcs0, wifi
  uav1: UAV = point (0.0002, 0.0008) linked control:gcs1, wifi, mesh
  boat0: Boat = point (0.0007, 0.0005) linked control:gcs0, wifi
  uav2: UAV carried by boat0 linked control:gcs1, mesh
  drum0: Drum carried by boat0
  ghost0: UAV absent
}}
"""
VEHICLES = ("uav0", "uav1", "boat0", "uav2")
QUERIES = (
    *("PARENT(HOST)", "CHILDREN(PARENT(HOST))", "LINKED_TO(HOST)", "ALL", "CHILDREN(sea1)", "PARENT(uav0)"),
    "HOSTED_AT(HOST)",
)


def text_of(seed):
    """Return the mission of a number."""
    return _Text(random.Random(seed)).text()


class _Text:
    def __init__(self, draw):
        self.draw = draw
        self.agents = "abc"[: draw.choice([2, 2, 3])]
        self.host = dict(zip(self.agents, draw.sample([*VEHICLES, *STATIONS], 3), strict=False))
        if draw.random() < 0.2:
            self.host["b"] = self.host["a"]

    def text(self):
        draw = self.draw
        spot = draw.choice(["(0.0002, 0.0002)", "(0.0008, 0.0020)", "(0.0021, 0.0003)"])
        programs = [
            f"BigActor {a} hosted_at {self.host[a]} with_behavior {{ {self.block(a)} }}\n"
            for a in self.agents
        ]
        clauses = draw.sample(self.clauses(), draw.choice([0, 1, 1, 2]))
        environment = " ".join(clause for clause, _ in clauses)
        parts = (
            SIGNATURE,
            WORLD.format(spot=spot, channel=draw.choice(["wifi", "mesh"])),
            *programs,
            f"environment {{ {environment} }}\n" if clauses else "",
            f"scheduler {draw.choice(['program_order', 'program_order', 'unordered'])}\ncontrol timed\n",
            f"timing {{\n  {self.bounds()}\n  {' '.join(times for _, times in clauses if draw.random() < 0.8)}\n}}\n",
            f"check {{\n  {self.asked()}\n}}\n",
        )
        return "".join(parts)

    # --- programs

    def block(self, a):
        return " ".join(self.statement(a) for _ in range(self.draw.choice([1, 1, 2])))

    def statement(self, a):
        draw, query = self.draw, self.draw.choice(QUERIES)
        seen, word = draw.choice([*VEHICLES, "ghost0", "drum0"]), draw.choice(WORDS)
        timeout = f"after {draw.randint(1, 5)} s => {self.step(a)}" if draw.random() < 0.6 else ""
        return draw.choice(
            [
                self.step(a),
                self.step(a),
                f"observe({query}) react {{ case o if {seen} in o => {self.step(a)} case o => {self.step(a)} }}",
                f"observe({query}) react {{ case o => {self.step(a)} {timeout} }}",
                f'react {{ case "{word}" => {self.step(a)} {timeout} }}',
                f'loop {{ react {{ case "{word}" => {self.step(a)} }} }}',
                f"choose {{ case => {self.step(a)} case => skip }}",
            ]
        )

    def step(self, a):
        draw, host = self.draw, self.host[a]
        peer = draw.choice([each for each in (*VEHICLES, *STATIONS) if each != host])
        steps = [self.move(host)] * 4 + [f'send "{draw.choice(WORDS)}" to {draw.choice(self.agents)}'] * 3
        steps += [f"observe({draw.choice(QUERIES)})", f"migrate({peer})", "skip"]
        steps.append(f"control({draw.choice(['CONNECT_HOST_TO', 'DISCONNECT_HOST_FROM'])} {peer})")
        if host in STATIONS:
            steps.append(f"control(HAND {draw.choice(VEHICLES)} TO {STATIONS[host == 'gcs0']})")
        if host == "boat0":
            steps.append(f"control(PUT {draw.choice(['drum0', 'uav2'])} IN {draw.choice(SEAS)})")
        return draw.choice(steps)

    def move(self, host):
        draw = self.draw
        mover = draw.choice(VEHICLES) if host in STATIONS else host
        place = draw.choice(SEAS if mover == "boat0" else (*SEAS, *SEAS, "slick0", "boat0"))
        gate = draw.choice([each for each in SEAS if each != place])
        via = f" VIA {gate}" if draw.random() < 0.15 else ""
        return f"control({'MOVE_HOST_TO' if mover == host else f'MOVE {mover} TO'} {place}{via})"

    # --- environment and times

    def clauses(self):
        """Return clauses of the environment, each with a line of times."""
        draw = self.draw
        begin = draw.randint(0, 4)
        end, least, back = begin + draw.randint(0, 3), draw.randint(1, 4), draw.randint(0, 3)
        word, agent, vehicle = draw.choice(WORDS), draw.choice(self.agents), draw.choice(VEHICLES)
        said = f'says "{word}" to {agent}'
        return [
            (
                "slick0 drifts among point (0.0005, 0.0005), point (0.0005, 0.002)",
                f"slick0 drifts at most every {least} s",
            ),
            (
                "uav0 drifts among point (0.0002, 0.0003), point (0.0022, 0.0003)",
                f"uav0 drifts at most every {least} s",
            ),
            ("wifi drops and returns", f"wifi drops at most every {least} s, returns within {back} s"),
            ("uav1 leaves wifi and returns", f"uav1 leaves wifi and returns within {back} s"),
            (f"{vehicle} vanishes", f"{vehicle} vanishes after {begin} s, within {end} s"),
            ("ghost0 appears at sea1 linked wifi", f"ghost0 appears after {begin} s, within {end} s"),
            (f"{said} at most 2 times", f"someone {said} after {begin} s, until {end} s"),
            ("observe may miss UAV", ""),
            ("uav1 arrives", ""),
        ]

    def lapse(self, verb="takes"):
        least = self.draw.randint(0, 2)
        most = least + self.draw.randint(0, 2)
        return self.draw.choice(
            [
                f"{verb} {least} s",
                f"{verb} {least} s to {most} s",
                f"{verb} at least {least} s",
                f"within {most} s",
            ]
        )

    def bounds(self):
        draw = self.draw
        vehicle = draw.choice(VEHICLES)
        places = draw.choice([each for each in (*SEAS, "boat0") if each != vehicle])
        bounds = [
            f"UAV flies at {draw.choice(['20 m/s to 40 m/s', '30 m/s', '50 m/s to 100 m/s'])}",
            f"boat0 flies at {draw.choice(['20 m/s', '10 m/s to 50 m/s'])}",
            f"{vehicle} lasts {draw.randint(3, 12)} s, restored in {places} after {draw.randint(0, 3)} s",
            f"agents {draw.choice(['react within 0 s', 'react within 1 s', 'take 1 s', 'take 1 s to 2 s'])}",
            f"sense {self.lapse()}",
            *(f"messages {over} {self.lapse('take')}" for over in ("over wifi", "over mesh", "on one host")),
            *(f"{step} {self.lapse()}" for step in ("HAND", "PUT", "migrate", "CONNECT_HOST_TO")),
        ]
        return "\n  ".join(each for each in bounds if draw.random() < 0.8)

    # --- properties

    def claim(self):
        draw = self.draw
        a, vehicle, place = draw.choice(self.agents), draw.choice(VEHICLES), draw.choice(SEAS)
        claims = (
            *(
                f"ended {a}",
                f"pending {a}",
                f"waiting {a}",
                f"pending FLY {a}",
                f"ended {a} and not pending {a}",
            ),
            *(f"actually {vehicle} in {place}", f"{vehicle} in {place}", f"possibly {vehicle} in {place}"),
        )
        return draw.choice(["", "not "]) + f"({draw.choice(claims)})"

    def asked(self):
        standard = "local_consistency race_freedom deadlock_freedom arrival endurance"
        return f"""{standard}
  reachable "somewhere": {self.claim()} and {self.claim()}
  invariant "always": {self.claim()} or {self.claim()}
  time "first": {self.claim()}
  within {self.draw.randint(0, 12)} s "soon": {self.claim()}
  within {self.draw.randint(0, 8)} s "answered": {self.claim()} leads to {self.claim()}"""
