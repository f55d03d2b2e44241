"""Small missions, and whose controls rest in them on a stale observation: written out by hand, one by one.

At the end of a mission `a@uav0: body` is a bigActor with its host and its text; words in capitals stand for what
agents do again and again.
"""

import re

import pytest
from checked_missions import WORLD

WORDS = {
    "ENTER": "control(MOVE_HOST_TO gate0)",
    "NORTH": "control(MOVE_HOST_TO north0)",
    "LOOKS": "observe(CHILDREN(gate0))",
    "ARRIVES": "observe(PARENT(HOST)) react { case there: Observation => skip }",
    "NEVER": 'react { case "never" => skip }',
}
NEAR = WORLD.replace("control:gcs0, internet", "control:gcs0, internet, mesh")
"""gcs0 is on the mesh too."""

RADIO = WORLD.replace("linked control:gcs0, mesh", "linked mesh, radio").replace(
    "linked control:gcs0, internet", "linked control:gcs0, internet, radio"
)
"""uav0 is under nobody's control authority, and hears gcs0 on the radio alone."""

LONELY = WORLD.replace("linked control:gcs1, mesh", "linked control:gcs1")
"""uav1 hears nobody but gcs1."""


def written(mission):
    """Return the text of a mission."""
    for word, meant in WORDS.items():
        mission = re.sub(rf"\b{word}\b", meant, mission)
    first, *agents = re.split(r"^ *(\w+)@(\w+): ", mission, flags=re.MULTILINE)
    told = zip(agents[::3], agents[1::3], agents[2::3], strict=True)
    return first + "".join(f"BigActor {a} hosted_at {h} with_behavior {{ {does}\n}}\n" for a, h, does in told)


def case(sentence, stale, mission, world=WORLD):
    return pytest.param(written(mission), set(stale.split()), world, id=sentence)


def beside_who_enters(way):
    """Return the mission of one that looks who is in gate0 and goes on in some way, beside another that enters it."""
    return written(f"""
    def enter(clear) = {{ if clear {{ ENTER }} }}
    def hold(o) = {{ if uav1 in o {{ NEVER }} }}
    def await() = {{ let full = true while full {{ LOOKS react {{ case o => full = uav1 in o }} }} }}
    a@uav0: let busy = false LOOKS {way}
    b@uav1: ENTER""")


RESTS = {
    "a match": "react { case o => match size(o) { case 0 => ENTER case _ => skip } }",
    "a choice": "react { case o => choose x in nodes(o) { ENTER } }",
    "a stored observation": "let seen = 0 react { case o => seen = o } if not (uav1 in seen) { ENTER }",
    "an argument": "react { case o => control(MOVE_HOST_TO first(nodes(o))) }",
    "an argument of a behaviour": "react { case o => enter(not (uav1 in o)) }",
    "the second half of a test": "react { case o => if uav0 in o or not (uav1 in o) { ENTER } }",
    "a query that is made of an observation": """
      react { case o => let seen = nodes(o) observe(PARENT(seen)) }
      react { case place if gate0 in place => skip case place => ENTER }""",
    "the exit of a loop in a behaviour": "react { case o => skip } await() ENTER",
    "an if whose other way waits": "react { case o => if uav1 in o { NEVER } } ENTER",
    "an if whose other way may choose to wait": """
      react { case o => if uav1 in o { choose { skip } or { NEVER } } } ENTER""",
    "a behaviour that may wait": "react { case o => hold(o) } ENTER",
    "a match whose other case waits": "react { case o => match size(o) { case 0 => skip case _ => NEVER } } ENTER",
    "a case beside an end of the wait that waits": """
      react { case o if not uav1 in o => skip after 5 s => NEVER } ENTER""",
    "a guard that refused and whose case waits": "react { case o if uav1 in o => NEVER after 5 s => skip } ENTER",
    "a guard that had to hold": "react { case o if not (uav1 in o) => skip } ENTER",
    "a guard": "react { case o if not (uav1 in o) => ENTER case o => skip }",
    "an earlier guard": "react { case o if uav1 in o => skip case o => ENTER }",
    "an if": "react { case o => if uav1 in o { skip } else { ENTER } }",
    "an if around an if": "react { case o => if not (uav1 in o) { if true { ENTER } } }",
    "a guard in a match": "react { case o => match 0 { case n if not (uav1 in o) => ENTER case _ => skip } }",
    "a for": "react { case o => for x in nodes(o) { ENTER } }",
    "a stored value": "let clear = false react { case o => clear = not (uav1 in o) } if clear { ENTER }",
    "a value stored under a test": """
      let clear = false react { case o => if not (uav1 in o) { clear = true } } if clear { ENTER }""",
    "a case whose other waits": "react { case o if not uav1 in o => skip case _ => NEVER } ENTER",
    "an if whose other way loops": "react { case o => if uav1 in o { loop { LOOKS react { case x => skip } } } } ENTER",
    "an if whose other way may look in vain": """react { case o => if uav1 in o {
      observe(HOST) react { case p: Observation if gate0 in p => skip } } } ENTER""",
    "an if whose other way looks until": """react { case o => if uav1 in o { let full = true while full {
      LOOKS react { case p => full = uav1 in p } } } } ENTER""",
    "an if whose other way is told": 'react { case o => if uav1 in o { react { case "free" => skip } } } ENTER',
    "a for whose body waits": "react { case o => for x in o of UAV { NEVER } } ENTER",
    "a guard that refused, after which the wait ended": """
      react { case o: Observation if uav1 in o => skip after 5 s => ENTER }""",
    "a test before a loop": "react { case o if not uav1 in o => skip } loop { ENTER NEVER }",
    "a test under which it looked": """
      react { case o => if not uav1 in o { observe(HOST) } } react { case _: Observation => ENTER }""",
    "a test under which it looked before": """
      react { case o => if not uav1 in o { observe(HOST) } } react { case _: Observation => skip } ENTER""",
    "what an if would have assigned": "react { case o => if uav1 in o { busy = true } } if not busy { ENTER }",
    "what another case would have assigned": """
      react { case o if uav1 in o => busy = true case _ => skip } if not busy { ENTER }""",
    "what a for would have assigned": """
      react { case o => for x in o { if x == uav1 { busy = true } } } if not busy { ENTER }""",
    "what would have had it migrate": """
      react { case o => if uav1 in o { migrate(vessel0) } } observe(HOST) react { case _: Observation => ENTER }""",
}  # fmt: skip
"""Ways of one that has looked; whatever it does in them rests on what it saw."""

