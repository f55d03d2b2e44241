"""Exploring with Ray: every shipped mission with two workers, some with four, and workers that are killed."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from scale import IS_WHOLE
from shipped import UNTIMED

from bigactors.cli import main
from checker import Cluster, ClusterError, Engine, Keeping, Limits, MachineError, check, explore
from checker.engines.cluster import explorer, ray_crew
from specs.elaboration import load_mission

pytestmark = pytest.mark.long

MISSIONS = Path(__file__).parents[4] / "specs" / "missions"
TWO = Cluster(2)
OIL_SPILL = str(MISSIONS / "oil_spill.mission")


@pytest.fixture(scope="module", autouse=True)
def ray():
    """Start Ray once for this module, and end it."""
    ray_crew.connect(TWO)
    library = ray_crew.load_ray()
    yield library
    library.shutdown()


def actors(ray):
    return ray_crew.processes(ray.get_runtime_context().get_node_id(), 2)


def told(report):
    """Return what a report says, but for which of several equally near configurations it shows."""
    verdicts = [
        (
            each.property.name, each.outcome, sorted((v.kind, v.subject, len(v.trace)) for v in each.violations),
            (each.count, each.different, each.examined), each.witness and len(each.witness),
            (each.note, each.remarks),
        )
        for each in report.verdicts
    ]  # fmt: skip
    sizes = (report.configurations, report.transitions, report.allowed, report.depth)
    return (*verdicts, sizes, report.bounds, report.rules, report.coverage)


def compared(name, workers):
    mission = load_mission(name)
    one = check(mission, engine=Engine.FAST)
    other = check(mission, engine=Engine.RAY, cluster=Cluster(workers))
    assert told(other) == told(one), name


@pytest.mark.fuzz
def test_shipped_missions_are_judged_alike_by_two_workers_and_by_one_process():
    assert len(UNTIMED) > 15
    for name in UNTIMED if IS_WHOLE else UNTIMED[::7]:  # six seconds each: workers are started anew
        compared(name, 2)


def test_four_workers_judge_alike():
    for name in ("oil_spill", "takeover"):
        compared(name, 4)


def counted(found):
    return len(found.configurations), found.transitions, found.depth, found.rules, found.bounds


def run_to(found, number):
    return [found.configurations[each] for each in found.path(number)]


@pytest.mark.parametrize("kill", ["the process", "the actor"])
def test_a_worker_that_is_killed_in_the_middle_goes_on_from_its_checkpoint(ray, kill, monkeypatch, tmp_path):
    monkeypatch.setattr(explorer, "ROUND", 64)
    initial = load_mission("rendezvous").initial
    keeping = Keeping(str(tmp_path), every=0.05)
    reports, loaded = [], []
    load = explorer.Expedition.load
    monkeypatch.setattr(
        explorer.Expedition, "load", lambda self, number: loaded.append(number) or load(self, number)
    )

    def kill_one(progress):
        reports.append(progress.configurations)
        if len(reports) == 40:
            assert list(tmp_path.rglob("latest.checkpoint"))
            actor = actors(ray)[1]
            if kill == "the actor":
                ray.kill(actor, no_restart=False)
            else:
                os.kill(ray.get(actor.__ray_call__.remote(lambda _: os.getpid())), signal.SIGKILL)

    undisturbed = explore(initial, engine=Engine.RAY, cluster=TWO)
    found = explore(initial, report=kill_one, every=0.0, engine=Engine.RAY, keeping=keeping, cluster=TWO)
    assert 1_000 < reports[39] < 17_000
    assert len(loaded) == 1
    assert loaded[0] > 0
    assert counted(found) == counted(undisturbed)
    for number in (18_050, 9_000):
        assert len(run_to(found, number)) == len(run_to(undisturbed, number))


def test_what_was_found_is_had_again_when_a_worker_is_killed_afterwards(ray):
    initial = load_mission("surveillance").initial
    found = explore(initial, engine=Engine.RAY, cluster=TWO)
    before = list(found.configurations)
    ray.kill(actors(ray)[0], no_restart=False)
    assert list(found.configurations) == before


def test_ray_listens_on_the_loopback_address_alone(ray):
    assert ray.util.get_node_ip_address() == "127.0.0.1"
    assert os.environ["RAY_USAGE_STATS_ENABLED"] == "0"
    assert "RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER" not in os.environ, (
        "clusters of several machines would be refused"
    )
    listening = set()
    for table in ("tcp", "tcp6"):
        lines = Path(f"/proc/net/{table}").read_text().splitlines()[1:]
        listening |= {
            tuple(line.split()[index] for index in (1, 9)) for line in lines if line.split()[3] == "0A"
        }
    ours = {inode for process in processes_of(ray) for inode in sockets_of(process)}
    addresses = [address for address, inode in listening if inode in ours]
    assert addresses
    assert {address.split(":")[0][-8:] for address in addresses} == {"0100007F"}


def processes_of(ray):
    """Return the processes of this one's Ray cluster."""
    session = ray._private.worker._global_node.get_session_dir_path()
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if session.encode() in (process / "cmdline").read_bytes():
                yield process
        except OSError:
            continue


