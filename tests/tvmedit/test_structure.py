"""Clusters and textons."""

from __future__ import annotations

import numpy as np
import pytest

import tvmedit
from imitation import InputError
from resources.performer import Capture, Part, perform
from tvmedit.structure.leaving import held
from tvmedit.structure.structure import Cluster


def cyclic_distances(periods: list[int], repeats: int) -> np.ndarray:
    """Atom distances of motions on circles, each far from the others."""
    places, at = [], 0.0
    for period in periods:
        angle = 2 * np.pi * np.arange(period * repeats) / period
        places.append(np.stack([np.cos(angle) + at, np.sin(angle), np.full(len(angle), at)], axis=1))
        at += 2.5
    points = np.concatenate(places)
    return np.linalg.norm(points[:, None] - points[None], axis=2)


def test_circles_are_found_exactly() -> None:
    """Boundaries to the frame, textons of one period, at the ends to a frame."""
    structure = tvmedit.parse_structure(cyclic_distances([12, 20, 15], 5), fps=15)
    assert structure.boundaries == (60, 160)
    for cluster, period in zip(structure.clusters, (12, 20, 15), strict=True):
        assert cluster.cyclic
        lengths = [last - first + 1 for first, last in cluster.textons]
        assert np.median(lengths) == period
        assert max(abs(length - period) for length in lengths) <= 1
    assert all(cluster.reason for cluster in structure.clusters)


def test_clusters_tile_the_sequence_and_hold_their_textons(analysis: tvmedit.Analysis) -> None:
    """No gaps, no overlap, textons one after another inside their cluster."""
    for method in ("optimal", "paper"):
        structure = tvmedit.parse_structure(analysis.atom_distances, fps=15, method=method)
        ends = [-1, *(cluster.last for cluster in structure.clusters)]
        assert [cluster.first for cluster in structure.clusters] == [end + 1 for end in ends[:-1]]
        assert ends[-1] == len(analysis) - 1
        for cluster in structure.clusters:
            frames = [frame for texton in cluster.textons for frame in texton]
            assert frames == sorted(frames)
            assert cluster.first <= frames[0]
            assert frames[-1] <= cluster.last


def test_a_labelled_capture_is_parsed(capture: Capture, analysis: tvmedit.Analysis) -> None:
    """All boundaries within 5 frames and none besides."""
    agreement = tvmedit.compare_boundaries(analysis.structure.boundaries, capture.boundaries)
    assert agreement.f_score == 1


def test_printed_method_finds_a_clear_change() -> None:
    """Fig. 3 on two circles: the second cluster starts at its first frame, after textons of one period."""
    structure = tvmedit.parse_structure(cyclic_distances([12, 20], 5), fps=15, method="paper", beta=0.5)
    assert structure.boundaries == (60,)
    assert structure.clusters[0].textons[0] == (0, 11)
    assert "given" in structure.reason


def test_one_motion_alone_has_no_boundary() -> None:
    """The price of new motion follows the sequence's own spread."""
    assert tvmedit.parse_structure(cyclic_distances([18], 7), fps=25).boundaries == ()


def test_what_does_not_repeat_is_one_texton() -> None:
    """Frames unlike all others; forced, they are cut into periods all the same."""
    points = np.random.default_rng(2).standard_normal((60, 8))
    atoms = np.linalg.norm(points[:, None] - points[None], axis=2)
    structure = tvmedit.parse_structure(atoms, fps=15)
    assert [cluster.cyclic for cluster in structure.clusters] == [False] * len(structure.clusters)
    assert structure.clusters[0].textons == ((structure.clusters[0].first, structure.clusters[0].last),)
    assert any(cluster.cyclic for cluster in tvmedit.parse_structure(atoms, fps=15, force_cyclic=True).clusters)


def test_boundaries_given_by_hand_are_kept() -> None:
    """Exactly those, with textons found inside."""
    atoms = cyclic_distances([12, 20], 5)
    for method in ("optimal", "paper"):
        structure = tvmedit.parse_structure(atoms, fps=15, method=method, boundaries=[50])
        assert structure.boundaries == (50,)
        assert structure.clusters[0].cyclic
    with pytest.raises(InputError, match="boundaries"):
        tvmedit.parse_structure(atoms, fps=15, boundaries=[999])


def test_fewer_clusters_on_request() -> None:
    """Less sensitivity never gives more boundaries."""
    atoms = cyclic_distances([9, 13, 8, 15], 3)
    counts = [len(tvmedit.parse_structure(atoms, fps=15, sensitivity=s).boundaries) for s in (0.02, 0.3, 1.0)]
    assert counts == sorted(counts)


@pytest.mark.parametrize("bad", [np.zeros((0, 0)), np.zeros((3, 4)), np.full((4, 4), np.nan)])
def test_bad_distances_are_refused(bad: np.ndarray) -> None:
    """Not square, empty, not finite."""
    with pytest.raises(InputError):
        tvmedit.parse_structure(bad, fps=15)


def test_precision_and_recall_match_one_to_one() -> None:
    """Two found boundaries beside one label are one hit and one false one."""
    agreement = tvmedit.compare_boundaries([10, 12, 90], [11, 50], tolerance=5)
    assert (agreement.matched, agreement.precision, agreement.recall) == (1, pytest.approx(1 / 3), 0.5)


def test_one_round_repeats_on_the_users_word() -> None:
    """A file that holds one round of a walk is played once, unless the user says that it repeats."""
    capture = perform([Part("walk", 1)], fps=15, seed=4)
    atoms = tvmedit.analyse(capture.meshes(), fps=15).atom_distances
    (once,) = tvmedit.parse_structure(atoms, fps=15).clusters
    assert not once.cyclic
    (again,) = tvmedit.parse_structure(atoms, fps=15, force_cyclic=True).clusters
    assert again.cyclic
    assert again.textons == ((0, len(capture) - 1),)
    assert "user's word" in again.reason


def test_what_was_seen_once_repeats_only_if_it_came_back() -> None:
    """A slow change drifts away from what it was; a swing comes back: each with room for one texton."""
    frames = np.arange(41)
    once = Cluster(0, 40, True, ((14, 28),), 15.0)
    drift = (0.1 * np.abs(frames[:, None] - frames)).astype(np.float32)
    (changed,) = held(drift, [once], 1.0)
    assert not changed.cyclic
    assert changed.textons == ((0, 40),)
    assert "does not come back" in changed.reason
    swing = np.abs(np.exp(2j * np.pi * frames[:, None] / 15) - np.exp(2j * np.pi * frames / 15)).astype(np.float32)
    assert held(swing, [once], 1.0) == [once]