FREE = {
    "what is only held": "react { case o => ENTER }",
    "what is only displayed": "react { case o => display(uav1 in o) ENTER }",
    "an answer that nobody changes": "react { case o if not (drifter0 in o) => ENTER case o => skip }",
    "its own doing": """
      react { case o if not (uav0 in o) => ENTER control(MOVE_HOST_TO south0) case o => skip }""",
    "both ways of a test alike": "react { case o => if uav1 in o { skip } ENTER }",
    "a control that comes before": "ENTER react { case o if uav1 in o => skip case o => skip }",
    "an if whose other way ends": "react { case o => if uav1 in o { skip } } ENTER",
    "an if whose other way looks and goes on": """
      react { case o => if uav1 in o { LOOKS react { case p => skip } } } ENTER""",
    "an if whose other way gives up": """
      react { case o => if uav1 in o { react { case "free" => skip after 5 s => skip } } } ENTER""",
    "an if whose other way counts": """
      react { case o => if uav1 in o { let n = 0 while n < 2 { n = n + 1 } } } ENTER""",
    "a match whose other case ends": "react { case o => match size(o) { case 0 => skip case _ => skip } } ENTER",
    "a wait that ended without a test": 'react { case "go" => skip after 5 s => ENTER }',
    "the guard of a wait that may end": """
      react { case o: Observation if not (uav1 in o) => skip after 5 s => skip } ENTER""",
    "a look before the last": """
      react { case o if not (uav1 in o) => skip } observe(PARENT(uav0)) react { case "never" => ENTER }""",
}  # fmt: skip

COMES_BACK = """
    a@uav0: react { case "go" => control(MOVE_HOST_TO south0) }
    b@uav1: observe(CHILDREN(south0)) react { case o if not (uav0 in o) => ENTER observe(PARENT(HOST))
              react { case there => send("go", a) control(MOVE_HOST_TO south0) } case o => skip }
    """
