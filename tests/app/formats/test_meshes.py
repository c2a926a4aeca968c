"""Meshes: every vertex in its place in five formats, and one sentence about each kind of broken file."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from app.formats import read_mesh, write_mesh
from imitation.errors import InputError

SUFFIXES = (".ply", ".obj", ".off", ".glb")


@st.composite
def meshes(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Any triangles over any single-precision points: coincident and unused vertices, repeated faces, slivers."""
    count = draw(st.integers(1, 30))
    values = st.floats(-1e6, 1e6, width=32, allow_subnormal=False)
    vertices = draw(hnp.arrays(np.float32, (count, 3), elements=values)).astype(np.float64)
    faces = draw(hnp.arrays(np.int32, (draw(st.integers(1, 40)), 3), elements=st.integers(0, count - 1)))
    colors = draw(st.none() | hnp.arrays(np.uint8, (count, 3)))
    return vertices, faces, colors


@pytest.mark.parametrize("suffix", SUFFIXES)
@settings(deadline=None, max_examples=60)
@given(mesh=meshes(), with_normals=st.booleans())
def test_every_vertex_and_face_comes_back(
    tmp_path_factory: pytest.TempPathFactory,
    suffix: str,
    mesh: tuple[np.ndarray, np.ndarray, np.ndarray | None],
    with_normals: bool,
) -> None:
    """Writing and reading gives the same vertices, faces and colours in the same order, with normals or without."""
    vertices, faces, colors = mesh
    path = tmp_path_factory.getbasetemp() / f"mesh{suffix}"
    normals = np.tile([0.0, 0.6, 0.8], (len(vertices), 1)) if with_normals else None
    write_mesh(path, vertices, faces, colors, normals=normals)
    back = read_mesh(path)
    np.testing.assert_array_equal(back.vertices.astype(np.float32), vertices.astype(np.float32))
    np.testing.assert_array_equal(back.faces, faces)
    if colors is None:
        assert back.colors is None
    else:
        np.testing.assert_array_equal(back.colors, colors)
    assert back.up == ("z" if suffix == ".glb" else None)


@settings(deadline=None, max_examples=60)
@given(mesh=meshes())
def test_stl_keeps_the_triangles(
    tmp_path_factory: pytest.TempPathFactory, mesh: tuple[np.ndarray, np.ndarray, np.ndarray | None]
) -> None:
    """STL keeps where each corner of each face is, and no two vertices share a place."""
    vertices, faces, _ = mesh
    path = tmp_path_factory.getbasetemp() / "mesh.stl"
    write_mesh(path, vertices, faces)
    back = read_mesh(path)
    np.testing.assert_array_equal(back.vertices[back.faces], vertices[faces])
    assert len(np.unique(back.vertices, axis=0)) == len(back.vertices)


@settings(deadline=None, max_examples=40)
@given(vertices=hnp.arrays(np.float64, (5, 3), elements=st.floats(-1e9, 1e9)))
def test_exact_ply_keeps_double_precision(tmp_path_factory: pytest.TempPathFactory, vertices: np.ndarray) -> None:
    """On request PLY keeps all bits."""
    path = tmp_path_factory.getbasetemp() / "exact.ply"
    write_mesh(path, vertices, [[0, 1, 2], [2, 3, 4]], exact=True)
    np.testing.assert_array_equal(read_mesh(path).vertices, vertices)


def _ball() -> tuple[np.ndarray, np.ndarray]:
    """A ball with coincident vertices, an unused vertex, and texture-like doubled seams."""
    import trimesh

    ball = trimesh.creation.uv_sphere(count=[12, 12])
    vertices = np.concatenate([ball.vertices, ball.vertices[:5], [[9.0, 9.0, 9.0]]]).astype(np.float32)
    faces = np.concatenate([ball.faces, ball.faces[:3] * 0 + np.arange(3) + len(ball.vertices)])
    return vertices.astype(np.float64), faces.astype(np.int32)


