"""Where everything is, found anew only for what a step has moved."""

from pathlib import Path

from adapters.console.whereabouts import whereabouts
from physical import point
from semantics.state.physical_model import InTransit, PhysicalModel, Placed, placement_cell
from specs import Source
from specs.elaboration import elaborate
from specs.parser import parse

TEXT = """
signature { kind Location contains Location, UAV, Box kind UAV driven carries Box kind Box }
world {
  west0: Location = box (37.2, -8.8) (37.0, -9.0)
  east0: Location = box (37.2, -8.2) (37.0, -8.4)
  inner0: Location = box (37.1, -8.25) (37.05, -8.35)
  uav0: UAV = point (37.1, -8.9)
  uav1: UAV = point (37.15, -8.3)
  box0: Box carried by uav0
}
"""


def moved(c, **placements):
    return c.with_({placement_cell(name): at for name, at in placements.items()})


def test_parents_are_asked_of_p_again_only_for_what_a_step_may_have_moved(monkeypatch):
    asked, parent = [], PhysicalModel.abstract_parent
    count = lambda model, name: asked.append(name) or parent(model, name)  # noqa: E731
    monkeypatch.setattr(PhysicalModel, "abstract_parent", count)
    source = Source("moves", TEXT)
    first = elaborate(parse(source), source, Path()).initial
    over_inner = moved(first, uav1=Placed(point(37.07, -8.3)))
    flying = moved(over_inner, uav0=InTransit(Placed(point(37.1, -8.9)), "east0"))
    without_inner = moved(flying, inner0=None)
    vehicles, others = {"uav0", "uav1"}, {"west0", "east0"}
    whereabouts(first)
    for c, anew in [
        (over_inner, {"uav1"}),
        (flying, {"uav0"}),
        (without_inner, vehicles | others),
        (moved(first, box0=Placed(point(37.07, -8.3))), {"box0", "inner0"} | vehicles | others),
    ]:
        asked.clear()
        found = {name: where.actual for name, where in whereabouts(c).items()}
        assert set(asked) == anew
        physical = c.structure.physical
        assert found == {name: parent(physical, name) if name in physical else None for name in found}