SEEN = [
    case("two look at different places", "", """
    a@uav0: LOOKS react { case o if not (uav1 in o) => ENTER case o => skip }
    b@uav1: observe(CHILDREN(south0)) react { case o if not (uav0 in o) => control(MOVE_HOST_TO south0) case o => skip }
    """),
    case("the environment changes it", "", """
    environment { uav1 drifts among gate0 }
    a@uav0: LOOKS react { case o if not (uav1 in o) => ENTER case o => skip }
    """),
    case("another changes a relation that the redex uses", "a", """
    a@uav0: LOOKS react { case o if not (uav1 in o) => ENTER case o => skip }
    b@gcs0: control(MOVE uav0 TO south0)
    """),
    case("another enters and leaves what has to be empty", "a", """
    rule enter(u: UAV, p: Location) { u || p -> p.u }
    a@uav0: LOOKS react { case o if not (drifter0 in o) => control(enter(uav0, gate0)) case o => skip }
    b@uav1: ENTER control(MOVE_HOST_TO south0)
    """),
    case("one looked again", "", """
    a@uav0: LOOKS react { case o => display(o) } react { case "in" => LOOKS }
            react { case o if not (uav1 in o) => ENTER case o => skip }
    b@uav1: ENTER observe(PARENT(HOST)) react { case inside => send("in", a) }
    """),
    case("one looks again in each turn of a loop", "", """
    a@uav0: loop { observe(PARENT(HOST)) react { case o if north0 in o => ENTER case o => NORTH } }
    b@uav1: ENTER
    """),
    *(case(f"who {goes} {place} changes its children", stale, f"""
    a@uav0: ENTER
    b@uav1: observe(ALL) react {{ case o if size(children({place}, o) of UAV) < 3 => NORTH }}
    """) for goes, place, stale in (("leaves", "north0", "b"), ("enters", "gate0", "b"), ("passes by", "south0", ""))),
    case("another comes to the place that one has left itself", "b", COMES_BACK),
    case("another comes to the place that one has left, of which it asked by where it was", "b",
      COMES_BACK.replace("CHILDREN(south0)", "CHILDREN(PARENT(HOST))")),
    case("others do something elsewhere while one is on its own way", "", """
    control timed
    b@uav1: observe(CHILDREN(PARENT(HOST))) react { case o if not (uav0 in o) => ENTER case o => skip }
    a@uav0: ENTER
    """),
    case("what a query begins with is changed by another", "b", """
    b@uav0: observe(CHILDREN(PARENT(uav1))) react { case o if vessel0 in o => ENTER case o => skip }
    a@uav1: NORTH
    """),
    case("what a query begins with is changed by oneself", "", """
    b@gcs1: observe(CHILDREN(PARENT(uav1))) react { case o if vessel0 in o =>
      control(MOVE uav1 TO north0) control(CONNECT_HOST_TO gcs0) case o => skip }
    a@uav0: ENTER
    """),
    case("it waits in the one queue of all", "a", """
    scheduler fcfs
    control timed
    a@uav0: LOOKS react { case o if not (uav1 in o) => control(MOVE_HOST_TO south0) ENTER send("go", b) case o => skip }
    b@uav1: react { case "go" => ENTER }
    """),
    case("as many are linked as before, though others", "", """
    b@gcs1: control(HAND uav1 TO gcs2)
    a@uav1: observe(LINKED_TO(uav1)) react { case o => if size(o) == 4 { ENTER } }
    """),
    case("of those that are counted there are more", "a", """
    b@gcs1: control(HAND uav1 TO gcs2)
    a@uav1: observe(LINKED_TO(uav1)) react { case o => if size(o - {vessel0}) == 3 { ENTER } }
    """),
]  # fmt: skip
"""What one sees itself."""

FREED = """
    a@uav0: LOOKS react { case o => ENTER observe(PARENT(HOST)) react { case there => TELLS } }
    b@uav1: react { case (word, n) if n == 0 => ENTER case m: Message => skip }
"""


PASSED_BY = """
    b@uav1: observe(CHILDREN(PARENT(HOST))) react { case o =>
      let n = size(o of UAV) ENTER observe(PARENT(HOST))
      react { case there => send("go", a) if n == 1 { control(MOVE_HOST_TO south0) } send(("seen", n), c) } }
    c@gcs2: react { case m: Message => skip }
    a@uav0: react { case "go" => control(MOVE_HOST_TO south0) }
    """
MOVED = """
    a@uav0: LOOKS react { case o => let full = uav1 in o NORTH control(MOVE_HOST_TO south0)
              observe(PARENT(HOST)) react { case there => send(("full", full), b) } }
    b@uav0: react { case (word, x) if not x => ENTER }
    """


def freed(tells, text=FREED):
    return text.replace("TELLS", tells)


LOOKOUT = """
    c@gcs0: LOOKS react { case o if not (uav1 in o) => send("clear", a) case o => send("full", a) }
    a@uav0: react { case "clear" => ENTER case "full" => skip }
    b@uav1: ENTER
    """
