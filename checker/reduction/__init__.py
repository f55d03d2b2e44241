"""Partial-order reduction and symmetry reduction, each refused with a reason where it would be unsound.

Both depend on the text of a mission, never on observed runs. docs/explanation/reduction.md has the reasons.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
