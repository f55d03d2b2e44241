"""The explorer over several processes and machines: rows belong to workers by a hash of what they say.

Each worker (`shard`) learns the rules for itself and so has codes of its own; what crosses between workers is rows
with the values that the other has not been told yet (`transfer`). Only `ray_crew` knows Ray.
"""