HANDOVER = """
    op1@gcs0: observe(LINKED_TO_HOST) react { case o if uav0 in o =>
      control(HAND uav0 TO gcs1) observe(LINKED_TO(uav0)) react { case again => send("yours", op2) } case o => skip }
    op2@gcs1: react { case "yours" => control(HAND uav0 TO gcs2) }
    """
NOT_HANDED = HANDOVER.replace("control(HAND uav0 TO gcs1)", "skip").replace(
    "HAND uav0 TO gcs2", "HAND uav1 TO gcs2"
)
RELAYED = """
    a@gcs0: LOOKS react { case o => send(("free", size(o of UAV)), b) }
    b@uav1: ENTER ARRIVES react { case (word, n) if n == 0 => send(("free", n), c) case m: Message => skip }
    c@uav0: react { case (word, n) if n == 0 => ENTER case m: Message => skip }
    """
TOLD = [
    case("a word is said under a test", "a", LOOKOUT),
    case("who says a word under a test changes it afterwards", "a", """
    c@uav1: LOOKS react { case o if not (uav1 in o) => send("clear", a) ENTER case o => skip }
    a@uav0: react { case "clear" => ENTER }
    """),
    case("who says a word has changed what it tested before", "", HANDOVER),
    case("who says a word has changed nothing", "", NOT_HANDED),
    case("a third changes what was tested before a word is said", "op2",
      f"{NOT_HANDED}op3@gcs0: control(HAND uav0 TO gcs2)"),
    case("a value is told on by one that has changed it", "c", RELAYED, NEAR),
    case("another value is told on", "", RELAYED.replace('("free", n), c', '("free", 0), c'), NEAR),
    case("a value is told to nobody else", "", RELAYED.replace('send(("free", n), c)', "NORTH"), NEAR),
    case("a value is computed after its teller has changed it", "b", freed('send(("free", size(o of UAV)), b)')),
    case("a value was computed before its teller has changed it", "b",
      freed('send(("free", n), b)', FREED.replace("case o =>", "case o => let n = size(o of UAV)"))),
    case("a value goes through others' hands", "b",
      freed('send(("free", size(o of UAV)), c)') + "c@uav1: react { case m: Message => send(m, b) }"),
    case("it is told that something is done", "", freed('send(("free", 0), b)')),
    case("whatever it says, a message has come", "", freed('send(("free", size(o of UAV)), b)', FREED.replace(
      "case (word, n) if n == 0 => ENTER case m: Message => skip", "case m: Message => ENTER"))),
    case("a message holds the observation", "a", """
    c@gcs0: LOOKS react { case o => send(o, a) }
    a@uav0: react { case seen if not (uav1 in seen) => ENTER case seen => skip }
    b@uav1: ENTER
    """),
    case("a message is passed on", "a", """
    c@gcs0: LOOKS react { case o if not (uav1 in o) => send("clear", relay) case o => send("full", relay) }
    relay@gcs0: react { case word: Message => send(word, a) }
    a@uav0: react { case "clear" => ENTER case "full" => skip }
    b@uav1: ENTER
    """),
    case("one was told to go on, and saw somebody", "", """
    environment { someone says "free" to a }
    a@uav0: observe(CHILDREN(south0)) react { case o => if uav1 in o { react { case "free" => skip } } }
            control(MOVE_HOST_TO south0)
    b@uav1: ENTER
    """),
    case("one need not be told to go on, since it saw nobody", "a", """
    environment { someone says "free" to a }
    a@uav0: LOOKS react { case o => if uav1 in o { react { case "free" => skip } } } ENTER
    b@uav1: ENTER
    """),
    case("one is spawned after a test whose other way waits", "k", """
    def go() = { ENTER }
    a@uav0: LOOKS react { case o => if uav1 in o { NEVER } } spawn k hosted_at uav0 with_behavior go()
    b@uav1: ENTER
    """),
    case("one is told at the second hand after a test whose other way waits", "c", """
    a@uav0: LOOKS react { case o => if uav1 in o { NEVER } } send "go" to r
    r@uav0: react { case m: Message => send "on" to c }
    c@uav0: react { case m: Message => ENTER }
    d@uav1: ENTER
    """),
    case("a value comes back", "", """
    a@uav0: LOOKS react { case o => ENTER send(("free", size(o of UAV)), b) }
            react { case (word, n) if n == 0 => NORTH case m: Message => skip }
    b@uav1: react { case m: Message => send(m, a) }
    """),
    case("a value comes back from one that has changed it", "a", """
    a@uav0: LOOKS react { case o => ENTER send(("free", size(o of UAV)), b) }
            react { case (word, n) if n == 0 => NORTH case m: Message => skip }
    b@uav1: react { case m: Message => ENTER send(m, a) }
    """),
    case("who is spawned moves and tells its spawner", "a", """
    def enter(n) = { ENTER send(("free", n), a) }
    a@uav0: LOOKS react { case o => spawn c hosted_at uav1 with_behavior enter(size(o of UAV)) }
            react { case (word, n) if n == 0 => ENTER case m: Message => skip }
    """),
    case("one is spawned at a host that was chosen by what was seen", "c", """
    def enter() = { ENTER }
    a@uav0: observe(CHILDREN(south0)) react { case o => spawn c hosted_at first(o of UAV) with_behavior enter() }
    b@gcs1: control(MOVE uav1 TO gate0)
    """),
    case("another sees what led to where it looked", "b", freed("""
      let x = first(nodes(o)) observe(CHILDREN(x)) react { case p => send(("free", size(p of UAV) - 1), b) }""")),
    case("the observation is told", "b",
      freed('send(("free", o), b)', FREED.replace("n == 0", "not (uav0 in n)"))),
    case("a member is told that it goes through", "b", freed("for x in nodes(o) { send((1, size({x} of UAV)), b) }")),
    case("a member is told that it chooses", "b", freed("choose x in nodes(o) { send((1, size({x} of UAV)), b) }")),
    case("a part is told that it matches", "b", freed("match size(o of UAV) { case k => send((1, k), b) }")),
    case("an argument is told", "b", "def tell(k) = { send((1, k), b) }\n" + freed("tell(size(o of UAV))")),
    case("an argument is that of who is spawned", "k", "def enter(n) = { if n == 0 { ENTER } }\n"
      + freed("spawn k hosted_at uav1 with_behavior enter(size(o of UAV))")),
    case("what is told was seen afterwards", "",
      freed("skip").replace("observe(PARENT(HOST)) react { case there => skip", """
      observe(CHILDREN(gate0)) react { case p => send(("free", size(p of UAV)), b)""")),
    case("what is told was known under a test alone", "", freed('send(("free", n), b)',
      FREED.replace("case o =>", "case o if size(o) == 1 => let n = 0"))),
    case("another answer is told", "", freed('send(("free", uav1 in o), b)', FREED.replace("n == 0", "not n"))),
    case("one knows what it has made of what it has computed", "", """
    a@uav0: LOOKS react { case o => ENTER send(size(o), b) if size(o) == 1 { NORTH } }
    b@uav1: react { case n => skip }
    """),
    case("a value is about the place that its holder has left", "b", PASSED_BY),
    case("a value is not about the place where its holder is now", "",
      PASSED_BY.replace('"go" => control(MOVE_HOST_TO south0)', '"go" => ENTER')),
    case("its teller has moved a vehicle, and who is told moves it on", "", MOVED),
    case("a third has moved a vehicle that its teller has moved", "b", f"{MOVED}c@gcs0: control(MOVE uav0 TO north0)"),
]  # fmt: skip
"""What one is told by others."""

