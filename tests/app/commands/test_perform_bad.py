"""Bad sequences through ``perform``: one sentence, the exit code, within seconds, and no memory to speak of."""

from __future__ import annotations

import json
import struct
import time
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.commands.main import BAD_INPUT, DONE, NO_SOLUTION, run
from app.formats.tvm import FrameMesh, write_mesh_frames
from resources.performer import Part, perform

pytestmark = pytest.mark.xdist_group("captured")
SECONDS, MEGABYTES = 5.0, 100


def body(frame: int = 0) -> FrameMesh:
    """A coarse standing body."""
    capture = perform([Part("stand", 1)], fps=10, seed=1, cell=0.07)
    return FrameMesh(*capture.mesh(frame))


def folder(place: Path, frames: list[FrameMesh], form: str = "ply") -> Path:
    """A folder of them."""
    write_mesh_frames(place, frames, form=form, fps=25, count=len(frames), name="f")  # type: ignore[arg-type]
    return place


def nothing(place: Path, part: str) -> Path:
    """The first frame has no vertices, or no faces."""
    folder(place, [body(), body()])
    (place / "f_0000.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex "
        + ("0" if part == "vertices" else "1")
        + "\nproperty float x\nproperty float y\nproperty float z\nelement face 0\n"
        + "property list uchar int vertex_indices\nend_header\n"
        + ("" if part == "vertices" else "0 0 0\n")
    )
    return place


def not_a_number(place: Path) -> Path:
    """One vertex of the first frame is NaN."""
    mesh = body()
    vertices = mesh.vertices.copy()
    vertices[7, 1] = np.nan
    return folder(place, [FrameMesh(vertices, mesh.faces), body()])


def cut_off(place: Path) -> Path:
    """The first file ends in the middle."""
    file = sorted(folder(place, [body(), body()]).iterdir())[0]
    file.write_bytes(file.read_bytes()[:-500])
    return place


def lying(place: Path) -> Path:
    """A header that promises two thousand million vertices."""
    file = sorted(folder(place, [body(), body()]).iterdir())[0]
    data = file.read_bytes()
    count = data.split(b"element vertex ")[1].split(b"\n")[0]
    file.write_bytes(data.replace(b"element vertex " + count, b"element vertex 2000000000", 1))
    return place


def lying_glb(place: Path) -> Path:
    """An accessor that promises two thousand million positions."""
    file = sorted(folder(place, [body(), body()], "glb").iterdir())[0]
    data = file.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    tree = json.loads(data[20 : 20 + size])
    tree["accessors"][0]["count"] = 2_000_000_000
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + size :]
    head = struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON")
    file.write_bytes(head + text + rest)
    return place


def lying_npz(place: Path) -> Path:
    """An array whose header promises a terabyte."""
    target = place.with_suffix(".npz")
    with zipfile.ZipFile(target, "w") as archive:
        for name, shape in (("vertices", "(10, 9000000000, 3)"), ("faces", "(1, 3)")):
            text = f"{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
            archive.writestr(f"{name}.npy", b"\x93NUMPY\x01\x00" + struct.pack("<H", 118) + text.encode() + b"\0" * 64)
    return target


def mixed(place: Path) -> Path:
    """PLY and OBJ in one folder."""
    folder(place, [body(), body()])
    (place / "x.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")
    return place


CASES: dict[str, tuple[Callable[[Path], Path], str]] = {
    "no vertices": (lambda place: nothing(place, "vertices"), "no vertices"),
    "no faces": (lambda place: nothing(place, "faces"), "no faces"),
    "NaN": (not_a_number, "NaN or infinite"),
    "cut off": (cut_off, "cut off or damaged"),
    "lying PLY": (lying, "promises 2000000000 rows of vertex"),
    "lying GLB": (lying_glb, "not a whole GLB"),
    "lying npz": (lying_npz, "is not an npz of vertices"),
    "mixed formats": (mixed, "mixes formats"),
    "one frame": (lambda place: folder(place, [body()]), "at least two frames"),
}


@pytest.mark.parametrize("what", CASES)
def test_bad_sequences_are_refused_on_adding(what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit code 3, one sentence that says what is wrong, seconds and memory within bounds."""
    make, reason = CASES[what]
    path = make(tmp_path / "take")
    capsys.readouterr()
    tracemalloc.start()
    started = time.process_time()
    code = run(["perform", "add", str(tmp_path / "film"), str(path)])
    spent, used = time.process_time() - started, tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    said = capsys.readouterr().err.strip()
    assert code == BAD_INPUT
    assert reason in said
    assert len(said.splitlines()) == 1
    assert "Traceback" not in said
    assert spent < SECONDS
    assert used < MEGABYTES


def test_a_later_damaged_frame_is_named_when_it_is_read(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The sequence can be added; reading all of it says which file is damaged."""
    place = folder(tmp_path / "take", [body()] * 8)
    file = sorted(place.iterdir())[5]
    file.write_bytes(file.read_bytes()[:-300])
    facts = ["--up", "z", "--unit", "1", "--fps", "25"]
    assert run(["--quiet", "perform", "add", str(tmp_path / "film"), str(place), *facts]) == DONE
    capsys.readouterr()
    assert run(["--quiet", "perform", "analyse", str(tmp_path / "film")]) == BAD_INPUT
    said = capsys.readouterr().err.strip().splitlines()
    assert file.name in said[-1]
    assert not any("Traceback" in line for line in said)


def test_a_motionless_sequence_stays_whole(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One mesh thirty times: one motion, "hardly moves", and it can be played."""
    place = folder(tmp_path / "take", [body()] * 30)
    film = str(tmp_path / "film")
    assert run(["--quiet", "perform", "add", film, str(place), "--up", "z", "--unit", "1", "--fps", "25"]) == DONE
    capsys.readouterr()
    assert run(["--json", "perform", "analyse", film]) == DONE
    assert "hardly moves" in capsys.readouterr().out
    assert run(["--quiet", "perform", "compose", film, "--key", "take/1"]) == DONE


def test_a_graph_of_two_nodes_composes_in_both_modes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two takes of one motion each: by default they are joined; as printed the only edge needs a mu over 1."""
    film = str(tmp_path / "film")
    for number, name in enumerate(("walk", "squat")):
        capture = perform([Part(name, 4)], fps=10, seed=number, cell=0.06)
        frames = [FrameMesh(*capture.mesh(k)) for k in range(len(capture))]
        place = folder(tmp_path / name, frames)
        assert run(["--quiet", "perform", "add", film, str(place), "--up", "z", "--unit", "1", "--fps", "10"]) == DONE
    keys = ["--key", "walk/1", "--key", "squat/1"]
    assert run(["--quiet", "perform", "compose", film, *keys]) == DONE
    capsys.readouterr()
    code = run(["perform", "compose", film, *keys, "--graph", "paper"])
    said = capsys.readouterr().err
    assert code == NO_SOLUTION
    assert "smallest mu" in said
    assert "Traceback" not in said
