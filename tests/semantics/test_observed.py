"""Steps that the world decides: what may be written, where flights end, and that both are read back as written."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_missions import SEARCH, fly_home

from physical import Band, box, circle, point, translate_to
from semantics.canonical import canonical, digest_of_step, written
from semantics.observed import Sight, admitting, arriving, happening, steps_seen
from semantics.physical_model import Carried, InTransit, Placed, placement_cell
from semantics.plain import placement_of, sight_json, sight_of, value_json
