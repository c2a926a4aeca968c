"""The whole way from tracks to a moving character, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest

from imitation import CameraPath, Cancelled, InputError, imitate
from imitation.propagation import Base, ambiguous_spans, commit_edit, propagate, solve_base
from tests.imitation.propagation.conftest import Walker, film


@pytest.mark.parametrize("method", ["joint", "paper"])
def test_walker_is_followed_better_than_rigidly(walker: Walker, method: str) -> None:
    """Both routes beat the start pose moved with the true key centroid, the joint one by far, and the feet stand."""
    result = imitate(*walker.arguments, method=method, deformer=walker.deformer)
    keys = np.stack([walker.walk.key_points[name] for name in result.names], axis=1)
    rigid = walker.rest + (keys.mean(axis=1) - keys[0].mean(axis=0))[:, None]
    assert walker.error(result.vertices) < (0.4 if method == "joint" else 0.65) * walker.error(rigid)
    planted = np.stack([walker.walk.planted(name) for name in result.names], axis=1)
    still = planted[1:] & planted[:-1]
    travel = np.linalg.norm(np.diff(result.key_points, axis=0), axis=2)[still] / walker.walk.body.diagonal
    assert travel.mean() < 2e-4


def test_frame_0_is_the_aligned_character(base: Base, walker: Walker) -> None:
    """The character starts exactly where it was aligned."""
    np.testing.assert_allclose(base.vertices[0], walker.rest, atol=1e-9)


def test_same_input_same_bits(walker: Walker, base: Base) -> None:
    """A second solve has the bits of the first, with a deformer of its own."""
    again = solve_base(*walker.arguments)
    assert np.array_equal(again.vertices, base.vertices)
    assert np.array_equal(again.lifted, base.lifted)


@pytest.mark.slow
def test_imitate_with_edits_is_base_commit_propagate(walker: Walker, base: Base, free_vertices: list[int]) -> None:
    """The one call and the three pieces give the same bits, and a muted vertex is as if it had not been dragged."""
    moves = {12: {free_vertices[0]: walker.place(12, free_vertices[0])}}
    committed = {12: commit_edit(base, 12, moves[12], deformer=walker.deformer)}
    pieces = propagate(base, committed, deformer=walker.deformer)
    whole = imitate(*walker.arguments, edits=moves, deformer=walker.deformer)
    assert np.array_equal(whole.vertices, pieces.vertices)
    muted = imitate(*walker.arguments, edits=moves, muted=free_vertices, deformer=walker.deformer)
    assert np.array_equal(muted.vertices, base.vertices)


def test_noise_is_taken_out(walker: Walker) -> None:
    """With 1 px of jitter the result's acceleration is near the truth's and planted feet stand."""
    noisy = film("quadruped", 31, "stairs", 50.0, seed=4, noise=1.0)
    result = imitate(*noisy.arguments, deformer=noisy.deformer)
    keys = np.stack([noisy.walk.key_points[name] for name in result.names], axis=1)
    ratio = np.linalg.norm(np.diff(result.key_points, 2, axis=0), axis=2).mean() / (
        np.linalg.norm(np.diff(keys, 2, axis=0), axis=2).mean()
    )
    assert 0.7 < ratio < 1.4
    assert 0.5 < np.median(list(result.report.noise.values())) < 1.6


def test_gaps_are_bridged(walker: Walker) -> None:
    """A track with a gap of six frames costs little, and the other frames hardly notice."""
    name = "left hind knee" if "left hind knee" in walker.tracks else sorted(walker.tracks)[5]
    tracks = {key: track.copy() for key, track in walker.tracks.items()}
    tracks[name][12:18] = np.nan
    rest, faces, cameras, _, pairs, contacts = walker.arguments
    whole = imitate(*walker.arguments, deformer=walker.deformer)
    gapped = imitate(rest, faces, cameras, tracks, pairs, contacts, deformer=walker.deformer)
    assert np.isfinite(gapped.vertices).all()
    assert walker.error(gapped.vertices) < walker.error(whole.vertices) + 0.5


def test_report_counts(walker: Walker, base: Base) -> None:
    """Table 1's counts are those of the input."""
    report = propagate(base, {}, deformer=walker.deformer).report
    spans = sum(len(spans) for spans in walker.walk.contacts.values())
    assert (report.frames, report.vertices, report.faces) == (31, len(walker.rest), len(walker.faces))
    assert (report.tracks, report.anchors, report.contacts) == (16, len(walker.walk.contacts), spans)
    assert report.edited_frames == report.control_vertices == 0
    assert max(report.reprojection.values()) < 0.5
    assert sum(report.seconds.values()) > 0
    assert isinstance(report.as_dict()["tracks"], int)


