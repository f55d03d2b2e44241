"""The engine: states as integers and bit masks, planned matching, incremental rewriting, canonical keys.

It does not depend on notations or drawings. `bigraphs.exploration` and `bigraphs.simulation` run it.
"""
