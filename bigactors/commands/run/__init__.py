"""`bigactors run`: fly a verified mission."""

from argparse import Namespace
from typing import Final

from bigactors.arguments.options import MISSION, SERVING, SOURCE
from bigactors.arguments.values import ADDRESS, LIVING, SETTINGS
from bigactors.exits import Exit

DESCRIPTION: Final = """\
Fly a mission: the verified rules move one configuration, as telemetry and feeds permit. A run begins only with a
verdict on exactly this mission under 'control timed' that everything holds (check --verdict), and in a world as in the
mission's environment section. A broken assumption or invariant, a refused command and a late report are printed at
once.

exit codes:
  0  the mission came to its end
  1  an assumption or an invariant broke, the recording or a plugin failed, or the first world was not the mission's
  2  a mistake in the input, no verdict, or a silent vehicle
  3  stopped before its end, by --for, Ctrl-C, SIGTERM or SIGHUP; each vehicle goes on with its last command"""

EXAMPLES: Final = (
    f"bigactors run oil_spill.mission --vehicle uav0={ADDRESS} --feed ais=udp:10110 --record run.mcap",
    f"bigactors run handover.mission --station gcs0 --peers peers.toml --vehicle uav0={ADDRESS}",
)

ARGUMENTS: Final = f"""\
  file FILE  {MISSION}

vehicles and feeds
  --vehicle NAME[:ID]=ADDRESS  the address of the vehicle NAME, and its MAVLink system id, such as uav0={ADDRESS};
      for a robot of ROS 2, uav0=ros:tcp:HOST:PORT (docs/how-to/ros.md); for a rehearsal, simulated:plane;
      `bigactors plugins` lists all forms; may be repeated
  --feed KIND=ADDRESS  a source of positions, such as ais=udp:10110 or ais=file:harbour.nmea; the kinds are ais,
      places, detections, locations, ros, and those of `bigactors plugins`; may be repeated
  --misses SHARE[,SEED]  simulate a sensor that misses, with the probability SHARE in each look, an entity that the
      mission lets observations miss (observe may miss OilSpill)
  --publish ros=ADDRESS  publish the physical and the logical model for ROS 2, through the Zenoh router at
      tcp:HOST:PORT[?domain=N] (docs/how-to/ros.md)

one of several stations (docs/how-to/stations.md)
  --station NAME[=ID]  NAME alone: this run is the station NAME, and executes its bigActors; with ID, the MAVLink
      system id of a ground station (default: 255, 254, ... in the order of their names); may be repeated
  --peers FILE  a list of the stations (TOML): their addresses and bigActors; they share all observations
  --station-log FILE  the log of this station, from which the others catch up (default: MISSION.STATION.log in this
      folder)

names and cameras
  --name IDENTITY=NAME  the name of a source in the mission: a transponder (mmsi:244660274=drifter0), a vehicle by
      its system id (mavlink:3=uav0) or by its autopilot's serial number (serial:2F003B=uav0); may be repeated
  --camera VEHICLE=SOURCE[,SETTING=VALUE...][,level]  detect regions in the frames of a vehicle's camera, such as
      uav0=rtsp://10.0.0.7/main,fov=78,pitch=-30 or uav0=folder:PATH; the settings are options of
      `bigactors detect`: {", ".join(SETTINGS)}; may be repeated

safety of vehicles
  --fence PLACE = world  the geofence of the vehicles, sent before they are armed: a place of the mission, 'none', or
      'world' (default: the smallest place around all possible places of vehicles, or a box)
  --key FILE  sign messages with the MAVLink 2 key in FILE, and accept only signed ones; FILE also keeps the newest
      time stamps (python -m bigactors.adapters.mavlink.new_key FILE makes one; default: no signing)
  --take-over  also command vehicles that already fly another mission, or an earlier run's

reports of feeds and vehicles
  --within SOUTH,WEST,NORTH,EAST  take only the AIS positions in this box, in degrees (default: all)
  --kinds FEED=KIND,...  take only these kinds from a feed, such as ais=Vessel,BaseStation or detections=OilSpill
      (default: all of AIS; of detections, the mission's kinds that are not driven); may be repeated
  --time-to-live FEED=SECONDS  the seconds for which a position is valid without a newer one; the defaults are
      {", ".join(f"{feed} ({time:.0f})" for feed, time in LIVING.items())}; may be repeated
  --token FILE  accept posted detections only with the token in FILE (Authorization: Bearer ...; default: no token, and
      posts from this machine only)

recording and console
  --record FILE  record the run into FILE (MCAP), and every MAVLink frame into a telemetry log beside it (.tlog)
  --console [[HOST:]PORT]  serve the operator's console in the browser, and print its links; the run begins when an
      operator presses Start (default: on this machine only, port 8765 or a free one)
  --at-once  with --console: begin after the checks, without Start
{SERVING}
  --resume FILE  continue the run in the recording FILE, after a comparison with the vehicles

verdict
  --verdict FILE  the verdict on the mission (default: beside the mission, or in this folder)
  --trust KEY.pub  fly only with a verdict signed by the private key of KEY.pub (check --sign)
  --unverified  fly without a verdict, with a warning

begin, reach and end the run
  --for SECONDS in duration  end the run after SECONDS (default: at the end of the mission)
  --speed TIMES = 1  rehearse TIMES as fast as life: the run and its vehicles, all `simulated`, share one clock
  --wait SECONDS = 60  wait at most SECONDS for a message of every vehicle
  --socket FILE  the socket for `bigactors say`, `hold` and others (default: MISSION.sock in a folder of yours)

{SOURCE}"""


def run(options: Namespace) -> Exit:
    """Fly a mission that has a verdict that everything holds, or with `--unverified`."""
    from bigactors.commands.run.flight import run_mission

    return run_mission(options)