CHANGED_BY_ITS_HOLDER = [
    case("while it is in the mailbox", "b", """
    look@gcs0: observe(LINKED_TO(HOST)) react { case o => send(("linked", uav0 in o), a) }
    a@uav0: control(DISCONNECT_HOST_FROM gcs0) ARRIVES react { case (word, x) => send((word, x), b) }
    b@uav1: react { case (word, x) if x => ENTER }
    """, RADIO),
    case("while it is on its way", "b", """
    look@gcs1: observe(LINKED_TO(HOST)) react { case o => send(("linked", uav0 in o), a) control(HAND uav1 TO gcs2) }
    a@uav0: loop { observe(LINKED_TO(gcs2)) react {
      case o: Observation if uav1 in o => control(CONNECT_HOST_TO gcs1) react { case (word, x) => send((word, x), b) }
      case o: Observation => skip } }
    b@uav1: react { case (word, x) if not x => ENTER }
    """),
    case("while it is not received yet", "b", """
    a@uav0: LOOKS ENTER react { case "go" => skip } react { case o: Observation => send(("free", size(o of UAV)), b) }
    look@gcs0: LOOKS react { case o if uav0 in o => send("go", a) }
    b@uav1: react { case (word, n) if n == 0 => ENTER }
    """),
    case("while it waits to migrate", "b", """
    scheduler unordered
    a@uav1: observe(LINKED_TO(gcs0)) react { case o => migrate(first(o of Station)) }
            control(CONNECT_HOST_TO gcs0) react { case "go" => send(("at", HOST), b) }
    look@gcs0: observe(HOSTED_AT(gcs0)) react { case o if a in o => send("go", a) }
    b@uav0: react { case (word, h) if h == gcs0 => ENTER }
    """, LONELY),
]  # fmt: skip
"""Each makes sure that its holder's control is served there, and nowhere else."""

