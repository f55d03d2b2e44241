"""The cluster explorer: several processes and machines, with each row assigned to a worker by its hash.

Each worker (`shard`) learns the rules by itself and has its own codes. Rows travel with the values that are new to the
receiver (`transfer`). Only `ray_crew` imports Ray.
"""
