"""The model checker: explores every interleaving of a mission and decides its properties, with shortest traces.

It uses the calculus only through `semantics.successors`, and knows nothing of files, vehicles or the mission language.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
