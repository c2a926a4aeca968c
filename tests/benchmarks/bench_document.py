"""Figures of the document: a thousand random edits, and two hundred kills while saving and solving."""

from __future__ import annotations

import multiprocessing
import os
import random
import shutil
import signal
import time
from multiprocessing.connection import Connection
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

from app.actions.session import Session
from app.model.edits import scene, tracks
from app.model.history import History
from app.model.values import ModelError
from app.storage.schema import document_from_json, document_to_json
from imitation.errors import InputError
from tests.app.strategies import EditMaker, edit_makers, start
from tests.benchmarks.record import Recorder
from tests.window.small_project import build_small_project

pytestmark = [pytest.mark.bench, pytest.mark.timeout(3600)]

EDITS, KILLS = 1000, 200


def random_makers() -> list[EditMaker]:
    """Some thousand edits of all kinds, the same in every run."""
    found: list[EditMaker] = []

    @seed(2026)
    @settings(max_examples=150, database=None, deadline=None, suppress_health_check=list(HealthCheck))
    @given(st.lists(edit_makers(), min_size=10, max_size=60))
    def collect(makers: list[EditMaker]) -> None:
        found.extend(makers)

    collect()
    return found


def test_a_thousand_edits(bench: Recorder) -> None:
    """Undone fully, done again fully, saved and loaded: exact; and what one undo takes."""
    history = History(start())
    makers = random_makers()
    random.Random(7).shuffle(makers)
    passed = 0
    while len(history.versions) <= EDITS:
        maker = makers[passed % len(makers)]
        passed += 1
        assert passed < 50 * EDITS, "the random edits do not fit the document"
        try:
            edit = maker(history.document)
        except ModelError:
            continue
        history.apply(edit.document, edit.label)
    versions = [version.document for version in history.versions]
    spent, wrong = [], 0
    for expected in reversed(versions[:-1]):
        begin = time.perf_counter()
        history.undo()
        spent.append(time.perf_counter() - begin)
        wrong += history.document != expected
    for expected in versions[1:]:
        history.redo()
        wrong += history.document != expected
    step = max(1, EDITS // 50)
    for document in [*versions[::step], versions[-1]]:
        data = document_to_json(document)
        again = document_from_json(data, "this run")
        wrong += again != document or document_to_json(again) != data
    bench.record(
        f"document: of {EDITS} random edits, versions that differ after undo, redo, save and load",
        wrong,
        asked=0,
        note=f"{passed} edits tried; every {step}th version stored",
    )
    bench.record("document: one undo, slowest", 1e3 * max(spent), asked=1.0, unit="ms")


def work(folder: Path, said: Connection, number: int) -> None:
    """Edit, solve, autosave and save without end; say which edit was stored for certain."""
    session = Session.open(folder, recover=True)
    track = session.document.tracks[0].id
    said.send(number)
    while True:
        number += 1
        session.apply(scene.rename(session.document, f"film {number}"))
        session.apply(tracks.set_click(session.document, track, 12, (100.0 + number % 50, 90.0)))
        session.start("Following points", (session.stages.track(track),))
        if number % 7:
            session.autosave()
        else:
            session.save()
        said.send(number)


def test_kills(bench: Recorder, tmp_path: Path) -> None:
    """A process that edits, solves and saves is killed at random moments; then the project is opened."""
    template = build_small_project(tmp_path)
    folder = tmp_path / "victim.motionwright"
    shutil.copytree(template, folder)
    moments = random.Random(11)
    lost = broken = number = 0
    context = multiprocessing.get_context("fork")
    for _ in range(KILLS):
        ours, theirs = context.Pipe(duplex=False)
        child = context.Process(target=work, args=(folder, theirs, number))
        child.start()
        theirs.close()
        stored = ours.recv()
        end = time.monotonic() + moments.uniform(0.0, 0.25)
        while time.monotonic() < end:
            if ours.poll(0.002):
                stored = ours.recv()
        os.kill(child.pid or 0, signal.SIGKILL)
        child.join()
        while True:
            try:
                stored = ours.recv()
            except EOFError:
                break
        try:
            session = Session.open(folder, recover=True)
        except (InputError, OSError, ValueError) as error:
            broken += 1
            print(f"could not be opened: {error!r}")
            continue
        name = session.document.name
        found = int(name.split()[1]) if name.startswith("film ") else 0
        lost += found < stored
        number = max(stored, found)
        session.save()
        session.close()
    stray = [path for path in folder.rglob("*") if "tmp" in path.suffix or path.name.startswith(".")]
    bench.record(
        f"document: of {KILLS} kills while editing, solving and saving, projects that do not open",
        broken,
        asked=0,
        note=f"{number} edits in all, {len(stray)} stray files left",
    )
    bench.record(f"document: of {KILLS} kills, autosaved edits lost", lost, asked=0)
