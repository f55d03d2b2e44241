"""The calculus: configurations ⟨α | S | η⟩, the seven inference rules, and the bigActor extension.

It knows nothing of search, time, files, devices or the mission language. Generated structures and configurations for
property-based tests are in `semantics.strategies`, which needs the extra `strategies`.
"""

from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Fault
from semantics.behaviours.observations import Observation, Query
from semantics.behaviours.program import Behaviour, Program
from semantics.behaviours.queries import evaluate, overlay
from semantics.behaviours.reaction_rules import Match, Pattern, Reaction, matches
from semantics.control import Obstacle, obstacle
from semantics.environment import Appears, Clause, Drifts, Drops, Leaves, Says, Vanishes
from semantics.extension import EXTENSION
from semantics.properties.property import Property
from semantics.properties.propositions import Proposition, holds
from semantics.races.monitor import monitored
from semantics.rules import RULES, TIMED_RULES
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.initial import Beliefs, initial
from semantics.state.physical_model import Carried, InTransit, Placed
from semantics.state.relations import Linked, Parent
from semantics.state.requests import CTR, FLY, MGR, OBS, READY, SND, Request
from semantics.state.setting import Control, Scheduler, Setting
from semantics.state.signature import REGION, Kind, Name, Signature
from semantics.state.structure import Structure
from semantics.successors import Expansion, expand, successors

__all__ = [
    "COMMANDS",
    "CTR",
    "EXTENSION",
    "FLY",
    "MGR",
    "OBS",
    "READY",
    "REGION",
    "RULES",
    "SND",
    "TIMED_RULES",
    "Appears",
    "Behaviour",
    "Beliefs",
    "Carried",
    "Clause",
    "Configuration",
    "Control",
    "Drifts",
    "Drops",
    "Expansion",
    "Fault",
    "InTransit",
    "Kind",
    "Label",
    "Leaves",
    "Linked",
    "Match",
    "Name",
    "Observation",
    "Obstacle",
    "Parent",
    "Pattern",
    "Placed",
    "Program",
    "Property",
    "Proposition",
    "Query",
    "Reaction",
    "Request",
    "Says",
    "Scheduler",
    "Setting",
    "Signature",
    "Structure",
    "Transition",
    "Vanishes",
    "evaluate",
    "expand",
    "holds",
    "initial",
    "matches",
    "monitored",
    "obstacle",
    "overlay",
    "successors",
]
