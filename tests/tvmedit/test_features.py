"""Features, distances and headings."""

from __future__ import annotations

import numpy as np
import pytest

import tvmedit
from imitation import InputError
from resources.performer import Capture, Part, perform, perform_hound
from tvmedit.features import Features, hann_taps, yaw_free_atom_distances
from tvmedit.features.cylinder import cylinder_histogram
from tvmedit.features.lengthwise import lengthwise_cues
from tvmedit.measuring import measure

SQUARE = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])


def test_printed_features_are_shares_of_three_histograms() -> None:
    """Each of r, theta and phi sums to 1, and theta of (-1, 0) is pi, not the 0 of the printed sign(0)."""
    features = tvmedit.frame_features(SQUARE, method="paper", origin=(0, 0, 0))
    r, theta, phi = np.split(features.histograms[0], np.cumsum(features.parts)[:-1])
    assert [part.sum() for part in (r, theta, phi)] == pytest.approx([1, 1, 1])
    assert theta[-1] == pytest.approx(1 / 6)
    assert phi[0] == pytest.approx(1 / 6)


def test_printed_distance_is_eq_2_to_4() -> None:
    """Frames with different numbers of r bins are compared with the shorter padded by zeros."""
    features = tvmedit.frame_features([SQUARE, 3 * SQUARE], method="paper", origin=(0, 0, 0), radius_bin=1.0)
    distance = tvmedit.frame_distances(features)
    assert distance[0, 1] == pytest.approx(np.sqrt(2), rel=1e-5)
    assert distance[0, 0] == 0


def test_robust_features_ignore_place_and_follow_turns(capture: Capture) -> None:
    """Moving the body changes nothing; turning it by a bin shifts the azimuth by a bin."""
    vertices, faces, _ = capture.mesh(20)
    c, s = np.cos(np.pi / 12), np.sin(np.pi / 12)
    centre = tvmedit.analyse([(vertices, faces)], fps=15).centres[0]
    flat = vertices - [*centre, 0.0]
    turned = flat @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]])
    shapes = [vertices, vertices + np.array([3.0, -2.0, 0.0]), turned]
    histograms = tvmedit.frame_features(shapes, faces=[faces] * 3).histograms
    assert np.abs(histograms[0] - histograms[1]).max() < 1e-5
    assert np.abs(np.roll(histograms[0], 1, axis=2) - histograms[2]).max() < 1e-3
    assert (histograms**2).sum(axis=(1, 2, 3)) == pytest.approx(np.ones(3), abs=1e-5)


def test_the_soft_histogram_is_what_plain_sums_give() -> None:
    """Each vertex shared among the eight bins around it, the azimuth by the library's arc tangent, bin by bin."""
    random = np.random.default_rng(5)
    for scale in (0.1, 1.0, 30.0):
        vertices = scale * random.normal(size=(700, 3)) + (0.0, 0.0, scale)
        # On the axes and diagonals, behind, and on the vertical itself.
        vertices[:9, :2] = [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, 1], [1, -1], [-1, -1]]
        weights = random.random(700) * (random.random(700) < 0.8)
        plain = np.zeros((10, 6, 24))
        for (x, y, z), weight in zip(vertices, weights, strict=True):
            places = (
                (np.clip(z / (1.7 * 0.13) - 0.5, 0, 9), 10),
                (np.clip(np.hypot(x, y) / (1.7 * 0.1) - 0.5, 0, 5), 6),
                (np.arctan2(y, x) / (2 * np.pi) * 24 + 23.5, 24),
            )
            for corner in np.ndindex(2, 2, 2):
                share, index = weight, []
                for (place, count), side in zip(places, corner, strict=True):
                    low = int(np.floor(place))
                    share *= place - low if side else 1 - (place - low)
                    index.append((low + side) % count)
                plain[tuple(index)] += share
        counted = cylinder_histogram(vertices, weights, 0.0, 0.0, 0.0, 1.7)
        np.testing.assert_allclose(counted.astype(float) ** 2, plain / plain.sum(), atol=1e-7)


def test_atom_distance_is_eq_5_with_clamped_ends() -> None:
    """Printed taps, both frame numbers clamped together."""
    frames = np.random.default_rng(0).random((6, 6))
    atoms = tvmedit.atom_distances(frames)
    taps = {-2: 0.25, -1: 0.5, 0: 1.0, 1: 0.5, 2: 0.25}
    expected = sum(w * frames[max(0, 1 + k), min(5, max(0, 4 + k))] for k, w in taps.items())
    assert atoms[1, 4] == pytest.approx(expected, rel=1e-6)


