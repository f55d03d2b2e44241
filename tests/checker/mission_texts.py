"""Generated mission texts of two agents: controls, tests of what was observed, and messages."""

from hypothesis import strategies as st

PLACES = ("gate0", "north0", "south0")
EVERYONES = (
    *(f"control(MOVE {uav} TO {place})" for uav in ("uav0", "uav1") for place in PLACES[:2]),
    *(f"control(HAND {uav} TO {gcs})" for uav in ("uav0", "uav1") for gcs in ("gcs0", "gcs1")),
    "control(MOVE uav1 TO south0 VIA gate0)",
    "control(CONNECT_HOST_TO uav1)",
    "control(DISCONNECT_HOST_FROM uav0)",
    "control(land(uav0, south0))",
    "control(swap(uav1))",
)
DRIVERS = (
    *(f"control(MOVE_HOST_TO {place})" for place in (*PLACES, "vessel0")),
    "control(MOVE_HOST_TO south0 VIA north0, gate0)",
    "for p in [north0, gate0] { control(MOVE_HOST_TO p) }",
    *EVERYONES,
)
CONTROLS = {
    "uav0": DRIVERS[:3] + DRIVERS,
    "uav1": DRIVERS,
    "vessel0": (*DRIVERS[:3], "control(PUT drifter0 IN south0)", "control(PUT uav1 IN gate0)"),
    "gcs0": EVERYONES,
    "gcs1": EVERYONES,
}
QUERIES = (
    "CHILDREN(gate0)",
    "CHILDREN(PARENT(HOST))",
    "PARENT(uav1)",
    "LINKED_TO(HOST)",
    "PARENT(PARENT(HOST))",
    "ALL",
)
TESTS = (
    "uav0 in o",
    "not (uav1 in o)",
    "gate0 in o",
    "drifter0 in o",
    "size(o) > 1",
    "empty(o of UAV)",
    "parent(uav1, o) == north0",
    "linked(uav0, gcs0, o)",
    "north0 in [parent(uav1, o), gate0]",
)
RULES = """
rule land(u: UAV, b: Location) { u[c] || b.$0 -> b.(u[c] | $0) }
rule swap(u: UAV) { HOST || gate0 || north0.(u | $0) -> HOST || gate0.u || north0.$0 }
"""


MIGRATIONS = (
    "if uav0 in o { migrate(uav0) }",
    "if size(o) > 1 { migrate(uav1) }",
    "for x in o of UAV { migrate(x) }",
    "for x in o of Station { migrate(x) }",
)
WAYS = ("bare", "bare", "tested", "looked", "told", "heard", "reports", "trusts", "migrates", "impatient")
"""How a control comes about."""


@st.composite
def bodies(draw, host, other, ways):
    """Yield the text of a behaviour: controls, tests of what was observed, migrations, messages to the other."""
    lines = []
    for _ in range(draw(st.integers(1, 2))):
        control = draw(st.sampled_from(CONTROLS[host]))
        way = draw(st.sampled_from(ways))
        if way == "bare":
            lines.append(control)
        elif way == "heard":
            lines.append(f'react {{ case "go" => {control} case x: Observation => skip case m => skip }}')
        elif way == "trusts":
            lines.append(
                f'react {{ case ("seen", x) if x => {control} case x: Observation => skip case m => skip }}'
            )
        elif way == "impatient":
            test, other_control = draw(st.sampled_from(TESTS)), draw(st.sampled_from(CONTROLS[host]))
            lines.append(f"observe({draw(st.sampled_from(QUERIES))})")
            lines.append(
                f'react {{ case o: Observation if {test} => {control} case "go" => skip after 5 s => {other_control} }}'
            )
        elif way == "migrates":
            goes = draw(st.sampled_from(MIGRATIONS))
            lines.append(
                f"observe({draw(st.sampled_from(QUERIES))}) react {{ case o: Observation => {goes} }}"
            )
            lines.append(
                f"observe(PARENT(HOST)) react {{ case o: Observation => {draw(st.sampled_from(DRIVERS))} }}"
            )
        elif way == "reports":
            seen = f'("seen", {draw(st.sampled_from(TESTS))})'
            lines.append(f"observe({draw(st.sampled_from(QUERIES))})")
            lines.append(f"react {{ case o: Observation => {control} send({seen}, {other}) case m => skip }}")
        else:
            test = draw(st.sampled_from(TESTS))
            then = {"tested": control, "looked": "skip", "told": f'send("go", {other})'}[way]
            lines.append(f"observe({draw(st.sampled_from(QUERIES))})")
            lines.append(f"react {{ case o if {test} => {then} case o => skip }}")
            lines += [control] if way == "looked" else []
    return " ".join(lines)


@st.composite
def missions(draw, ways=WAYS):
    text = RULES
    for agent, other in (("a", "b"), ("b", "a")):
        host = draw(st.sampled_from(sorted(CONTROLS)))
        text += f"BigActor {agent} hosted_at {host} with_behavior {{ {draw(bodies(host, other, ways))} }}\n"
    missed = draw(st.sampled_from(["", "", "uav1", "drifter0, uav0"]))
    text += f"environment {{ observe may miss {missed} }}\n" if missed else ""
    return text + f"control {draw(st.sampled_from(['atomic', 'timed']))}\n"
