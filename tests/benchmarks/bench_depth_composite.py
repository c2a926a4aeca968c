"""How long the film of a character that stands in the scene takes, from the sample as a user has it."""

from __future__ import annotations

import os
import time
from contextlib import closing
from pathlib import Path

import pytest

from app.actions.compositing import SHUTTER, Standing
from app.actions.films import render_film
from app.actions.sample import fill_with_sample
from app.actions.session import Session
from tests.benchmarks.record import Recorder

pytestmark = [pytest.mark.bench, pytest.mark.timeout(3600)]


def test_a_composite_of_the_sample(bench: Recorder, tmp_path: Path) -> None:
    """81 frames of 960 x 540 with plate, shadow and occlusion, wall seconds; all else is computed before."""
    plain = Standing(occlusion=True, shadow=True, plate=True)
    whole = Standing(occlusion=True, shadow=True, plate=True, match_light=True, shutter=SHUTTER, grain=None)
    with closing(Session.new(tmp_path / "sample.motionwright")) as session:
        fill_with_sample(session)
        one = session.document.characters[0].id
        session.runner.run("", (session.stages.animation(one), *plain.stages(session)))
        spent = {}
        render_film(session, [one], tmp_path / "warm.mp4", view="video", standing=None)
        for name, standing in (("video alone", None), ("composite", plain), ("whole", whole)):
            start = time.monotonic(), time.process_time()
            render_film(session, [one], tmp_path / "film.mp4", view="video", standing=standing)
            spent[name] = time.monotonic() - start[0], time.process_time() - start[1]
    bench.record("composite of 81 frames at 540p with plate, shadow, occlusion", spent["composite"][0], asked=60,
                 unit="s", baseline=spent["video alone"][0], baseline_name="drawn over the frames alone",
                 note=f"wall, {os.cpu_count()} cores; CPU {spent['composite'][1]:.0f} s; with light, motion blur and "
                 f"grain {spent['whole'][0]:.0f} s")  # fmt: skip
