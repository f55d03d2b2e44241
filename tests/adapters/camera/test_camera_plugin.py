"""A camera in flight: frames that come while a vehicle flies, and what of them is published."""

import asyncio
import math
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from itertools import cycle

import pytest
from worlds import World, until

from adapters.camera.camera_plugin import Camera, CameraFeed
from adapters.camera.libraries import opencv
from adapters.camera.poses import PoseLog
from adapters.camera.sea_projection import Lens, Pose
from adapters.camera.sources import Folder, Stream, source_of
from adapters.camera.votes import share
from adapters.plugin import Aged, Gone, Trouble
from adapters.simulated.camera import render
from bigactors.arguments.values import camera
from bigactors.cli import run
from physical import circle

pytest.importorskip("cv2")

SPILL = circle((37.0, -8.7), 120.0)
LENS = Lens(80)
SIZE = (240, 180)
BEGIN = 1_795_000_000.0


class Sky(World):
    """A world whose time a test sets, with a vehicle whose pose its messages tell."""

    def __init__(self):
        super().__init__()
        self.time, self.poses = BEGIN, PoseLog()

    def now(self):
        return self.time

    def fly(self, pose, until):
        """Let the vehicle be at a pose from now to a time."""
        while self.time < until:
            self.time += 0.5
            north, east = round(pose.latitude * 1e7), round(pose.longitude * 1e7)
            where = {"lat": north, "lon": east, "alt": round(pose.altitude * 1000)}
            self.poses.hear("GLOBAL_POSITION_INT", where, self.time)
            angles = {"roll": pose.roll, "pitch": pose.pitch, "yaw": pose.yaw}
            self.poses.hear("ATTITUDE", {name: math.radians(a) for name, a in angles.items()}, self.time)

    def troubles(self):
        return {each.what: each.detail for each in self.of(Trouble)}


def picture(pose, slicks=(SPILL,), seed=1):
    return opencv().imencode(".png", render(pose, LENS, SIZE, list(slicks), seed=seed))[1].tobytes()


def above(latitude=37.0, longitude=-8.7, **angles):
    return Pose(0, latitude, longitude, 300.0, **angles)


async def looked(sky, feed, done):
    """Let a feed run until something is so."""
    running = asyncio.ensure_future(feed.run(sky))
    try:
        for _ in range(300):
            if done():
                return
            assert not running.done(), running.exception()
            await asyncio.sleep(0.05)
        raise AssertionError(f"it did not come: {sky.reports}")
    finally:
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)


def put(folder, time, data):
    (folder / "part").write_bytes(data)
    (folder / "part").rename(folder / f"{time:.3f}.png")


async def test_what_a_camera_sees_is_published_under_a_name_that_it_keeps(tmp_path):
    sky = Sky()
    camera_ = Camera("uav0", LENS)
    feed = CameraFeed("camera1", camera_, Folder(tmp_path), sky.poses, time_to_live=100.0)
    other = circle((37.02, -8.7), 90.0)

    async def flown():
        await asyncio.sleep(0)  # let the feed begin
        for pose, slicks in (
            (above(roll=12, yaw=30), [SPILL]),
            (above(yaw=70), [SPILL]),
            (above(37.02), [other]),
        ):
            begin = sky.time
            sky.fly(pose, begin + 60)
            put(tmp_path, begin + 30, picture(pose, slicks, seed=int(begin)))
            before = len(sky.published)
            await until(lambda before=before: len(sky.published) > before, 10)

    put(tmp_path, BEGIN, picture(above()))  # of before: it is passed over
    await looked(sky, feed, asyncio.ensure_future(flown()).done)
    found = [each.property for each in sky.published]
    assert [each.entity for each in found] == ["oilSpill0", "oilSpill0", "oilSpill0", "oilSpill1"]
    assert {(each.kind, each.source) for each in found} == {("OilSpill", "camera1")}
    assert share(found[0].geometry, SPILL) >= 0.9
    assert found[1].geometry is found[0].geometry  # it is the same, and is seen again
    assert share(found[3].geometry, other) >= 0.85
    assert sky.published[0].time_to_live == 100.0


async def test_what_later_frames_contradict_is_withdrawn_and_published_again_when_they_show_it(tmp_path):
    sky = Sky()
    feed = CameraFeed("camera1", Camera("uav0", LENS), Folder(tmp_path), sky.poses)

    def shown(slicks, is_reached):
        def done():
            sky.fly(above(), sky.time + 4)
            put(tmp_path, sky.time - 2, picture(above(), slicks, seed=int(sky.time)))
            return sky.published and is_reached(sky.published[-1])

        return done

    await looked(sky, feed, shown([SPILL], lambda each: isinstance(each, Aged)))
    await looked(sky, feed, shown([], lambda each: isinstance(each, Gone)))
    assert sky.published[-1].entity == "oilSpill0"
    await looked(sky, feed, shown([SPILL], lambda each: isinstance(each, Aged)))
    assert [type(each) for each in sky.published] == [Aged, Gone, Aged]
    assert sky.published[-1].property.entity == "oilSpill0"


