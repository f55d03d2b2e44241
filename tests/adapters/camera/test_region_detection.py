"""Frames rendered from known polygons: what is found in them, and where."""

import csv
import sys
from collections import Counter

import numpy as np
import pytest

from adapters.camera.frames import frame_of, frames_of
from adapters.camera.libraries import geotiffs, opencv
from adapters.camera.poses import pose_at
from adapters.camera.region_detection import load_detector, sightings
from adapters.camera.sea_projection import Lens, Pose, Projection
from adapters.camera.slick import find_slicks
from adapters.camera.votes import share
from adapters.simulated.camera import render
from bigactors.cli import run
from physical import PhysicalError, circle, polygon, read_geojson
from physical.frame import geod
from physical.shape import planar

pytest.importorskip("cv2")

SPILL = polygon(
    [(37.0005, -8.7012), (37.0012, -8.7003), (37.0008, -8.6992), (36.9999, -8.699), (36.9993, -8.6999)]
)
LAND = polygon([(37.0012, -8.6995), (37.003, -8.6995), (37.003, -8.697), (37.0012, -8.697)])
DOWN = Lens(80)
SIZE = (480, 360)
ABOVE = Pose(0, 37.0002, -8.7, 300, yaw=30)
TILTED = Pose(0, 36.9988, -8.7, 300, roll=-8, pitch=3, yaw=10)
FORWARD = Lens(80, pitch=-60)


def found(pose, lens, spill=SPILL, **light):
    frame = frame_of(render(pose, lens, SIZE, [spill], **light), pose, lens)
    return sightings([frame], Counter())[1]


def metres_off(a, b):
    one, other = planar(a).centroid, planar(b).centroid
    return geod().inv(one.x / 1e7, one.y / 1e7, other.x / 1e7, other.y / 1e7)[2]


@pytest.mark.parametrize(
    ("pose", "lens", "light", "least", "metres"),
    [
        (ABOVE, DOWN, {}, 0.9, 3),
        (ABOVE, DOWN, {"glint": 0.6}, 0.8, 15),
        (ABOVE, DOWN, {"land": LAND}, 0.9, 3),
        (TILTED, FORWARD, {"glint": 0.6}, 0.8, 5),
        (Pose(0, 36.997, -8.7, 300, roll=4), Lens(80, pitch=-30), {}, 0.6, 10),
    ],
    ids=["nadir", "glint", "land", "tilt", "horizon"],
)
def test_the_rendered_spill_is_found_where_it_is(pose, lens, light, least, metres):
    (region,) = found(pose, lens, **light)
    assert share(region.geometry, SPILL) >= least
    assert metres_off(region.geometry, SPILL) < metres
    assert region.whole


def test_nothing_is_found_on_a_sea_with_glint_and_land_alone():
    assert found(ABOVE, DOWN, circle((38, 0), 10), glint=0.6, land=LAND) == ()


def test_a_spill_of_which_a_part_was_in_view_is_said_to_be_a_part():
    (region,) = found(Pose(0, 37.002, -8.7, 300), DOWN)
    assert not region.whole


def test_the_principal_ray_of_a_tilted_camera_meets_the_sea_ahead():
    view = Projection(Pose(0, 37.0, -8.7, 100, yaw=90), Lens(60, pitch=-45), 641, 481)
    latitude, longitude = view.ground(320, 240)
    azimuth, _, metres = geod().inv(-8.7, 37.0, float(longitude), float(latitude))
    assert (azimuth, metres) == (pytest.approx(90, abs=1e-3), pytest.approx(100, abs=1e-3))


def test_what_is_at_the_horizon_is_nowhere():
    view = Projection(Pose(0, 37.0, -8.7, 100), Lens(60, pitch=0), 640, 480)
    latitude, _ = view.ground(np.array([320, 320]), np.array([100, 479]))
    assert np.isnan(latitude).tolist() == [True, False]


def test_a_pose_is_taken_between_two_and_not_across_a_gap():
    log = [Pose(0, 37, -8.7, 100, yaw=350), Pose(1, 37.5, -8.7, 200, yaw=10), Pose(9, 38, -8.7, 200)]
    assert pose_at(log, 0.5) == Pose(0.5, 37.25, pytest.approx(-8.7), 150, 0, 0, 360)
    assert pose_at(log, 5) is None
    assert pose_at(log, 10) is None


@pytest.mark.parametrize("lens", [{"fov": 0}, {"fov": 179}, {"fov": float("nan")}, {"pitch": 100}])
def test_an_absurd_camera_is_refused(lens):
    with pytest.raises(PhysicalError):
        Lens(**lens)


def test_a_detector_is_loaded_by_its_name():
    assert load_detector("adapters.camera.slick:find_slicks") is find_slicks
    with pytest.raises(PhysicalError, match="there is no detector nowhere:f"):
        load_detector("nowhere:f")


