"""The missions that ship, by name: those that say how long things take, and the others.

Those about ways are in neither list of variations: under `control atomic` they are refused.
"""

from semantics.properties.property import asks_of_regions
from specs.elaboration import load_mission
from specs.missions import shipped_missions

ALL = tuple(shipped_missions())
LOADED = {name: load_mission(name) for name in ALL}
TIMED = tuple(name for name in ALL if LOADED[name].setting.timing is not None)
WAYS = tuple(name for name in ALL if asks_of_regions(LOADED[name].properties) and name not in TIMED)
UNTIMED = tuple(name for name in ALL if name not in (*TIMED, *WAYS))
