"""The calculus: configurations ⟨α | S | η⟩, the seven inference rules, and the bigActor extension.

It knows nothing of search, time, files, devices or the mission language. Generated structures and configurations for
property-based tests are in `semantics.strategies`, which needs the extra `strategies`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
