"""Bigraphs: places nested in places, links across them, and rules that rewrite both.

Values, algebra, rules, matching, rewriting, canonical forms and drawings; whole systems, explored, run and decided by
`bigraphs.engine`; notations are read and written by `bigraphs.notation`, transition systems written by
`bigraphs.exports`. This room knows nothing of missions, vehicles, the earth or agents.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
