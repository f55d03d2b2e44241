"""Systems of all kinds that are explored in several ways, and all that an exploration says."""

import sys
from pathlib import Path

from bigraphs.examples import example_text
from bigraphs.notation import write_big

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import bigraph_shapes as shapes
import uav_family

# Actions, weights, edges, and instantaneous rules that do not agree, so that least forms are looked for.
CHANCE = """
ctrl Box = 0; atomic ctrl Red = 1; atomic ctrl Blue = 1; atomic ctrl Grey = 0; atomic ctrl Spark = 1;
big boxes = /x /y (Box.(Red{x} | Red{x} | Spark{y} | Grey) | Box.(Red{y} | Grey) | Box.1);
big three = Spark{x} | Spark{x} | id;
react blue = Red{x} -[2]-> Blue{x} | Spark{x};
react red = Blue{x} -[1]-> Red{x};
react carry = Box.(Red{x} | id) | Box.id -[1]-> Box.id | Box.(Red{x} | id) @ [1, 0];
react fade = Spark{x} | Spark{x} | Grey -[1]-> {x} | Grey | Spark{x};
react leap = Box.(Spark{x} | Grey | id) | Box.id -[1]-> Box.(Grey | id) | Box.(Spark{x} | id);
begin pbrs init boxes; rules = [ (fade), {blue, red, carry}, {leap} ]; end
"""
GROWING = """
ctrl A = 0; atomic ctrl B = 0;
big one = A.B;
react grow = A.id --> A.(B | id);
react nest = A.(B | id) --> A.(A.B | id);
begin brs init one; rules = [ {grow, nest} ]; end
"""
WALK = """
ctrl Room = 1; atomic ctrl Ball = 0;
big six = Room{a}.(Ball | Ball | Ball | Ball | Ball | Ball) | Room{b}.1 | Room{c}.1 | Room{d}.1;
react move = Room{x}.(Ball | id) | Room{y}.id --> Room{x}.id | Room{y}.(Ball | id);
begin brs init six; rules = [ {move} ]; end
"""

MODELS = {
    "many subtrees": shapes.nest(3, 6),
    "many rules": shapes.batteries(3, 5),
    "priorities": shapes.agenda(4, 6),
    "edges": shapes.calls(5),
    "sharing": shapes.motes(5),
}
CASES = {
    "names": uav_family.Case("row", 2, 4, distinct=True, open=True),
    "closed links": uav_family.Case("2x2", 3, 4, distinct=False, open=False),
}
SYSTEMS = {
    **{name: (model.text, model.states) for name, model in MODELS.items()},
    **{name: (uav_family.text(case), uav_family.counts(case)[0]) for name, case in CASES.items()},
    "predicates": (example_text("sensor_network"), 24),
    "weights": (CHANCE, 12),
}


def told(found):
    """Return all that a transition system says."""
    states = [write_big(found.state(number)) for number in range(len(found))]
    return states, list(found.transitions()), list(found.found_from), list(found.holding), found.occurrences