@pytest.mark.parametrize("suffix", [".ply", ".off", ".glb"])
def test_another_reader_sees_the_same(tmp_path: Path, suffix: str) -> None:
    """What is written is what trimesh reads, vertex by vertex (GLB turned to Y up)."""
    import trimesh

    vertices, faces = _ball()
    write_mesh(tmp_path / f"mesh{suffix}", vertices, faces)
    other = trimesh.load(tmp_path / f"mesh{suffix}", process=False, maintain_order=True, force="mesh")
    expected = vertices[:, [0, 2, 1]] * [1, 1, -1] if suffix == ".glb" else vertices
    np.testing.assert_allclose(other.vertices, expected, atol=1e-9)
    np.testing.assert_array_equal(other.faces, faces)


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".off", ".stl", ".glb"])
def test_what_another_writer_writes_is_read(tmp_path: Path, suffix: str) -> None:
    """What trimesh exports, text PLY and OBJ with normals included, is read with its places."""
    import trimesh

    vertices, faces = _ball()
    mesh = trimesh.Trimesh(vertices, faces, process=False, maintain_order=True)
    options = {".ply": {"encoding": "ascii"}, ".obj": {"include_normals": True}}.get(suffix, {})
    mesh.export(tmp_path / f"mesh{suffix}", **options)
    back = read_mesh(tmp_path / f"mesh{suffix}")
    expected = vertices[:, [0, 2, 1]] * [1, -1, 1] if suffix == ".glb" else vertices
    np.testing.assert_allclose(back.vertices[back.faces], expected[faces], atol=1e-6)
    if suffix != ".stl":
        assert len(back.vertices) == len(vertices)


def test_real_characters_are_read_as_they_are(shared_data: Path) -> None:
    """Vertex order and number of every real character agree with an independent reader."""
    import trimesh

    for path in sorted((shared_data / "characters").glob("*.ply")):
        mesh = read_mesh(path)
        other = trimesh.load(path, process=False, maintain_order=True)
        np.testing.assert_array_equal(mesh.vertices, other.vertices, err_msg=path.name)
        np.testing.assert_array_equal(mesh.faces, other.faces, err_msg=path.name)


def test_text_ply_with_polygons_and_other_elements(tmp_path: Path) -> None:
    """Quads are split, further elements and properties are passed over, colours of floats count as 0 to 1."""
    (tmp_path / "a.ply").write_text(
        "ply\nformat ascii 1.0\ncomment made by hand\nelement camera 1\nproperty list uchar float view\n"
        "element vertex 5\nproperty double x\nproperty double y\nproperty double z\nproperty float red\n"
        "property float green\nproperty float blue\nelement face 2\nproperty list uchar int vertex_index\n"
        "property uchar flags\nend_header\n3 1 2 3\n0 0 0 1 0 0\n1 0 0 0 1 0\n1 1 0 0 0 1\n0 1 0 1 1 1\n0 2 .5 0 0 0\n"
        "4 0 1 2 3 7\n3 3 2 4 7\n"
    )
    mesh = read_mesh(tmp_path / "a.ply")
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [3, 2, 4]]
    assert mesh.vertices[4].tolist() == [0, 2, 0.5]
    assert mesh.colors is not None
    assert mesh.colors[:3].tolist() == [[255, 0, 0], [0, 255, 0], [0, 0, 255]]


@pytest.mark.parametrize("order", ["<", ">"])
def test_binary_ply_of_either_order_with_mixed_polygons(tmp_path: Path, order: str) -> None:
    """Big- and little-endian files with triangles and quads are read row by row."""
    name = "binary_little_endian" if order == "<" else "binary_big_endian"
    header = (
        f"ply\nformat {name} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    body = np.arange(12, dtype=order + "f4").tobytes()
    body += (
        b"\x03" + np.array([0, 1, 2], order + "u4").tobytes() + b"\x04" + np.array([0, 1, 2, 3], order + "u4").tobytes()
    )
    (tmp_path / "a.ply").write_bytes(header.encode() + body)
    mesh = read_mesh(tmp_path / "a.ply")
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3]]
    assert mesh.vertices.tolist() == np.arange(12.0).reshape(4, 3).tolist()


def test_obj_with_all_kinds_of_corners(tmp_path: Path) -> None:
    """Normals and textures a corner do not double vertices; negative numbers and continued lines are understood."""
    (tmp_path / "a.obj").write_text(
        "# a comment\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nvt 0 0\nvn 0 0 1\nvn 0 1 0\n"
        "f 1/1/1 2/1/2 3//1 \\\n 4\nf -5 -4 -3\n"
    )
    mesh = read_mesh(tmp_path / "a.obj")
    assert len(mesh.vertices) == 5
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 2]]


