"""The engine: states as integers and bit masks, planned matching, incremental rewriting, canonical keys.

Nothing in here knows how a system is written or drawn. `bigraphs.exploration` and `bigraphs.simulation` run it.
"""