@pytest.mark.slow
def test_one_clip_drives_several_characters(walker: Walker) -> None:
    """The same tracks move a larger character of other density that was aligned elsewhere."""
    other = film("quadruped", 31, "stairs", 50.0, seed=4, vertices=1200)
    rest = other.rest * 1.1 - 0.1 * other.rest.mean(axis=0)
    _, _, cameras, tracks, _, contacts = walker.arguments
    result = imitate(rest, other.faces, cameras, tracks, other.pairs, contacts)
    assert result.vertices.shape == (31, len(other.rest), 3)
    travelled = result.vertices[30].mean(axis=0) - result.vertices[0].mean(axis=0)
    true = walker.walk.vertices[30].mean(axis=0) - walker.walk.vertices[0].mean(axis=0)
    np.testing.assert_allclose(travelled, true, atol=0.1)


@pytest.mark.slow
def test_ambiguous_limbs_are_flagged_and_nothing_moves(walker: Walker) -> None:
    """A biped seen from in front has limbs that can be mirrored; flags name frames, and the solution stays."""
    biped = film("biped", 31, "flat", 25.0, seed=4, vertices=900)
    base = solve_base(*biped.arguments, deformer=biped.deformer)
    before = base.vertices.copy()
    spans = ambiguous_spans(base)
    assert spans
    assert np.array_equal(base.vertices, before)
    for span in spans:
        assert 0 <= span.first <= span.decide <= span.last < 31
        assert abs(span.other) > 0


def test_cancel_leaves_at_once(walker: Walker) -> None:
    """Progress may cancel; it is asked many times."""
    fractions: list[float] = []

    def stop(fraction: float) -> None:
        fractions.append(fraction)
        if fraction > 0.7:
            raise Cancelled

    with pytest.raises(Cancelled):
        solve_base(*walker.arguments, deformer=walker.deformer, progress=stop)
    assert fractions == sorted(fractions)
    assert len(fractions) > 20


def broken(walker: Walker, what: str) -> tuple:
    """The walker's arguments with one thing wrong."""
    rest, faces, cameras, tracks, pairs, contacts = walker.arguments
    name, foot = next(iter(pairs)), next(iter(contacts))
    if what == "contact outside":
        contacts = {foot: [(20, 40, (0.0, 0.0, 0.0))]}
    elif what == "contact reversed":
        contacts = {foot: [(20, 10, (0.0, 0.0, 0.0))]}
    elif what == "contact nan":
        contacts = {foot: [(0, 3, (0.0, np.nan, 0.0))]}
    elif what == "contacts overlap":
        contacts = {foot: [(0, 5, (0.0, 0.0, 0.0)), (5, 9, (0.0, 0.0, 0.0))]}
    elif what == "contact of nobody":
        contacts = {"third eye": [(0, 5, (0.0, 0.0, 0.0))]}
    elif what == "vertex":
        pairs = pairs | {name: 10**6}
    elif what == "no pairs":
        pairs = {}
    elif what == "two pairs":
        pairs = dict(list(pairs.items())[:2])
    elif what == "same vertex":
        pairs = pairs | {name: pairs[list(pairs)[1]]}
    elif what == "unknown track":
        pairs = pairs | {"third eye": 3}
    elif what == "short track":
        tracks = tracks | {name: tracks[name][:-1]}
    elif what == "few cameras":
        cameras = cameras[:-1]
    elif what == "no cameras":
        cameras = CameraPath(K=np.zeros((0, 3, 3)), R=np.zeros((0, 3, 3)), T=np.zeros((0, 3)))
    elif what == "no start":
        tracks = tracks | {name: np.where(np.arange(31)[:, None] < 1, np.nan, tracks[name])}
    elif what == "nan mesh":
        rest = np.where(np.arange(len(rest))[:, None] == 7, np.nan, rest)
    elif what == "no faces":
        faces = faces[:0]
    elif what == "behind":
        rest = rest + 30 * (cameras.centres[0] - rest.mean(axis=0))
    return rest, faces, cameras, tracks, pairs, contacts


