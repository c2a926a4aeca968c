"""Camera files: what is written is read back, and other programs' own readers agree."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.formats.cameras import read_cameras, write_cameras
from imitation.cameras import CameraPath
from imitation.errors import InputError

SIZE = (640, 360)


def cameras(seed: int, frames: int = 12, *, zoom: bool = False, seen: bool = True) -> CameraPath:
    """Cameras in all directions, with points and exact observations."""
    random = np.random.default_rng(seed)
    focal = 500 + 40 * random.random() * (np.arange(frames) if zoom else np.ones(frames))
    K = np.tile(np.array([[1.0, 0, 319.5 + random.normal()], [0, 1.0, 179.5], [0, 0, 1]]), (frames, 1, 1))
    K[:, 0, 0], K[:, 1, 1] = focal, focal * 1.01
    R = Rotation.random(frames, rng=random).as_matrix()
    T = random.normal(size=(frames, 3)) + np.array([0, 0, 4.0])
    points = random.normal(size=(20, 3)) if seen else np.zeros((0, 3))
    rows, which = [], []
    if seen:
        for frame in range(frames):
            local = points @ R[frame].T + T[frame]
            for place in np.flatnonzero(local[:, 2] > 0.5)[::2]:
                pixel = K[frame] @ local[place] / local[place, 2]
                rows.append((frame, *pixel[:2]))
                which.append(place)
    return CameraPath(
        K=K,
        R=R,
        T=T,
        points=points,
        observations=np.array(rows).reshape(-1, 3),
        observed=np.array(which, np.int32),
    )


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000), st.booleans(), st.booleans(), st.sampled_from(["text", "binary", "json"]))
def test_what_is_written_is_read_back(
    tmp_path_factory: pytest.TempPathFactory, seed: int, zoom: bool, seen: bool, form: str
) -> None:
    """Intrinsics, poses, points and observations survive every form to rounding."""
    folder = tmp_path_factory.mktemp("cameras")
    path = cameras(seed, zoom=zoom, seen=seen)
    target = folder / "transforms.json" if form == "json" else folder / "model"
    write_cameras(target, path, SIZE, form="binary" if form == "binary" else "text")
    back = read_cameras(target)
    assert len(back) == len(path)
    for name in ("K", "R", "T", "points"):
        assert np.abs(getattr(back, name) - getattr(path, name)).max(initial=0) < 1e-9, name
    if form != "json":
        assert np.abs(back.observations - path.observations).max(initial=0) < 1e-9
        assert (back.observed == path.observed).all()
        if seen:
            assert np.nanmax(back.residuals) < 1e-9


@pytest.mark.parametrize("form", ["text", "binary"])
def test_colmap_reads_our_model(tmp_path: Path, form: str) -> None:
    """The library's own reader finds our poses, projections half a pixel further, and full tracks."""
    pycolmap = pytest.importorskip("pycolmap")
    path = cameras(5)
    write_cameras(tmp_path / "model", path, SIZE, form=form)
    model = pycolmap.Reconstruction(str(tmp_path / "model"))
    assert model.num_reg_images() == len(path)
    assert model.num_points3D() == len(path.points)
    for image in model.images.values():
        frame = int(image.name[6:11])
        assert np.abs(image.cam_from_world().matrix() - np.c_[path.R[frame], path.T[frame]]).max() < 1e-12
    model.update_point_3d_errors()
    assert model.compute_mean_reprojection_error() < 1e-6
    row = path.observations[0]
    pixel = model.image(1).points2D[0].xy
    assert pixel == pytest.approx(row[1:] + 0.5)


def test_our_reader_reads_the_librarys_model(tmp_path: Path) -> None:
    """A model written by the library, in both forms, gives the same path as the one it was made from."""
    pycolmap = pytest.importorskip("pycolmap")
    path = cameras(6)
    write_cameras(tmp_path / "ours", path, SIZE)
    model = pycolmap.Reconstruction(str(tmp_path / "ours"))
    for form in ("text", "binary"):
        folder = tmp_path / form
        folder.mkdir()
        getattr(model, f"write_{form}")(str(folder))
        back = read_cameras(folder)
        assert np.abs(back.K - path.K).max() < 1e-9
        assert np.abs(back.T - path.T).max() < 1e-9
        assert np.nanmax(back.residuals) < 1e-4


