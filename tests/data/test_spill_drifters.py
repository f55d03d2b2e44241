"""The synthetic AIS recording of the live demonstration is what its script encodes."""

import runpy
from pathlib import Path

from physical.ais_recording import read_recording


def test_the_recording_is_what_the_script_encodes():
    made = runpy.run_path(str(Path(__file__).parent / "make_spill_drifters.py"))
    assert made["PATH"].read_bytes() == made["encode"]()


def test_both_drifters_are_heard_for_fifty_minutes():
    positions = read_recording(
        Path(__file__).parents[2] / "specs" / "missions" / "spill_watch.nmea"
    ).positions
    times = [report.time for report in positions]
    assert {report.mmsi for report in positions} == {263999001, 263999002}
    assert max(times) - min(times) > 49 * 60