def test_nan_vertices_no_faces_and_faces_out_of_range(tmp_path: Path) -> None:
    """Each is refused in a sentence that says where."""
    triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    for text, words in [
        ("v 0 0 0\nv nan 0 0\nv 0 1 inf\nf 1 2 3\n", r"2 vertices that are NaN or infinite \(the first is 1\)"),
        (triangle, "has no faces"),
        (triangle + "f 1 2\n", "has no faces"),
        (triangle + "f 1 2 3\nf 1 2 4\n", "Face 1 of the mesh bad.obj names a vertex outside 0 to 2"),
        (triangle + "f 1 2 -9\n", "outside 0 to 2"),
        (triangle + "f 1 2 99999999999999\n", "impossible vertex numbers"),
        (triangle + "f 1 2 x\n", "Line 4"),
        ("v 0 0\n", "Line 1"),
        ("hello\n", "has no vertices"),
    ]:
        (tmp_path / "bad.obj").write_text(text)
        with pytest.raises(InputError, match=words) as caught:
            read_mesh(tmp_path / "bad.obj")
        assert "\n" not in str(caught.value)
    with pytest.raises(InputError, match="has no faces"):
        write_mesh(tmp_path / "a.ply", [[0, 0, 0]], np.zeros((0, 3), int))


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
@pytest.mark.parametrize("element", ["vertex", "face"])
def test_lying_ply_headers_ask_for_no_memory(tmp_path: Path, form: str, element: str) -> None:
    """A header that promises a million million rows is refused at once."""
    counts = {"vertex": 3, "face": 1, element: 10**12}
    (tmp_path / "a.ply").write_text(
        f"ply\nformat {form} 1.0\nelement vertex {counts['vertex']}\nproperty float x\nproperty float y\n"
        f"property float z\nelement face {counts['face']}\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n             \n"
    )
    tracemalloc.start()
    with pytest.raises(InputError, match="promises 1000000000000 rows"):
        read_mesh(tmp_path / "a.ply")
    assert tracemalloc.get_traced_memory()[1] < 1 << 20
    tracemalloc.stop()


def test_lists_longer_than_the_file_are_refused(tmp_path: Path) -> None:
    """A polygon that claims four thousand million corners is damage, not a reason to ask for memory."""
    header = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uint int vertex_indices\nend_header\n"
    )
    (tmp_path / "a.ply").write_bytes(header.encode() + b"\0" * 12 + b"\xff\xff\xff\xff" + b"\0" * 40)
    with pytest.raises(InputError, match="cut off or damaged"):
        read_mesh(tmp_path / "a.ply")


@pytest.mark.parametrize("suffix", [*SUFFIXES, ".stl"])
@settings(deadline=None, max_examples=80)
@given(data=st.data())
def test_damaged_files_never_crash(tmp_path_factory: pytest.TempPathFactory, suffix: str, data: st.DataObject) -> None:
    """Cut off anywhere, or with bytes changed, a file gives a mesh or an InputError, nothing else."""
    path = tmp_path_factory.getbasetemp() / f"damaged{suffix}"
    write_mesh(
        path, np.arange(30.0).reshape(10, 3) % 7, [[0, 1, 2], [3, 4, 5], [7, 8, 9]], np.full((10, 3), 9, np.uint8)
    )
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(0, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(content[: data.draw(st.integers(1, len(content)))])
    try:
        mesh = read_mesh(path)
    except InputError:
        return
    assert np.isfinite(mesh.vertices).all()
    assert mesh.faces.max() < len(mesh.vertices)


def test_files_that_are_no_meshes(tmp_path: Path) -> None:
    """Missing, unknown, empty and foreign files are named."""
    (tmp_path / "a.fbx").write_text("x")
    (tmp_path / "empty.ply").touch()
    for suffix in (".ply", ".off", ".glb", ".gltf", ".stl"):
        (tmp_path / f"text{suffix}").write_text("this is no mesh")
        with pytest.raises(InputError, match=f"text{suffix}"):
            read_mesh(tmp_path / f"text{suffix}")
    for name, words in [("a.fbx", "no mesh that can be read"), ("b.ply", "does not exist"), ("empty.ply", "is empty")]:
        with pytest.raises(InputError, match=words):
            read_mesh(tmp_path / name)
    with pytest.raises(InputError, match="cannot be written as"):
        write_mesh(tmp_path / "a.fbx", np.eye(3), [[0, 1, 2]])