def test_transforms_use_opengl_axes(tmp_path: Path) -> None:
    """A camera at the origin that looks along world -Z with +Y up has the identity as its transform."""
    R = np.diag([1.0, -1.0, -1.0])
    K = np.array([[500.0, 0, 319.5], [0, 500, 179.5], [0, 0, 1]])
    write_cameras(tmp_path / "transforms.json", CameraPath(K=[K], R=[R], T=np.zeros((1, 3))), SIZE)
    whole = json.loads((tmp_path / "transforms.json").read_text())
    assert np.array(whole["frames"][0]["transform_matrix"]) == pytest.approx(np.eye(4))
    assert (whole["cx"], whole["cy"], whole["fl_x"]) == (320.0, 180.0, 500.0)


def test_frames_come_in_the_order_of_their_names(tmp_path: Path) -> None:
    """frame_2 precedes frame_10 and the file's own order does not matter; a view angle serves as focal length."""
    poses = {f"images/frame_{i}.png": float(i) for i in (10, 2, 1)}
    frames = []
    for name, x in poses.items():
        pose = np.eye(4)
        pose[0, 3] = x
        frames.append({"file_path": name, "transform_matrix": pose.tolist()})
    target = tmp_path / "transforms.json"
    target.write_text(
        json.dumps({"camera_angle_x": 2 * np.arctan(0.5), "w": 640, "h": 360, "k1": 0.1, "frames": frames})
    )
    path = read_cameras(target)
    assert path.centres[:, 0] == pytest.approx([1, 2, 10])
    assert path.K[0, 0, 0] == pytest.approx(640)
    assert "k1 = 0.1" in path.reason
    assert "undistort" in path.reason


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("transforms.json", "{", "not JSON"),
        ("transforms.json", "{}", "list of frames"),
        ("transforms.json", '{"frames": [{"file_path": "a"}]}', "lacks a pose"),
        (
            "transforms.json",
            '{"fl_x": 1, "cx": 1, "cy": 1, "frames": [{"transform_matrix": [[0,0,0,0],[0,0,0,0],[0,0,0,0]]}]}',
            "no rotations",
        ),
        ("images.txt", "1 1 0 0 0", "cannot be read"),
    ],
)
def test_damaged_files_get_a_sentence(tmp_path: Path, name: str, text: str, said: str) -> None:
    """Each kind of damage is named."""
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=said):
        read_cameras(tmp_path if name == "images.txt" else tmp_path / name)


def test_cut_off_and_missing_models_are_refused(tmp_path: Path) -> None:
    """Half a binary model, an empty folder and a missing path get one sentence each."""
    write_cameras(tmp_path / "model", cameras(1), SIZE, form="binary")
    data = (tmp_path / "model" / "images.bin").read_bytes()
    (tmp_path / "model" / "images.bin").write_bytes(data[: len(data) // 2])
    with pytest.raises(InputError, match="cut off or damaged"):
        read_cameras(tmp_path / "model")
    with pytest.raises(InputError, match="holds no COLMAP model"):
        read_cameras(tmp_path)
    with pytest.raises(InputError, match="There are no cameras"):
        read_cameras(tmp_path / "nowhere")


def test_fisheye_is_refused_and_distortion_is_named(tmp_path: Path) -> None:
    """A camera model without a pinhole form is refused with the way out; radial terms are named as lost."""
    write_cameras(tmp_path, cameras(2, frames=1), SIZE)
    lens = tmp_path / "cameras.txt"
    lens.write_text("1 OPENCV_FISHEYE 640 360 500 500 320 180 0 0 0 0\n")
    with pytest.raises(InputError, match="undistorter"):
        read_cameras(tmp_path)
    lens.write_text("1 SIMPLE_RADIAL 640 360 500 320 180 -0.05\n")
    path = read_cameras(tmp_path)
    assert "k1 = -0.05" in path.reason
    assert path.K[0, :2, 2] == pytest.approx([319.5, 179.5])
