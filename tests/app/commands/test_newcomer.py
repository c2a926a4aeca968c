"""What a newcomer meets: a first try that fails, files that moved, a program that is asked to end."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from app.actions.sample import sample_folder
from app.commands.main import BAD_INPUT, DONE, STOPPED, run
from imitation.errors import InputError

CLIP, MESH = sample_folder() / "clip.mp4", sample_folder() / "hound.ply"


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """Run a verb that must refuse, and give its one sentence."""
    capsys.readouterr()
    assert run(list(map(str, arguments))) == BAD_INPUT
    said = capsys.readouterr().err.strip()
    assert said
    assert "\n" not in said
    return said


@pytest.mark.parametrize("option", ["--clip", "--character", "--marks"])
def test_a_failed_beginning_leaves_the_name_free(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """After a wrong file the same name is tried again, and works."""
    wrong = tmp_path / "wrong.mp4"
    wrong.write_text("no film")
    refused(capsys, "new", tmp_path / "deep" / "walk", option, wrong)
    assert not (tmp_path / "deep").exists()
    assert run(["new", str(tmp_path / "deep" / "walk"), "--clip", str(CLIP)]) == DONE


def test_a_failed_beginning_leaves_what_was_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder that was there before keeps what it held, and nothing more."""
    held = tmp_path / "walk.motionwright"
    held.mkdir()
    (held / "notes.txt").write_text("mine")
    (tmp_path / "wrong.ply").write_text("no mesh")
    refused(capsys, "new", held, "--clip", CLIP, "--copy", "--character", tmp_path / "wrong.ply")
    assert [each.name for each in held.iterdir()] == ["notes.txt"]


def test_sequences_that_fail_begin_no_project(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """``perform add`` makes a project only for what can be added."""
    (tmp_path / "takes").mkdir()
    refused(capsys, "perform", "add", tmp_path / "show", tmp_path / "takes")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["takes"]


@pytest.mark.parametrize("verb", ["new", "info", "check"])
def test_a_name_that_the_system_refuses_is_no_bug(
    verb: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Too long a name is told as such."""
    assert "too long" in refused(capsys, verb, tmp_path / ("a" * 300))


def test_missing_media_are_named_and_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """``info`` names what is missing, ``set --find`` looks for it by its content."""
    before, after = tmp_path / "before", tmp_path / "after"
    before.mkdir()
    (after / "films").mkdir(parents=True)
    clip, mesh = before / "Film Ü.mp4", before / "hound.ply"
    clip.write_bytes(CLIP.read_bytes())
    mesh.write_bytes(MESH.read_bytes())
    project = tmp_path / "walk"
    assert run(["new", str(project), "--clip", str(clip), "--character", str(mesh)]) == DONE
    clip.rename(after / "films" / clip.name)
    (after / mesh.name).write_text("another file of this name")
    mesh.unlink()

    def missing() -> Any:
        capsys.readouterr()
        assert run(["--json", "info", str(project)]) == DONE
        return json.loads(capsys.readouterr().out)["missing"]

    assert missing() == {"the clip": str(clip), "the mesh of hound": str(mesh)}
    assert "--find" in refused(capsys, "--quiet", "cameras", project)
    assert "hound.ply" in refused(capsys, "set", project, "--find", before)
    assert run(["set", str(project), "--find", str(after)]) == DONE
    assert missing() == {"the mesh of hound": str(mesh)}


@pytest.mark.parametrize("entry", ["main", "gui_main"])
def test_an_interrupt_while_the_program_is_loaded_ends_it_quietly(entry: str) -> None:
    """Ctrl+C before there is a command line to take it: one sentence, the usual exit code."""
    begin = f"""
import sys

class Interrupting:
    def find_spec(self, name, path, target=None):
        if name == "click":
            raise KeyboardInterrupt

from app.enter import {entry}
sys.meta_path.insert(0, Interrupting())
{entry}()
"""
    ended = subprocess.run([sys.executable, "-c", begin], capture_output=True, text=True, check=False)
    assert ended.returncode == STOPPED
    assert ended.stderr.strip() == "Stopped before anything was begun."


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="Windows has no such signals")
@pytest.mark.parametrize(
    ("sent", "begun"),
    [
        (signal.SIGINT, "default_int_handler"),
        (signal.SIGTERM, "default_int_handler"),
        (signal.SIGTERM, "SIG_IGN"),
        (signal.SIGKILL, "default_int_handler"),
    ],
)
def test_a_demonstration_that_is_stopped_goes_on(sent: signal.Signals, begun: str, tmp_path: Path) -> None:
    """Both its strands end with one sentence, whoever asks; killed or not, the project is whole.

    In the background of a script a program begins with Ctrl+C ignored, but is to end when it is asked to.
    """
    begin = f"import signal; signal.signal(signal.SIGINT, signal.{begun}); from app.enter import main; main()"
    program = [sys.executable, "-c", begin]
    with subprocess.Popen([*program, "demo", str(tmp_path)], stderr=subprocess.PIPE, text=True) as running:
        try:
            assert running.stderr is not None
            for line in running.stderr:
                if "takes" in line:
                    break
            running.send_signal(sent)
            said, ended = running.stderr.read(), running.wait(60)
        finally:
            running.kill()
    if sent is signal.SIGKILL:
        assert ended == -sent
    else:
        assert ended == STOPPED
        assert said.strip().splitlines()[-1].startswith("Stopped.")
        assert "stack trace" not in said
        assert not list(tmp_path.rglob("*.part*"))
    assert subprocess.run([*program, "info", str(tmp_path / "sample")], capture_output=True, check=True).stdout


def test_a_demonstration_that_was_cut_off_at_its_beginning_begins_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A full disk, or a kill, may leave the project without the sample in it: the next run brings it in."""
    from app.actions.session import Session
    from app.commands import demo

    fill = demo.fill_with_sample

    def full(session: Session, *, copy: bool) -> None:
        raise InputError("The disk is full.")

    monkeypatch.setattr(demo, "fill_with_sample", full)
    monkeypatch.setattr(demo, "together", lambda *_: [[], []])
    assert "full" in refused(capsys, "demo", tmp_path)
    monkeypatch.setattr(demo, "fill_with_sample", fill)
    for _ in range(2):
        assert run(["--quiet", "demo", str(tmp_path)]) == DONE
        with closing(Session.open(tmp_path / "sample")) as session:
            assert len(session.document.characters) == 2
