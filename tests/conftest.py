"""Shared fixtures: one thread for numeric libraries, where the real data lies, and the bench recorder."""

from __future__ import annotations

import os

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")

from pathlib import Path

import pytest

from tests.benchmarks.record import Recorder

REPOSITORY = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real clips and meshes beside the checkout; the test is skipped where it is not there."""
    folder = REPOSITORY.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("the real clips and meshes are not beside this checkout")
    return folder


@pytest.fixture
def bench(request: pytest.FixtureRequest) -> Recorder:
    """Records figures of ``make bench`` in build/bench.json."""
    return Recorder(REPOSITORY / "build" / "bench.json", request.node.nodeid)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave figures to ``make bench``: they are run only when asked for with ``-m bench``."""
    if "bench" not in (config.option.markexpr or ""):
        chosen = [item for item in items if "bench" not in item.keywords]
        config.hook.pytest_deselected(items=[item for item in items if "bench" in item.keywords])
        items[:] = chosen
