"""Less to explore: partial-order reduction and symmetry, each refused with a reason where it would be unsound.

Both depend on what the text of a mission allows, never on observed runs. docs/explanation/reduction.md has the reasons.
"""

from checker.reduction.ample import Ample, Proviso
from checker.reduction.reducer import Reduced
from checker.reduction.refusals import Reduction, RefusedError

__all__ = ["Ample", "Proviso", "Reduced", "Reduction", "RefusedError"]