def write_flight(folder):
    with (folder / "poses.csv").open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["file", "time", "latitude", "longitude", "altitude", "yaw"])
        rows.writerow(["a.png", 0, ABOVE.latitude, ABOVE.longitude, ABOVE.altitude, ABOVE.yaw])
        rows.writerow(["b.png", 1, ABOVE.latitude, ABOVE.longitude, ABOVE.altitude, ABOVE.yaw])
    picture = opencv().imencode(".png", render(ABOVE, DOWN, SIZE, [SPILL]))[1].tobytes()
    (folder / "a.png").write_bytes(picture)
    (folder / "b.png").write_bytes(picture[:200])
    (folder / "c.png").write_bytes(picture)


def test_a_folder_is_read_and_what_cannot_be_used_is_counted(tmp_path, capsys):
    write_flight(tmp_path)
    target = tmp_path / "x.geojson"
    line = ["detect", str(tmp_path), "--fov=80", f"--output={target}", f"--pictures={tmp_path / 'seen'}"]
    assert run(line) == 0
    said = capsys.readouterr().out
    assert "1 frame, 1 region" in said
    assert "1 frame left out: without a pose" in said
    assert "1 frame left out: unreadable" in said
    (spill,) = read_geojson(target.read_bytes())
    assert (spill.entity, spill.kind) == ("oilSpill0", "OilSpill")
    assert share(spill.geometry, SPILL) >= 0.9
    assert (tmp_path / "seen" / "a.png").is_file()


def test_what_is_no_source_of_frames_is_refused(tmp_path, capsys):
    assert run(["detect", str(tmp_path / "none")]) == 2
    assert run(["detect", str(tmp_path), "--fov=300"]) == 2
    assert "a field of view of 300° is none" in capsys.readouterr().err


def test_a_satellites_picture_brings_its_own_georeference(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    geotiffs()
    image = render(Pose(0, 37, -8.7, 300), DOWN, SIZE, [circle((37, -8.7), 60)])
    affine = rasterio.Affine(2, 0, 526_000, 0, -2, 4_095_000)  # UTM zone 29 N, 2 m to a pixel
    size = {"width": SIZE[0], "height": SIZE[1], "count": 3, "dtype": "uint8"}
    with rasterio.open(
        tmp_path / "s.tif", "w", driver="GTiff", crs="EPSG:32629", transform=affine, **size
    ) as file:
        file.write(np.moveaxis(image[..., ::-1], -1, 0))
    (frame,) = frames_of(tmp_path / "s.tif", DOWN, left_out := Counter())
    (region,) = sightings([frame], Counter())[1]
    centre = planar(region.geometry).centroid
    middle = rasterio.warp.transform("EPSG:32629", "EPSG:4326", [526_000 + SIZE[0]], [4_095_000 - SIZE[1]])
    assert geod().inv(centre.x / 1e7, centre.y / 1e7, middle[0][0], middle[1][0])[2] < 5
    assert not left_out


def test_the_frames_of_a_video_are_merged_and_those_outside_its_log_are_left_out(tmp_path):
    cv2 = opencv()
    video = cv2.VideoWriter(str(tmp_path / "f.avi"), cv2.VideoWriter_fourcc(*"MJPG"), 1, SIZE)
    poses = [Pose(n, 36.9993 + n * 0.0007, -8.7, 300) for n in range(3)]
    for pose in [*poses, poses[-1]]:
        video.write(render(pose, DOWN, SIZE, [circle((37, -8.7), 90)], seed=int(pose.latitude * 1e4)))
    video.release()
    rows = (f"{pose.time},{pose.latitude},{pose.longitude},{pose.altitude}" for pose in poses)
    (tmp_path / "f.csv").write_text("\n".join(["time,latitude,longitude,altitude", *rows]))
    count, (region,) = sightings(frames_of(tmp_path / "f.avi", DOWN, left_out := Counter()), left_out)
    assert (count, left_out) == (3, {"without a pose": 1})
    assert share(region.geometry, circle((37, -8.7), 90)) >= 0.9


def test_a_view_too_wide_for_the_grid_is_left_out_and_counted():
    poses = ABOVE, Pose(0, 37, -8.7, 9_000)
    low, high = (frame_of(render(each, DOWN, SIZE, [SPILL]), each, DOWN) for each in poses)
    count, (region,) = sightings([low, high], left_out := Counter())
    assert (count, left_out) == (1, {"its view is too wide beside the frames before": 1})
    assert share(region.geometry, SPILL) >= 0.9


def test_without_opencv_the_command_that_installs_it_is_said(monkeypatch, tmp_path, capsys):
    write_flight(tmp_path)
    monkeypatch.setitem(sys.modules, "cv2", None)
    opencv.cache_clear()
    try:
        assert run(["detect", str(tmp_path)]) == 2
    finally:
        opencv.cache_clear()
    said = capsys.readouterr().err
    assert "cameras need OpenCV" in said
    assert "pip install" in said


def test_a_detector_that_nobody_declares_is_said(tmp_path, capsys):
    assert run(["detect", str(tmp_path), "--detector=ghost"]) == 2
    assert "there is no detector 'ghost'" in capsys.readouterr().err