RECEIVER_MOVED = {
    "while its station looked": """
    a@gcs0: control(HAND uav0 TO gcs1) observe(LINKED_TO(HOST)) react { case o if uav1 in o => send("go", b) }
    b@uav0: ENTER react { case "go" => NORTH }
    """,
    "in no order with its looking": """
    scheduler unordered
    a@uav0: ENTER react { case "go" => ENTER }
    b@uav1: observe(CHILDREN(south0)) react { case o if vessel0 in o => send("go", a) }
    """,
    "to where its sender is": """
    a@uav1: ENTER LOOKS react { case o if not (uav0 in o) => send("go", b) }
    b@uav0: ENTER react { case "go" => NORTH }
    """,
}


def migrating(how, others):
    return f"""
    b@vessel0: observe(CHILDREN(south0)) react {{ case o => {how} }}
      observe(PARENT(HOST)) react {{ case there => ENTER }}
    {others}
    """


TAKES_AWAY, COMES = "a@gcs1: control(MOVE uav1 TO north0)", "a@gcs0: control(MOVE uav0 TO south0)"


def telling_its_host(before, comes, there, told):
    return f"""
    c@uav0: react {{ case h: Message if h != 0 => ENTER }}
    b@vessel0: observe(CHILDREN(south0)) react {{ case o => {before} {comes} {there} }}
      observe(PARENT(HOST)) react {{ case there => send({told}, c) }}
    """


TELLS_ITS_HOST = {
    "what it has made stale before it went": ("let h = first(o of UAV)", "NORTH ARRIVES", "migrate(h)", "HOST"),
    "what it made stale on its way": ("NORTH migrate(first(o of UAV))", "", "", "HOST"),
    "what it made stale there": ("migrate(first(o of UAV))", "ARRIVES", "NORTH ARRIVES", "HOST"),
    "a value of it": ("migrate(first(o of UAV))", "ARRIVES", "NORTH ARRIVES", "{HOST}"),
}  # fmt: skip

STATION = """
    b@gcs0: observe(LINKED_TO(uav1)) react { case o => migrate(first(o of Station)) }
            observe(PARENT(HOST)) react { case there => control(MOVE uav1 TO gate0) }
    a@uav0: control(DISCONNECT_HOST_FROM uav1)
    """
SPAWNER = """
    def enter() = { ENTER }
    a@vessel0: observe(CHILDREN(south0)) react { case o => let h = first(o of UAV) NORTH
      observe(PARENT(HOST)) react { case there => spawn c hosted_at h with_behavior enter() } }
    """
HOSTED = [
    case("chosen by an observation", "b", migrating("migrate(first(o of UAV))", TAKES_AWAY)),
    case("decided by a test", "b", migrating("if uav1 in o { migrate(uav1) }", TAKES_AWAY)),
    case("held by a variable", "b", migrating("let h = first(o of UAV) migrate(h)", TAKES_AWAY)),
    case("chosen by an observation, and then where it is already", "b",
      migrating("migrate(first(o of UAV)) migrate(HOST)", TAKES_AWAY)),
    case("chosen by an observation that another changed by coming", "b", migrating("migrate(first(o of UAV))", COMES)),
    case("written, though an observation is held", "", migrating("migrate(uav1)", COMES)),
    case("decided by an answer that nobody has changed", "", migrating("if vessel0 in o { migrate(uav1) }", COMES)),
    case("left since", "", migrating("migrate(first(o of UAV)) migrate(uav0)", COMES)),
    case("a station that an observation chose", "b", STATION),
    case("a station that is written", "", STATION.replace("first(o of Station)", "gcs1")),
    case("that of its spawner, which made it stale", "c", SPAWNER),
    case("that of its spawner, which left it as it was", "", SPAWNER.replace("NORTH", "skip")),
]  # fmt: skip
"""How a host came to be whose agent acts there."""
