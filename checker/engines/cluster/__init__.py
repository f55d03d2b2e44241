"""The cluster explorer, over several processes and machines: a hash assigns each row to a worker.

Each worker (`shard`) learns the rules for itself and so has codes of its own; what crosses between workers is rows
with the values that the other has not been told yet (`transfer`). Only `ray_crew` knows Ray.
"""