@pytest.mark.parametrize(
    ("what", "words"),
    [
        ("contact outside", "frames 20 to 40 is outside the clip"),
        ("contact reversed", "before it begins"),
        ("contact nan", "three finite numbers"),
        ("contacts overlap", "overlap at frame 5"),
        ("contact of nobody", "belong to no track"),
        ("vertex", "vertex 1000000, but the character has"),
        ("no pairs", "No track is paired"),
        ("two pairs", "pair at least three"),
        ("same vertex", "paired with the same vertex"),
        ("unknown track", "names no track"),
        ("short track", "30 frames but there are 31 cameras"),
        ("few cameras", "31 frames but there are 30 cameras"),
        ("no cameras", "no cameras"),
        ("no start", "no position in frame 0"),
        ("nan mesh", "Vertex 7 of the character is not finite"),
        ("no faces", "faces need shape"),
        ("behind", "behind the camera in frame 0"),
    ],
)
def test_bad_input_is_one_sentence(walker: Walker, what: str, words: str) -> None:
    """Each bad input is refused before any solving, with a sentence that names it."""
    with pytest.raises(InputError, match=words) as caught:
        solve_base(*broken(walker, what), deformer=walker.deformer)
    assert str(caught.value).endswith(".")
    assert "\n" not in str(caught.value)


def test_unknown_method_is_refused(walker: Walker) -> None:
    """The methods are named."""
    with pytest.raises(InputError, match='"joint" or "paper"'):
        solve_base(*walker.arguments, method="magic", deformer=walker.deformer)  # type: ignore[arg-type]


@pytest.mark.slow
def test_a_hidden_limb_follows_its_mirror() -> None:
    """A leg without any track moves as its mirror half a cycle later, nearer to the truth than one that just hangs."""
    walker = film("quadruped", 46, "flat", 60.0, seed=4)
    rest, faces, cameras, tracks, pairs, contacts = walker.arguments
    hidden = ["right front paw", "right front knee"]
    without = {name: track for name, track in tracks.items() if name not in hidden}
    stands = {name: spans for name, spans in contacts.items() if name not in hidden}
    mirrors = {name: (name.replace("right", "left"), 15) for name in [*hidden, "right front hip", "right hind hip"]}
    result = imitate(rest, faces, cameras, without, pairs, stands, symmetry=mirrors, deformer=walker.deformer)
    assert list(result.names[-2:]) == hidden
    shown = {name: pairs[name] for name in without}
    free = imitate(rest, faces, cameras, without, shown, stands, deformer=walker.deformer)
    paw, later = pairs[hidden[0]], slice(16, None)
    error = [np.linalg.norm((made.vertices - walker.walk.vertices)[later, paw]) for made in (result, free)]
    assert error[0] < 0.7 * error[1]


@pytest.mark.slow
def test_the_lag_of_a_hidden_limb_is_that_of_the_gait() -> None:
    """Told only who mirrors whom, the hidden fore leg moves half a stride later, as the hind legs show."""
    walker = film("quadruped", 46, "flat", 60.0, seed=4)
    rest, faces, cameras, tracks, pairs, contacts = walker.arguments
    hidden = ["right front paw", "right front knee"]
    without = {name: track for name, track in tracks.items() if name not in hidden}
    stands = {name: spans for name, spans in contacts.items() if name not in hidden}
    both = [*hidden, "right hind paw", "right hind knee"]
    error = {}
    for lag in (None, 0):
        mirrors = {name: (name.replace("right", "left"), lag) for name in both}
        made = imitate(rest, faces, cameras, without, pairs, stands, symmetry=mirrors, deformer=walker.deformer)
        paw = pairs[hidden[0]]
        error[lag] = np.linalg.norm((made.vertices - walker.walk.vertices)[16:, paw])
    assert error[None] < 0.7 * error[0]


@pytest.mark.parametrize(
    ("symmetry", "words"),
    [
        ({"third eye": "nose"}, "which has no pair"),
        ({"nose": "third eye"}, "which has no pair"),
        ({"nose": "nose"}, "its own mirror"),
    ],
)
def test_bad_symmetry_is_named(walker: Walker, symmetry: dict, words: str) -> None:
    """A mirror that does not exist is one sentence."""
    with pytest.raises(InputError, match=words):
        solve_base(*walker.arguments, symmetry=symmetry, deformer=walker.deformer)