async def test_a_frame_whose_pose_is_not_known_is_left_out_and_told(tmp_path):
    sky = Sky()
    feed = CameraFeed("camera1", Camera("uav0", LENS), Folder(tmp_path), sky.poses)

    def done():
        put(tmp_path, BEGIN - 100, picture(above()))
        return "frame left out" in sky.troubles()

    await looked(sky, feed, done)
    assert sky.troubles()["frame left out"] == "the position and attitude of uav0 are not known"
    assert sky.published == []


async def test_neither_what_is_no_picture_nor_a_detector_that_fails_ends_the_camera(tmp_path):
    def broken(frame):
        raise ZeroDivisionError(f"on {frame.image.shape}")

    sky = Sky()
    camera_ = Camera("uav0", LENS, detector=broken)
    feed = CameraFeed("camera1", camera_, Folder(tmp_path), sky.poses)
    shown = cycle([picture(above()), b"no picture"])

    def done():
        sky.fly(above(), sky.time + 4)
        put(tmp_path, sky.time - 2, next(shown))
        return len({report.detail for report in sky.reports}) > 1

    await looked(sky, feed, done)
    details = {report.detail.partition(":")[2] or report.detail for report in sky.reports}
    assert " ZeroDivisionError: on (180, 240, 3)" in details
    assert "this is no picture that can be decoded" in details


async def test_a_stream_is_read_by_its_address_and_tried_again_when_it_is_lost():
    frames = [picture(above(), seed=seed) for seed in range(2)]

    class Filming(BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
            self.end_headers()
            for number in range(40):
                cv2 = opencv()
                jpeg = cv2.imencode(".jpg", cv2.imdecode(_bytes(frames[number % 2]), 1))[1].tobytes()
                head = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
                self.wfile.write(head.encode() + jpeg + b"\r\n")

        def log_message(self, *_):
            """Say nothing."""

    server = HTTPServer(("127.0.0.1", 0), Filming)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    stream = source_of(f"http://me:secret@127.0.0.1:{server.server_address[1]}/video.mjpg")
    assert isinstance(stream, Stream)
    stream.begin()
    try:
        shots = await until(lambda: stream.taken(BEGIN), 10)
        assert shots[0].pixels().shape == (180, 240, 3)
        assert BEGIN - 5 < shots[0].time <= BEGIN
        server.shutdown()
        server.server_close()
        await until(lambda: "cannot be opened" in stream.trouble(), 10)
        assert stream.trouble().startswith("http://127.0.0.1:")  # without the password
    finally:
        stream.end()


def _bytes(data):
    import numpy as np  # noqa: PLC0415 - with the extra

    return np.frombuffer(data, np.uint8)


def test_a_pose_between_messages_is_known_and_one_after_them_is_not():
    sky = Sky()
    sky.fly(above(yaw=350), BEGIN + 1)
    sky.fly(above(37.001, yaw=10), BEGIN + 1.5)
    pose = sky.poses.at(BEGIN + 1.25)
    assert (pose.latitude, pose.longitude, pose.altitude) == pytest.approx((37.0005, -8.7, 300.0))
    assert math.remainder(pose.yaw, 360) == pytest.approx(0.0, abs=1e-9)
    assert sky.poses.at(BEGIN + 2) is None
    assert sky.poses.until == BEGIN + 1.5
    sky.poses.hear("ATTITUDE", {"roll": math.nan, "pitch": 0.0, "yaw": 0.0}, BEGIN + 2)
    assert sky.poses.until == BEGIN + 1.5


def test_the_settings_of_a_camera_are_read_from_the_end_of_its_address():
    found = camera("uav0=rtsp://10.0.0.7/live?a=1,2,fov=78,pitch=-30,every=0.5,level,name=slick")
    assert (found.source, found.fov, found.pitch, found.every) == ("rtsp://10.0.0.7/live?a=1,2", 78, -30, 0.5)
    assert (found.level, found.name, found.kind, found.delay) == (True, "slick", "OilSpill", 0.0)


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("uav0", "'uav0' is no camera: write VEHICLE=SOURCE"),
        ("uav0=folder:x,zoom=3", "'zoom' is no setting of a camera"),
        ("uav0=folder:x,fov=wide", "fov=wide is no angle in degrees"),
        ("uav7=folder:x", "'uav7' carries a camera, but its address is not given"),
        ("uav0=folder:x,kind=UAV", "'UAV' is no kind of the mission that a camera could find"),
        ("uav0=folder:x,detector=nowhere:find", "there is no detector nowhere:find"),
        ("uav0=folder:x,fov=300", "a field of view of 300° is none"),
    ],
)
def test_a_camera_that_cannot_look_is_told_before_anything_flies(word, said, capsys):
    words = ["run", "spill_watch", "--vehicle=uav0=udp:127.0.0.1:0", "--unverified", f"--camera={word}"]
    assert run(words) == 2
    assert said in capsys.readouterr().err
