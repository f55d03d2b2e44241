"""Exploring on two machines: two network namespaces of this one, with a cable between them and a Ray node in each."""

import json
import os
import secrets
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from checker import Engine, explore
from specs.elaboration import load_mission

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[4]
MISSION = ROOT / "specs" / "missions" / "rendezvous.mission"
HEAD, OTHER = "10.77.0.1", "10.77.0.2"
PORT = 20_000 + os.getpid() % 10_000  # Ray looks for heads with the same address among all processes
PATIENCE = 120.0

EXPLORE = """
import json, os, signal, sys, time
from checker import Cluster, Engine, Keeping, explore
from checker.engines.cluster import explorer, ray_crew
from specs.elaboration import load_mission

mission, address, folder = sys.argv[1:]
explorer.ROUND = 64
ray_crew.connect(Cluster(2, address))
ray, deadline = ray_crew.load_ray(), time.monotonic() + 30.0
while sum(each["Alive"] for each in ray.nodes()) < 2 and time.monotonic() < deadline:  # it has just begun
    time.sleep(0.1)
def ask(actor):
    return ray.get(actor.__ray_call__.remote(lambda _: (ray.util.get_node_ip_address(), os.getpid())))
for attempt in range(30):  # Ray decides where actors are: at times it puts both on one machine
    actors = ray_crew.processes(ray.get_runtime_context().get_node_id(), 2)
    places, reports = [ask(actor)[0] for actor in actors], []
    if len(set(places)) == 2:
        break
    for actor in actors:
        ray.kill(actor)
    ray_crew.processes.cache_clear()
def kill_the_other(progress):
    reports.append(progress.configurations)
    if folder and len(reports) == 40:
        os.kill(next(process for host, process in map(ask, actors) if host != "10.77.0.1"), signal.SIGKILL)
found = explore(
    load_mission(mission).initial, engine=Engine.RAY, cluster=Cluster(2, address), report=kill_the_other,
    every=0.0, keeping=Keeping(folder, every=0.05) if folder else None,
)
counts = len(found.configurations), found.transitions, found.depth, len(found.path(18_050))
print(json.dumps([places, [ask(actor)[0] for actor in actors], len(reports), counts]))
"""


def run(*line):
    return subprocess.run(line, check=True, capture_output=True, text=True, timeout=PATIENCE)


@pytest.fixture(scope="module")
def machines():
    """Return the names of two namespaces that are linked, the first with the head of a Ray cluster."""
    if shutil.which("ip") is None or os.geteuid():
        pytest.skip("network namespaces are made by root, with the command ip")
    names = [f"machine{number}-{os.getpid()}" for number in (1, 2)]
    try:
        run("ip", "netns", "add", names[0])
    except subprocess.CalledProcessError as error:
        pytest.skip(f"no network namespaces here: {error.stderr.strip()}")
    folder = tempfile.mkdtemp(prefix="ray-")  # a short path: sockets are in it
    try:
        run("ip", "netns", "add", names[1])
        run(
            *["ip", "link", "add", "cable", "netns"],
            names[0],
            *["type", "veth", "peer", "cable", "netns"],
            names[1],
        )
        for name, host in zip(names, (HEAD, OTHER), strict=True):
            run("ip", "-n", name, "address", "add", f"{host}/24", "dev", "cable")
            for link in ("lo", "cable"):
                run("ip", "-n", name, "link", "set", link, "up")
        ALIKE["RAY_TMPDIR"] = folder
        start(
            names[0], "--head", "--port", str(PORT), "--node-ip-address", HEAD, "--include-dashboard", "false"
        )
        start(names[1], "--address", f"{HEAD}:{PORT}", "--node-ip-address", OTHER)
        yield names
    finally:
        for name in names:
            switch_off(name)
        shutil.rmtree(folder)


ALIKE = {
    "RAY_AUTH_MODE": "token",
    "RAY_AUTH_TOKEN": secrets.token_hex(),
    "RAY_USAGE_STATS_ENABLED": "0",
    "PYTHONPATH": str(ROOT),
}
"""What is the same in the environments of both machines."""


def inside(name, *line):
    """Return what runs a command on a machine, and in which environment."""
    return ("ip", "netns", "exec", name, *map(str, line)), os.environ | ALIKE


def start(name, *options):
    line, at = inside(
        name, Path(sys.executable).with_name("ray"), "start", "--num-cpus", "1", "--object-store-memory", "100000000",
        "--disable-usage-stats", *options,
    )  # fmt: skip
    started = subprocess.run(line, check=False, env=at, capture_output=True, text=True, timeout=PATIENCE)
    assert started.returncode == 0, started.stdout + started.stderr


def switch_off(name):
    """End all that runs in a namespace, and the namespace."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        found = subprocess.run(
            ["ip", "netns", "pids", name], check=False, capture_output=True, text=True
        ).stdout.split()
        if not found:
            break
        for process in map(int, found):
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                continue
        time.sleep(0.1)
    subprocess.run(["ip", "netns", "delete", name], check=False, capture_output=True)


@pytest.mark.parametrize("is_killed", [False, True])
def test_two_machines_explore_what_one_process_does_even_if_a_worker_is_killed(machines, tmp_path, is_killed):
    line, at = inside(
        machines[0], sys.executable, "-c", EXPLORE, MISSION, f"{HEAD}:{PORT}", tmp_path if is_killed else ""
    )  # fmt: skip
    ran = subprocess.run(line, check=False, env=at, capture_output=True, text=True, timeout=PATIENCE)
    assert ran.returncode == 0, ran.stderr
    places, places_after, reports, counts = json.loads(ran.stdout.splitlines()[-1])
    assert sorted(places) == [HEAD, OTHER], ran.stderr
    assert HEAD in places_after
    assert reports > 40
    alone = explore(load_mission(MISSION).initial, engine=Engine.FAST)
    assert tuple(counts[:3]) == (len(alone.configurations), alone.transitions, alone.depth)
    assert counts[3] <= alone.depth + 1
