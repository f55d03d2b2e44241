"""The calculus: configurations ⟨α | S | η⟩, the seven inference rules, and the bigActor extension.

The package does not depend on search, files, devices or the mission language. `semantics.hypothesis_strategies`
generates structures and configurations for property-based tests; it needs the extra `strategies`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
