"""The missions that ship, by name: those that say how long things take, and the others."""

from specs.elaboration import load_mission
from specs.missions import shipped_missions

ALL = tuple(shipped_missions())
TIMED = tuple(name for name in ALL if load_mission(name).setting.timing is not None)
UNTIMED = tuple(name for name in ALL if name not in TIMED)