def test_yaw_free_distance_is_the_least_over_all_turns() -> None:
    """Against the definition, turn by turn, and across the blocks of rows."""
    random = np.random.default_rng(1)
    histograms = np.sqrt(random.dirichlet(np.full(1440, 0.2), 9)).reshape(9, 10, 6, 24).astype(np.float32)
    histograms[5] = np.roll(histograms[2], 7, axis=2)
    features = Features("robust", histograms, (10, 6, 24), np.zeros(3), 1.7)
    taps = hann_taps(10)
    atoms = yaw_free_atom_distances(features, taps)
    spectrum = np.fft.rfft(histograms.astype(float), axis=3)
    share = np.where(np.isin(np.arange(13), (0, 12)), 1.0, 2.0) / 24
    least = np.inf
    for yaw in range(48):
        turn = np.exp(2j * np.pi * np.arange(13) * yaw / 48)
        pairs = zip(range(-2, 3), taps, strict=True)
        gaps = [(w, spectrum[max(0, 1 + k)] - turn * spectrum[min(8, 6 + k)]) for k, w in pairs]
        least = min(least, sum(w * (np.abs(gap) ** 2 * share).sum() for w, gap in gaps))
    assert atoms[1, 6] == pytest.approx(np.sqrt(least), abs=1e-4)
    assert np.array_equal(atoms, atoms.T)


def test_headings_follow_a_turning_performer(capture: Capture, analysis: tvmedit.Analysis) -> None:
    """Never turned round, and within a few degrees on average."""
    error = np.abs(np.angle(np.exp(1j * (analysis.headings - capture.headings))))
    assert np.degrees(np.median(error)) < 6
    assert np.degrees(error.max()) < 40


def test_the_users_front_turns_all_headings(capture: Capture, analysis: tvmedit.Analysis) -> None:
    """Given the front of frame 0, headings differ by one angle."""
    turned = tvmedit.analyse([capture.mesh(k)[:2] for k in range(6)], fps=15, front=1.0)
    assert turned.headings[0] == pytest.approx(1.0, abs=1e-9)


def test_y_up_meshes_give_the_same_analysis(capture: Capture) -> None:
    """Turned on the way in, bit for bit."""
    meshes = [capture.mesh(k)[:2] for k in range(4)]
    other = [(np.stack([v[:, 0], v[:, 2], -v[:, 1]], axis=1), f) for v, f in meshes]
    first, second = tvmedit.analyse(meshes, fps=15), tvmedit.analyse(other, fps=15, up="y")
    assert np.array_equal(first.features.histograms, second.features.histograms)


BAD = {
    "no vertices": (np.zeros((0, 3)), np.zeros((0, 3), int)),
    "no faces": (SQUARE, np.zeros((0, 3), int)),
    "not finite": (np.where(SQUARE == 1, np.nan, SQUARE), np.array([[0, 2, 4]])),
    "beyond": (SQUARE, np.array([[0, 2, 99]])),
    "without any area": (np.zeros((4, 3)), np.array([[0, 1, 2]])),
    "shape": (SQUARE[:, :2], np.array([[0, 1, 2]])),
}


@pytest.mark.parametrize("words", BAD)
def test_bad_frames_are_named(capture: Capture, words: str) -> None:
    """The second frame is bad: one sentence that names it and the fault."""
    good = capture.mesh(0)[:2]
    with pytest.raises(InputError, match=f"^Frame 1 .*{words}"):
        tvmedit.analyse([good, BAD[words]], fps=15)


def test_empty_sequences_and_bad_rates_are_refused(capture: Capture) -> None:
    """No frames, and a frame rate that is none."""
    with pytest.raises(InputError, match="no frames"):
        tvmedit.analyse([], fps=15)
    with pytest.raises(InputError, match="frame rate"):
        tvmedit.analyse([capture.mesh(0)[:2]], fps=float("nan"))


def test_one_frame_and_a_motionless_sequence_stay_whole(capture: Capture) -> None:
    """One cluster each; the motionless one says so."""
    mesh = capture.mesh(0)[:2]
    assert len(tvmedit.analyse([mesh], fps=15).structure.clusters) == 1
    still = tvmedit.analyse([mesh] * 40, fps=15).structure
    assert len(still.clusters) == 1
    assert "hardly moves" in still.reason


def test_a_long_body_faces_along_itself() -> None:
    """The hound's headings are those of its trunk, in place and on the way; nobody on two legs counts as long."""
    capture = perform_hound([Part("trot", 3), Part("bow", 2)], seed=5, cell=0.04)
    turn = np.deg2rad(40.0)
    c, s = np.cos(turn), np.sin(turn)
    spin = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    frames = range(0, len(capture), 3)
    meshes = [(capture.mesh(k)[0] @ spin.T, capture.mesh(k)[1]) for k in frames]
    headings = measure(meshes, fps=25 / 3).headings
    assert np.abs(np.rad2deg(headings) - 40).max() < 6
    back = [(vertices * [-1, -1, 1], faces) for vertices, faces in meshes]
    flipped = measure(back, fps=25 / 3).headings
    assert np.abs(np.rad2deg(np.angle(np.exp(1j * (flipped - headings - np.pi))))).max() < 1e-3
    for motion in ("twist", "squat", "bend", "jumping jack"):
        person = perform([Part(motion, 2)], fps=10, cell=0.05)
        samples = measure(person.meshes(), fps=10).samples
        assert lengthwise_cues(samples, 1.75, 10) is None
