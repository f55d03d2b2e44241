"""Crosscheck of symmetry: exchanges of members commute with the steps of a configuration, and with its clocks."""

from collections import Counter

from checker.reduction.configuration_renaming import Renaming
from checker.reduction.exchanged_times import renamed_clock
from checker.reduction.footprint_check import Drift
from checker.reduction.symmetry import MissionSymmetry
from semantics.state.configuration import Configuration
from semantics.state.printing import print_configuration
from semantics.successors import expand
from semantics.timing.clocks import TimedView


def exchange(symmetry: MissionSymmetry, c: Configuration) -> None:
    """Check that the exchanges of symmetric members commute with the transitions of a configuration.

    Raises:
        Drift: An exchange does not.
    """
    for each in symmetry.classes:
        for other in range(1, len(each.members)):
            swap = Renaming(*each.moving((other, *range(1, other), 0, *range(other + 1, len(each.members)))))
            found = {step.target for step in expand(swap.configuration(c)).transitions}
            after = {swap.configuration(step.target) for step in expand(c).transitions}
            if found != after or _clocks(swap.configuration(c)) != _clocks(c, swap):
                who = " and ".join(", ".join(each.names[member]) for member in (0, other))
                raise Drift(f"{who} are not alike, in the configuration\n{print_configuration(c)}")


def _clocks(c: Configuration, renaming: Renaming | None = None) -> Counter[tuple[object, ...]]:
    """Return the clocks of a configuration with times, renamed: each with its bounds and its aim."""
    if c.setting.timing is None:
        return Counter()
    view, swap = TimedView(c), renaming or Renaming()
    images = [renamed_clock(each, swap, c.setting.environment) for each in view.clocks]
    return Counter(
        (image, view.bounds[clock], swap.value(view.aims.get(clock)))
        for image, clock in zip(images, view.clocks, strict=True)
    )