def sockets_of(process):
    try:
        links = [str(each.readlink()) for each in (process / "fd").iterdir()]
    except OSError:
        return []
    return [link[len("socket:[") : -1] for link in links if link.startswith("socket:[")]


def test_the_command_line_explores_with_ray(capsys):
    path = OIL_SPILL
    assert main(["check", "--no-traces", "--engine", "ray", "--workers", "2", path]) == main(
        ["check", "--no-traces", "--engine", "fast", path]
    )
    reports = capsys.readouterr().out
    assert reports.count("34 configurations, 74 transitions") == 2


def test_a_damaged_checkpoint_is_a_mistake(tmp_path, capsys):
    line = ["check", "--no-traces", "--engine", "ray", "--checkpoint", str(tmp_path), OIL_SPILL]
    main(line)
    [path] = tmp_path.rglob("shard-*-1.checkpoint")
    path.write_bytes(b"no archive")
    assert main([*line, "--resume"]) == 2
    told = capsys.readouterr().err
    assert f"{path}: this is no checkpoint" in told
    assert "Traceback" not in told


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--workers", "2"], "--workers and --address work with the Ray engine only"),
        (["--engine", "ray", "--workers", "1"], "takes 2 to 256 workers; one is --engine fast"),
    ],
)
def test_what_does_not_fit_together_is_a_mistake(options, words, capsys):
    assert main(["check", *options, OIL_SPILL]) == 2
    assert words in capsys.readouterr().err


def test_without_ray_it_is_said_how_to_have_it(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "ray", None)
    assert main(["check", "--engine", "ray", OIL_SPILL]) == 2
    assert "pip install '.[cluster]'" in capsys.readouterr().err


def test_a_cluster_that_does_not_start_is_the_machines_fault(tmp_path):
    file = tmp_path / "no_folder"
    file.touch()
    ran = subprocess.run(
        [sys.executable, "-m", "bigactors", "check", "--engine", "ray", OIL_SPILL],
        check=False,
        env={**os.environ, "RAY_TMPDIR": str(file)},
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 3
    assert "no Ray cluster could be started here: " in ran.stderr
    assert "hint: try again when less else runs here, or leave --engine out" in ran.stderr


def test_a_cluster_that_is_not_up_in_time_is_the_machines_fault(monkeypatch):
    def late(**_):  # as Ray does, half a minute after it has begun
        raise Exception("The current node timed out during startup.")

    monkeypatch.setattr(ray_crew, "load_ray", lambda: SimpleNamespace(is_initialized=bool, init=late))
    with pytest.raises(
        MachineError, match="no Ray cluster could be started here: The current node timed out"
    ):
        ray_crew.connect(TWO)


def test_machines_with_another_checker_are_refused(monkeypatch):
    monkeypatch.setattr(ray_crew, "edition", lambda: "another")
    with pytest.raises(ClusterError, match="install the same on all"):
        explore(load_mission("oil_spill").initial, engine=Engine.RAY, cluster=TWO)


def test_what_is_compared_between_machines_is_every_room_that_explores():
    assert {name.split("/")[0] for name in ray_crew.modules()} == set(ray_crew.ROOMS)


def test_a_limit_is_met_by_workers_too():
    initial = load_mission("takeover").initial
    found = explore(initial, limits=Limits(configurations=100), engine=Engine.RAY, cluster=TWO)
    assert (len(found.configurations), *map(str, found.bounds)) == (100, "the limit of 100 configurations")
