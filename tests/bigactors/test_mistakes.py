"""What the command line refuses, each with the place, the cause or the remedy that it names."""

import shlex
import tempfile
from pathlib import Path

import pytest
from test_big import DECAY, WALK
from test_big_convert import ROOMS
from test_station_flight import PEERS
from test_world import write_harbour
from text_tables import rows
from written_missions import TEXTS

from bigactors.cli import main

REFUSED = r"""
check oil_spil  # oil_spil: there is no such file\n  hint: did you mean 'oil_spill'?
check --watch oil_spil  # oil_spil: there is no such file\n  hint: did you mean 'oil_spill'?
check .  # .: this is a folder, not a mission
check --watch --json - holds.mission  # --watch prints its reports
check --trace race.mission holds.mission  # race.mission: there is a file where a folder should be
check race.mission --engine reference --paranoid 1  # --paranoid works with the fast and Ray engines
check race.mission --engine reference --checkpoint there  # --checkpoint works with the fast and Ray engines only
check race.mission --hash-compact 32  # it is gone, since a configuration takes some 24 bytes: --max-memory
check race.mission --spill there  # --spill needs a limit on memory
check race.mission --spill there --max-memory 1G --engine reference  # --spill works with the fast and Ray engines only
check race.mission --spill holds.mission --max-memory 1G  # there is a file where a folder should be
check oil_spill --reduce por --scheduler fcfs  # 'por' is refused: under 'scheduler fcfs'
check rendezvous --reduce symmetry  # the reduction 'symmetry' is refused: nothing in the mission is
check handover --reduce por,symmetry  # the reduction 'symmetry' is refused: 'display' prints names
check oil_spill --reduce magic  # 'magic' is none of por, symmetry
check x --max-configurations 0  # '0' is not a whole number from 1
check x --max-configurations many  # 'many' is not a whole number from 1
check x --max-time -3  # '-3' is not a number of seconds above 0
check x --max-time nan  # 'nan' is not a number of seconds above 0
simulate x --seed 1e9  # '1e9' is not a whole number from 0
world x --within 1,2,3  # '1,2,3' is no box
world x --at noon  # 'noon' is no time
check  # FILE
check x --json=  # the name of a file is missing
fmt --check --stdout x  # not allowed with
chekc x  # bigactors: unknown command 'chekc'\n  hint: did you mean 'check'?
check x.mission --jsn=-  # bigactors: unknown option '--jsn=-'\n  hint: did you mean '--json'?
say a home now  # 'now' is one argument too many
check x.mission --no-tr  # unknown option '--no-tr'
check holds.mission --output sarrif:x  # bigactors: argument --output: unknown format 'sarrif': did you mean 'sarif'?
check holds.mission --output html:x
    # bigactors: argument --output: unknown format 'html': the formats are json, junit, sarif, github
check holds.mission --output junit  # bigactors: argument --output: 'junit' is not FORMAT:FILE, such as junit:report
check holds.mission --output junit:no/such/folder.xml  # no/such/folder.xml: there is no such folder
check holds.mission --output sarif:.  # .: this is a folder, not a file
check holds.mission --output 'sarif:a\0b'  # 'a\x00b': this is no path of a file
check holds.mission --output junit:- --output sarif:-
    # bigactors: junit and sarif cannot both go to the standard output
check holds.mission --json - --output github:-  # bigactors: json and github cannot both go to the standard output
check holds.mission --output junit:x --output sarif:./x  # bigactors: junit and sarif cannot both go to ./x
show --trace run.json --step 9  # there is no c9: the trace ends with c8
show holds.mission --step 2  # --step is a step of a trace
show  # there is nothing to show
show holds.mission --output picture.gif  # picture.gif
show holds.mission --output no/such/folder.svg  # no/such/folder.svg: No such file or directory
show holds.mission --lanes  # --lanes shows a trace
show holds.mission --against x.json  # --against is for two traces
show holds.mission --output tracks.geojson  # tracks are those of a trace
show --trace run.json --step 2 --output tracks.geojson  # tracks are those of a whole trace
replay run.json --speed 0  # argument --speed: '0' is not a number above 0
console holds.mission
    # holds.mission: this is no recording: it does not begin as MCAP\n  hint: give a recording that run --record wrote
replay nowhere.json  # nowhere.json: No such file or directory
replay run.json --waypoints uav0=x.txt  # a route is written as one of .plan, .waypoints
replay run.json --waypoints uav9=x.plan  # the mission has no entity 'uav9'\n  hint: the only vehicle is uav0
replay run.json --waypoints base0=x.plan  # nothing sends 'base0' anywhere
replay run.json --waypoints uav0  # is not VEHICLE=FILE
simulate handover --choose --json -  # --choose talks on standard output
export --format tchecker oil_spill  # oil_spill has no times
export --format tchecker endurance --property endurence  # did you mean 'endurance'?
export --format tchecker endurance --property bogus  # hint: the properties are computation, deadlock_freedom, endurance
export --format tchecker endurance --property race_freedom  # only deadlines and endurance are exported
show oil_spill --timeline  # write a section timing
show race_in_time --timeline --trace t.json  # --lanes shows the dates of one run
world harbour.geojson harbour.geojson  # harbour0 is in harbour.geojson too
world harbour.geojson --kinds Ship  # nothing is of kind 'Ship'
world harbour.geojson --at 2020-01-01  # --at is a time of a recording
world harbour.geojson --within 99,0,98,1  # --within:
world nowhere.geojson  # nowhere.geojson: No such file
world nowhere.nmea  # nowhere.nmea:
world harbour.geojson --output world.gif  # world.gif:
world holds.mission  # is an AIS sentence
world bad.plan  # bad.plan:
world bad.waypoints  # bad.waypoints: line 2: 1 columns where 12 were expected
world harbour.geojson --within -10,-100,10,100  # --within: from longitude
world harbour.geojson --within -10,-170,10,170  # --within: from longitude
world harbour.geojson --within -10,100,10,-60  # --within: from longitude
studio --port 99999  # --port: '99999' is no port: a whole number to 65535
studio --port x  # --port: 'x' is no port
studio none/x.mission  # none: there is no such folder
check walk.big  # bigactors big check walk.big
explain LS999  # bigactors: there is no code and no word 'LS999'\n  hint: bigactors explain lists them all
explain Fairness  #   hint: bigactors explain weak fairness or bigactors explain strong fairness
explain deadlok  # bigactors: there is no code and no word 'deadlok'\n  hint: did you mean 'deadlock'?
check --sign own.key oil_spill  # --sign signs a verdict
run oil_spill --vehicle=uav0=udp:127.0.0.1:0 --unverified --trust own.key.pub  # --trust for a signed one
check --verdict v oil_spill handover  # one mission
run oil_spill --unverified  # no address: uav0\n  hint: give its address: --vehicle uav0=udp:127.0.0.1:14550, or
run oil_spill --unverified --vehicle=uav9=udp:127.0.0.1:0  # no entity 'uav9'\n  hint: the only vehicle is uav0
run oil_spill --unverified --vehicle=gcs0=udp:127.0.0.1:0  # 'gcs0' is no vehicle
run oil_spill --unverified --vehicle=uav0=carrier-pigeon  # no way to connect
run oil_spill --unverified --vehicle=uav0=udp:127.0.0.1:0 --feed=radar=udp:1  # no feed 'radar'
run oil_spill --unverified --vehicle=uav0=udp:127.0.0.1:0 --feed=ais=file:  # no path
run oil_spill --unverified --vehicle=uav0=udp:127.0.0.1:0 --station=gcs9=3  # no channel 'control:gcs9'
run oil_spill --unverified --vehicle=uav0=udp:127.0.0.1:0 --name=mmsi:1=a --name=mmsi:2=a  # would be called a
run oil_spill --unverified --vehicle=uav0=udp:127.0.0.1:0 --resume=nowhere.mcap  # No such file
run oil_spill --unverified --vehicle=uav0=udp:127.0.0.1:0 --record=nowhere/run.mcap  # there is no such folder
run oil_spill --unverified --vehicle=uav0=udp:127.0.0.1:0 --record=.  # this is a folder, not a file
run oil_spill --unverified --vehicle=uav0=udp:127.0.0.1:0 --record=/  # this is a folder, not a file
run oil_spill --unverified --vehicle=uav0=udp:127.0.0.1:0 --record=run.tlog  # the telemetry log is called so
run oil_spill --unverified --vehicle=uav0  # not NAME[:ID]=ADDRESS
run distributed_handover --unverified --station=gcs0  # give them: --peers FILE
run distributed_handover --unverified --peers=peers.toml  # the name of this station is not given
run distributed_handover --unverified --station=gcs0 --station=gcs1 --peers=peers.toml  # not gcs0 and gcs1
run distributed_handover --unverified --station=gcs9 --peers=peers.toml
    # no station 'gcs9': its stations are gcs0, gcs1, gcs2
run distributed_handover --unverified --station=gcs0 --peers=nowhere.toml  # No such file
run distributed_handover --unverified --station=gcs0=300  # ids are from 1 to 255
run spill_watch --vehicle=uav0=udp:127.0.0.1:0 --kinds=OilSpill  # is not FEED=
run spill_watch --vehicle=uav0=udp:127.0.0.1:0 --kinds=radar=x  # is not FEED=
run spill_watch --vehicle=uav0=udp:127.0.0.1:0 --time-to-live=ais  # is not FEED=
run spill_watch --vehicle=uav0=udp:127.0.0.1:0 --time-to-live=x=1  # is not FEED=
say op go  # no mission runs here
say op go --socket=s  # no mission runs at s
give-back uav0  # no mission runs here
give-back uav0 --socket=s  # no mission runs at s
hold uav0  # no mission runs here
hold uav0 --socket=s  # no mission runs at s
return --all --by Ana  # no mission runs here
return --all --by Ana --socket=s  # no mission runs at s
status  # no mission runs here
status --socket=s  # no mission runs at s
hold uav0 --by 'a\nb'  # --by has to be a name of 1 to 200 characters that can be printed
big check --never crowds walk.big  # unknown predicate 'crowds'
big check walk.big  # there is nothing to check
big show --state 9 walk.big  # there is no state 9: there are 4
big sim --plot x.svg walk.big  # give --runs
big sim --runs 3 --plot x.pdf walk.big  # an .svg or a .png
big sim --runs 3 --plot none/x.svg walk.big  # no such folder
big sim --runs 0 walk.big  # --runs
big sim --until 3 walk.big  # only an sbrs has times
big full --html no/where.html walk.big  # there is no such folder
big full nothing.big  # No such file
big full --const k decay.big  # is not NAME=VALUE
big fulll walk.big  # invalid choice
big convert rooms.big x.json  # give OUT the ending .big
big convert rooms.big x.big --to big  # it is gone with XMI: BigraphER's language is written
big convert rooms.text x.big  # give --from big or bgm
big convert nowhere.text x.big  # 'nowhere.text' cannot be read
big convert rooms.big x.big --from bgm  # rooms.big:1:
big convert rooms.big x.big --from bgm --const n=1  # a .bgm file has no constants
big convert rooms.big nowhere/x.big  # there is no such folder
run spill_watch --unverified --vehicle=uav0:4=udp:1 --name=mavlink:3=uav0  # 'uav0' has two system ids: 4 and 3
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --name=mavlink:300=uav0  # 'mavlink:300' is no system id
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 '--name=mavlink:²=uav0'  # 'mavlink:²' is no system id
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --name=mavlink:3=uav0 --name=serial:2F=uav0
    # would be called uav0, as serial:2F is
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --name=mmsi:263999001=uav0
    # mmsi:263999001 would be called uav0, as vehicle:uav0 is
run spill_watch --unverified --vehicle=uav0:3=udp:1 --name=mmsi:263999001=uav0
    # would be called uav0, as mavlink:3 is
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --name=name:camera=searchArea0
    # name:camera would be called searchArea0, as place:searchArea0
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --vehicle=uav0=udp:2  # 'uav0' is given twice
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --kinds=detections=OilSpil
    # no kind 'OilSpil' that could be detected
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --feed=ais=udp:1 --kinds=ais=OilSpill
    # no station is of kind 'OilSpill'
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --feed=detections=http:0.0.0.0:0
    # anyone who reaches 0.0.0.0 could post detections
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --feed=detections=http:0 --token=nowhere  # No such file
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --key=nowhere.json  # cannot read the signing key
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --fence=uav0  # 'uav0' is no fence
run spill_watch --unverified --vehicle=uav0=udp:127.0.0.1:0 --within=99,0,98,1  # latitude
run oil_spill --vehicle=uav0=udp:127.0.0.1:0  # no verdict
run oil_spill --vehicle=uav0=udp:127.0.0.1:0
    # bigactors check --control timed --verdict oil_spill.verdict.json oil_spill
run oil_spill --unverified --vehicle=uav0=udp:192.0.2.1:14550
    # this machine has no such address: give one that it has, or 0.0.0.0 for all
new holds  # holds.mission: it exists already, and is left as it is
new nowhere/patrol  # nowhere/patrol.mission: there is no such folder
new 2nd  # '2nd' is no name
new 'a b'  # 'a b' is no name
new ''  # the name of a file is missing
new world  # 'world' is a word of the language
new 'a\0b'  # is no name
"""
FILES = {
    **{f"{name}.mission": text for name, text in TEXTS.items()},
    "bad.plan": "{",
    "bad.waypoints": "QGC WPL 110\n1\n",
    "decay.big": DECAY,
    "peers.toml": PEERS,
    "rooms.big": ROOMS,
    "rooms.text": ROOMS,
    "walk.big": WALK,
}


@pytest.fixture(scope="module")
def folder():
    """A folder of a short name: the path of a socket has at most 100 bytes."""
    with tempfile.TemporaryDirectory() as name, pytest.MonkeyPatch.context() as patch:
        patch.chdir(name)
        patch.setenv("XDG_RUNTIME_DIR", str(Path(name) / "runtime"))
        Path("runtime").mkdir(mode=0o700)
        for file, text in FILES.items():
            Path(file).write_text(text, encoding="utf-8")
        write_harbour(Path())
        assert main(["simulate", "holds.mission", "--seed", "3", "--json", "run.json"]) == 0
        yield files()


def files():
    return {path: path.read_bytes() for path in Path().iterdir() if path.is_file()}


@pytest.mark.parametrize(("line", "said"), list(rows(REFUSED)))
def test_what_cannot_be_done_is_told_and_nothing_is_written(folder, bigactors, line, said):
    code, _, err = bigactors(*shlex.split(line))
    assert (code, "Traceback" in err) == (2, False)
    assert said in err
    assert files() == folder
