"""How long the film of a character that stands in the scene takes, from the sample as a user has it."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import attrs
import pytest

from app.actions.backgrounds import plate_film
from app.actions.compositing import SHUTTER, Standing
from app.actions.films import render_film
from app.actions.previewing import Previewer
from app.actions.rendering import FilmOrder
from app.actions.sample import fill_with_sample
from app.actions.session import Session
from app.stages.job import Job
from imitation.progress import Progress
from tests.benchmarks.record import Recorder

pytestmark = [pytest.mark.bench, pytest.mark.timeout(3600)]


PLAIN = Standing(occlusion=True, shadow=True, plate=True)
WHOLE = Standing(occlusion=True, shadow=True, plate=True, match_light=True, shutter=SHUTTER, grain=None)


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    """The sample with its first character animated and the background measured."""
    with closing(Session.new(tmp_path_factory.mktemp("bench") / "sample.motionwright")) as session:
        fill_with_sample(session)
        one = session.document.characters[0].id
        session.runner.run("", (session.stages.animation(one), *PLAIN.stages(session)))
        yield session


def test_a_composite_of_the_sample(bench: Recorder, sample: Session, tmp_path: Path) -> None:
    """81 frames of 960 x 540 with plate, shadow and occlusion, wall seconds; all else is computed before."""
    one, spent = sample.document.characters[0].id, {}
    render_film(sample, [one], tmp_path / "warm.mp4", view="video", standing=None)
    for name, standing in (("video alone", None), ("composite", PLAIN), ("whole", WHOLE)):
        start = time.monotonic(), time.process_time()
        render_film(sample, [one], tmp_path / "film.mp4", view="video", standing=standing)
        spent[name] = time.monotonic() - start[0], time.process_time() - start[1]
    bench.record("composite of 81 frames at 540p with plate, shadow, occlusion", spent["composite"][0], asked=60,
                 unit="s", baseline=spent["video alone"][0], baseline_name="drawn over the frames alone",
                 note=f"wall, {os.cpu_count()} cores; CPU {spent['composite'][1]:.0f} s; with light, motion blur and "
                 f"grain {spent['whole'][0]:.0f} s, CPU {spent['whole'][1]:.0f} s")  # fmt: skip


def test_the_preview_of_the_render_dialog(bench: Recorder, sample: Session) -> None:
    """The first picture of the dialog, another light on the same frame, and another frame; everything switched on."""
    order = FilmOrder((sample.document.characters[0].id,), standing=WHOLE)
    lit = attrs.evolve(order, standing=attrs.evolve(WHOLE, light_turn=30.0))
    previewer, spent = Previewer(), []
    for wish, frame in ((order, 40), (lit, 40), (lit, 41)):
        start = time.monotonic(), time.process_time()
        previewer.picture(sample, wish, frame)
        spent.append((time.monotonic() - start[0], time.process_time() - start[1]))
    names = ("first picture", "another light", "another frame")
    for name, (wall, used) in zip(names, spent, strict=True):
        bench.record(f"render dialog: {name} of the preview, 540p", used, unit="s CPU", note=f"wall {wall:.2f} s")


def test_cancel_by_the_clock(bench: Recorder, sample: Session, tmp_path: Path) -> None:
    """From the cancel to the end of the job: a film, plates, and depth of a fresh project, each while it is at work."""
    one = sample.document.characters[0].id

    def film(progress: Progress) -> None:
        render_film(sample, [one], tmp_path / "film.mp4", view="video", standing=WHOLE, progress=progress)

    def plates(progress: Progress) -> None:
        plate_film(sample, tmp_path / "plates.mp4", progress=progress)

    found = {}
    for name, work in (("film", film), ("plates", plates)):
        found[name] = [_ended(sample.runner.call(name, work), moment) for moment in (0.05, 0.11, 0.17)]
    with closing(Session.new(tmp_path / "fresh.motionwright")) as fresh:
        fill_with_sample(fresh)
        fresh.runner.run("", (fresh.stages.cameras, fresh.stages.masks))
        found["depth"] = [_ended(fresh.start("depth", (fresh.stages.depth,)), moment) for moment in (0.05, 0.1, 0.15)]
    for name, times in found.items():
        wall, used = max(times)
        bench.record(f"cancel: {name} at work, worst of {len(times)}", wall, asked=0.2, unit="s wall",
                     note=f"CPU {used:.2f} s meanwhile")  # fmt: skip


def _ended(job: Job, fraction: float) -> tuple[float, float]:
    """Cancel a job when it is so far; wall and CPU seconds until it has ended."""
    while job.fraction < fraction and job.state == "running":
        time.sleep(0.005)
    start = time.monotonic(), time.process_time()
    job.cancel()
    job.wait()
    assert job.state == "cancelled"
    return time.monotonic() - start[0], time.process_time() - start[1]
