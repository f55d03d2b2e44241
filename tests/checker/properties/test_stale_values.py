"""Stale-observation races of values that are held, or on their way, while their holder changes what they are about."""

import pytest
from checked_missions import WORLD, load, moves
from test_races import STALE, kinds, stale, verdict

from checker import explore
from semantics.races.monitor import CONTROLS, monitored
from semantics.successors import expand

RADIO = WORLD.replace("linked control:gcs0, mesh", "linked mesh, radio").replace(
    "linked control:gcs0, internet", "linked control:gcs0, internet, radio"
)
"""uav0 is under nobody's control authority, and hears gcs0 on the radio alone."""

LONELY = WORLD.replace("linked control:gcs1, mesh", "linked control:gcs1")
"""uav1 hears nobody but gcs1."""

CHANGED_BY_ITS_HOLDER = {
    "while it is in the mailbox": (
        RADIO,
        """
        BigActor look hosted_at gcs0 with_behavior {
          observe(LINKED_TO(HOST)) react { case o => send(("linked", uav0 in o), a) }
        }
        BigActor a hosted_at uav0 with_behavior {
          control(DISCONNECT_HOST_FROM gcs0) observe(PARENT(HOST)) react { case there: Observation => skip }
          react { case (word, x) => send((word, x), b) }
        }
        BigActor b hosted_at uav1 with_behavior { react { case (word, x) if x => control(MOVE_HOST_TO gate0) } }
        """,
    ),
    "while it is on its way": (
        WORLD,
        """
        BigActor look hosted_at gcs1 with_behavior {
          observe(LINKED_TO(HOST)) react { case o => send(("linked", uav0 in o), a) control(HAND uav1 TO gcs2) }
        }
        BigActor a hosted_at uav0 with_behavior {
          loop {
            observe(LINKED_TO(gcs2))
            react {
              case o: Observation if uav1 in o =>
                control(CONNECT_HOST_TO gcs1)
                react { case (word, x) => send((word, x), b) }
              case o: Observation => skip
            }
          }
        }
        BigActor b hosted_at uav1 with_behavior { react { case (word, x) if not x => control(MOVE_HOST_TO gate0) } }
        """,
    ),
    "while it is not received yet": (
        WORLD,
        """
        BigActor a hosted_at uav0 with_behavior {
          observe(CHILDREN(gate0)) control(MOVE_HOST_TO gate0)
          react { case "go" => skip }
          react { case o: Observation => send(("free", size(o of UAV)), b) }
        }
        BigActor look hosted_at gcs0 with_behavior {
          observe(CHILDREN(gate0)) react { case o if uav0 in o => send("go", a) }
        }
        BigActor b hosted_at uav1 with_behavior { react { case (word, n) if n == 0 => control(MOVE_HOST_TO gate0) } }
        """,
    ),
    "while it waits to migrate": (
        LONELY,
        """
        BigActor a hosted_at uav1 with_behavior {
          observe(LINKED_TO(gcs0)) react { case o => migrate(first(o of Station)) }
          control(CONNECT_HOST_TO gcs0)
          react { case "go" => send(("at", HOST), b) }
        }
        BigActor look hosted_at gcs0 with_behavior {
          observe(HOSTED_AT(gcs0)) react { case o if a in o => send("go", a) }
        }
        BigActor b hosted_at uav0 with_behavior { react { case (word, h) if h == gcs0 => control(MOVE_HOST_TO gate0) } }
        scheduler unordered
        """,
    ),
}
"""Each makes sure that its holder's control is served there, and nowhere else."""


@pytest.mark.parametrize(("world", "text"), CHANGED_BY_ITS_HOLDER.values(), ids=CHANGED_BY_ITS_HOLDER)
def test_what_its_holder_changes_is_stale_for_whom_it_tells_the_value(world, text):
    assert stale(text, world) == {"b"}
    assert STALE in kinds(verdict(text, "race_freedom", world))


KEPT_TO_ITSELF = """
BigActor look hosted_at gcs0 with_behavior {
  observe(CHILDREN(gate0)) react { case o => send(("free", size(o of UAV)), a) }
}
BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(gate0)) control(MOVE_HOST_TO gate0)
  react { case (word, n) if n == 0 => control(MOVE_HOST_TO north0) }
  react { case o: Observation if uav0 in o => control(MOVE_HOST_TO south0) }
}
"""


def test_what_its_holder_changes_is_not_remembered_where_it_tells_nobody():
    held = []
    for c in explore(monitored(load(KEPT_TO_ITSELF).initial)).configurations:
        for step in expand(c).by_agents:
            if step.label.rule in CONTROLS and step.label.agent == "a":
                assert received(step.target) == received(c)
                held.append(received(c))
    assert any(mail for mail, _ in held)
    assert any(seen for _, seen in held)


def received(c):
    """Return what it rests on that a has in its mailbox, and that it has been shown."""
    return list(filter(None, c.alpha.watch("a").mailbox)), [each.rests_on for each in c.eta.ready("a")]


PASSED_BY = """
BigActor b hosted_at uav1 with_behavior {
  observe(CHILDREN(PARENT(HOST)))
  react {
    case o =>
      let n = size(o of UAV)
      control(MOVE_HOST_TO gate0)
      observe(PARENT(HOST))
      react { case there => send("go", a) if n == 1 { control(MOVE_HOST_TO south0) } send(("seen", n), c) }
  }
}
BigActor a hosted_at uav0 with_behavior { react { case "go" => control(MOVE_HOST_TO PLACE) } }
BigActor c hosted_at gcs2 with_behavior { react { case m: Message => skip } }
"""


def test_a_value_that_is_told_is_about_the_place_that_its_holder_has_left():
    assert stale(PASSED_BY.replace("PLACE", "south0")) == {"b"}
    assert stale(PASSED_BY.replace("PLACE", "gate0")) == set()


MOVED_BY_ITS_TELLER = """
BigActor a hosted_at uav0 with_behavior {
  observe(CHILDREN(gate0))
  react {
    case o =>
      let full = uav1 in o
      control(MOVE_HOST_TO north0)
      control(MOVE_HOST_TO south0)
      observe(PARENT(HOST))
      react { case there => send(("full", full), b) }
  }
}
BigActor b hosted_at uav0 with_behavior { react { case (word, x) if not x => control(MOVE_HOST_TO gate0) } }
"""


def test_a_vehicle_that_its_teller_has_moved_before_it_told_is_moved_on_by_who_is_told():
    assert stale(MOVED_BY_ITS_TELLER) == set()
    third = "BigActor c hosted_at gcs0 with_behavior { control(MOVE uav0 TO north0) }\n"
    assert stale(MOVED_BY_ITS_TELLER + third) == {"b"}


@pytest.mark.parametrize(("place", "found"), [("north0", {"b"}), ("gate0", {"b"}), ("south0", set())])
def test_who_leaves_a_place_and_who_enters_one_changes_its_children(place, found):
    text = f"""
    BigActor b hosted_at uav1 with_behavior {{
      observe(ALL) react {{ case o if size(children({place}, o) of UAV) < 3 => control(MOVE_HOST_TO north0) }}
    }}
    """
    assert stale(text + moves("gate0", "a", "uav0")) == found
