"""Dense flow: right on known motion, filled in any order, resumed after a cancel, bounded for large pictures."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.errors import Cancelled, InputError
from imitation.tracking import FlowField, compute_flow, prepare_clip, track_point
from tests.imitation.tracking.worlds import moving


def test_flow_is_the_motion():
    """On a texture that moves evenly both directions show the motion, to a tenth of a pixel in the middle."""
    frames, path = moving(frames=4, speed=5.0, wave=0.0)
    field = compute_flow(frames)
    inner = (slice(None), slice(40, -40), slice(60, -60))
    step = np.diff(path, axis=0).mean(axis=0)
    assert np.abs(field.forward[inner].astype(float) - step).mean() < 0.1
    assert np.abs(field.backward[inner].astype(float) + step).mean() < 0.1


def test_pairs_in_any_order_and_resumed():
    """A field filled pair by pair, backwards, after a cancel, or on mapped files has the same bits."""
    frames, _ = moving(frames=5)
    whole, pieces = compute_flow(frames), FlowField.empty(5, 200, 320)
    for pair in (3, 1):
        compute_flow(frames, out=pieces, pairs=[pair])
    assert pieces.ready.tolist() == [False, True, False, True]

    def stop(fraction: float) -> None:
        if fraction > 0.5:
            raise Cancelled

    with pytest.raises(Cancelled):
        compute_flow(frames, stop, out=pieces)
    assert pieces.ready.tolist() == [True, True, False, True]
    compute_flow(frames, out=pieces)
    assert np.array_equal(whole.forward, pieces.forward)
    assert np.array_equal(whole.backward, pieces.backward)


@pytest.mark.slow
def test_large_pictures_have_smaller_fields():
    """Above 1.3 million pixels the field is stored at half the size, in pixels of the full picture."""
    frames, path = moving(frames=2, size=(1080, 1920), speed=6.0, wave=0.0)
    field = compute_flow(frames)
    assert field.scale == 2
    assert field.forward.shape == (1, 540, 960, 2)
    assert abs(float(np.median(field.forward[0, 200:300, 300:600, 0])) - 6.0) < 0.1
    track = track_point(prepare_clip(frames, flow=field), {0: tuple(path[0])})
    assert np.abs(track.positions - path).max() < 0.3


def test_tiny_pictures_have_flow():
    """Pictures smaller than the method's patches do not stop it."""
    frames = [np.full((9, 13, 3), 7, np.uint8)] * 3
    field = compute_flow(frames)
    assert field.forward.shape == (2, 9, 13, 2)
    assert np.isfinite(field.forward).all()
    assert np.isfinite(track_point(frames, {1: (5.0, 5.0)}).positions).all()


def test_refuses_another_clips_field():
    """A field of another size is refused, and one of wrong arrays cannot be made."""
    frames, _ = moving(frames=3)
    with pytest.raises(InputError, match="another clip"):
        compute_flow(frames, out=FlowField.empty(4, 200, 320))
    with pytest.raises(InputError, match="float16"):
        FlowField(np.zeros((2, 4, 4, 2)), np.zeros((2, 4, 4, 2)), np.zeros(2, bool))
    with pytest.raises(InputError, match="shape"):
        FlowField(np.zeros((2, 4, 4), np.float16), np.zeros((2, 4, 4, 2), np.float16), np.zeros(2, bool))


def test_memory_is_bounded():
    """A prepared clip lets go of what was used longest ago, and gives the same bits when it makes it again."""
    frames, _ = moving(frames=12)
    small, large = prepare_clip(frames, memory=2_000_000), prepare_clip(frames)
    first = [level.copy() for level in small.colours(0)]
    for t in range(12):
        small.colours(t)
        small.greys(t)
    assert small._used <= 2_000_000
    again = small.colours(0)
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    assert all(np.array_equal(a, b) for a, b in zip(large.colours(0), again, strict=True))
