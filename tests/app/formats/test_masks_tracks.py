"""Masks and tracks: nothing lost on the way, and clear words about files that do not fit the clip."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from app.formats import TrackFile, read_mask, read_masks, read_tracks, write_image, write_mask, write_tracks
from imitation.errors import InputError


@settings(deadline=None, max_examples=40)
@given(mask=hnp.arrays(np.bool_, hnp.array_shapes(min_dims=2, max_dims=2, min_side=1, max_side=40)))
def test_masks_come_back(tmp_path_factory: pytest.TempPathFactory, mask: np.ndarray) -> None:
    """Any mask survives as PNG."""
    path = tmp_path_factory.getbasetemp() / "mask.png"
    write_mask(path, mask)
    np.testing.assert_array_equal(read_mask(path, mask.shape[::-1]), mask)


def test_masks_of_other_programs(tmp_path: Path) -> None:
    """Labels that are small numbers, coloured subjects, and alpha masks are understood."""
    subject = np.zeros((20, 30), bool)
    subject[5:10, 5:20] = True
    write_image(tmp_path / "labels.png", subject.astype(np.uint8) * np.uint8(3))
    write_image(tmp_path / "red.png", subject[..., None] * np.array([250, 0, 0], np.uint8))
    alpha = np.full((20, 30, 4), 77, np.uint8)
    alpha[..., 3] = subject * np.uint8(255)
    write_image(tmp_path / "alpha.png", alpha)
    for name in ("labels.png", "red.png", "alpha.png"):
        np.testing.assert_array_equal(read_mask(tmp_path / name), subject, err_msg=name)


def test_a_folder_of_masks_goes_by_its_numbers(tmp_path: Path) -> None:
    """Numbers in names are frames; masks of the wrong size, beyond the clip, or missing are named."""
    for frame in (0, 20, 7):
        write_mask(tmp_path / f"mask_{frame:05d}.png", np.eye(20, 30) * (frame + 1))
    assert sorted(read_masks(tmp_path, 21, (30, 20))) == [0, 7, 20]
    with pytest.raises(InputError, match=r"mask_00020\.png is for frame 20, but the clip's last frame is 9"):
        read_masks(tmp_path, 10, (30, 20))
    with pytest.raises(InputError, match=r"30 x 20 pixels, but the clip is 32 x 20"):
        read_masks(tmp_path, 21, (32, 20))
    (tmp_path / "mask_00001.png").write_bytes(b"no picture")
    with pytest.raises(InputError, match="not a picture"):
        read_masks(tmp_path, 21, (30, 20))
    for folder, words in ((tmp_path / "none", "does not exist"), (tmp_path / "empty", "holds no PNG masks")):
        (tmp_path / "empty").mkdir(exist_ok=True)
        with pytest.raises(InputError, match=words):
            read_masks(folder, 21, (30, 20))
    with pytest.raises(InputError, match="must be"):
        write_mask(tmp_path / "a.png", np.zeros((3, 3, 3)))


@st.composite
def tracks(draw: st.DrawFn) -> dict[str, TrackFile]:
    """Tracks with gaps, any names, with and without confidence and state."""
    count = draw(st.integers(1, 12))
    names = draw(st.lists(st.text(st.characters(codec="utf-8", exclude_characters="\x00"), min_size=1), unique=True))
    made = {}
    for name in names:
        positions = draw(hnp.arrays(np.float64, (count, 2), elements=st.floats(-1e5, 1e5)))
        positions[draw(hnp.arrays(np.bool_, count))] = np.nan
        trust = draw(st.none() | hnp.arrays(np.float64, count, elements=st.floats(0, 1)))
        state = draw(
            st.none() | st.lists(st.sampled_from(["visible", "occluded", "outside"]), min_size=count, max_size=count)
        )
        made[name] = TrackFile(positions, trust, None if state is None else tuple(state))
    return made


@pytest.mark.parametrize("suffix", [".json", ".csv"])
@settings(deadline=None, max_examples=60)
@given(given_tracks=tracks())
def test_tracks_come_back(
    tmp_path_factory: pytest.TempPathFactory, suffix: str, given_tracks: dict[str, TrackFile]
) -> None:
    """All digits, gaps, names, confidences and states survive in JSON and CSV."""
    path = tmp_path_factory.getbasetemp() / f"tracks{suffix}"
    write_tracks(path, given_tracks, size=(854, 480), fps=Fraction(30000, 1001))
    back = read_tracks(path)
    assert list(back) == list(given_tracks)
    for name, track in given_tracks.items():
        np.testing.assert_array_equal(back[name].positions, track.positions)
        assert back[name].state == track.state
        assert (back[name].confidence is None) == (track.confidence is None)
        if track.confidence is not None:
            np.testing.assert_array_equal(back[name].confidence, track.confidence)


def test_sparse_csv_of_a_spreadsheet(tmp_path: Path) -> None:
    """Missing rows are absent frames; columns may be in another order, with a byte order mark."""
    (tmp_path / "a.csv").write_text("﻿frame,track,y,x\r\n2,paw,20.5,10\r\n0,paw,1,2\r\n", encoding="utf-8")
    track = read_tracks(tmp_path / "a.csv", frames=5)["paw"]
    np.testing.assert_array_equal(track.positions, [[2, 1], [np.nan] * 2, [10, 20.5], [np.nan] * 2, [np.nan] * 2])


def test_bad_track_files(tmp_path: Path) -> None:
    """Each kind of wrong file gets its sentence."""
    good = '{"version": 1, "tracks": [{"name": "a", "positions": [[1, 2], null]}]}'
    for name, text, words in [
        ("a.json", "{", "holds no tracks"),
        ("a.json", "[1]", "holds no tracks"),
        ("a.json", '{"version": 9, "tracks": []}', "newer version"),
        ("a.json", good.replace("[1, 2]", "[1]"), "holds no tracks"),
        ("a.json", good.replace("[1, 2]", '["x", 2]'), "holds no tracks"),
        ("a.json", good.replace("null", "null, [3, 4]"), "The track a has 3 frames, but the clip has 2"),
        ("a.csv", "a,b\n1,2\n", "the first line must be"),
        ("a.csv", "track,frame,x,y\na,5,1,1\n", "in frame 5, which the clip does not have"),
        ("a.csv", "track,frame,x,y\na,-1,1,1\n", "in frame -1"),
        ("a.csv", "track,frame,x,y\na,one,1,1\n", "holds no tracks"),
        ("a.csv", "track,frame,x,y,state\na,0,1,1,flying\n", "state must be one of"),
        ("a.txt", "hello", "give .json or .csv"),
    ]:
        (tmp_path / name).write_text(text)
        with pytest.raises(InputError, match=words) as caught:
            read_tracks(tmp_path / name, frames=2)
        assert "\n" not in str(caught.value)
    (tmp_path / "a.csv").write_text("track,frame,x,y\na,99999999999,1,1\n")
    with pytest.raises(InputError, match="does not have"):
        read_tracks(tmp_path / "a.csv")
    with pytest.raises(InputError, match="different numbers of frames"):
        write_tracks(tmp_path / "b.json", {"a": np.zeros((3, 2)), "b": np.zeros((2, 2))})
    with pytest.raises(InputError, match="NaN where it is absent"):
        write_tracks(tmp_path / "b.json", {"a": np.zeros((3, 3))})
    assert not (tmp_path / "b.json").exists()
