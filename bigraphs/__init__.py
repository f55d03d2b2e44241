"""Bigraphs: nested places, links across them, and rules that rewrite both.

This package holds values, algebra, rules, matching, rewriting, canonical forms and drawings. `bigraphs.engine` runs
whole systems for `bigraphs.exploration` and `bigraphs.simulation`. `bigraphs.notation` reads and writes the notations,
`bigraphs.exports` writes transition systems. The package does not depend on missions, vehicles, the earth or agents.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
