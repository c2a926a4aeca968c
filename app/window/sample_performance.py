"""The sample performance: the hound's takes are made in the background, then joined with its filmed walk."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from app.stages.job import Job
from app.stages.stage import Stage
from app.window.sample import sample_session

if TYPE_CHECKING:
    from app.window.project import Project
    from app.window.shell import Shell


def open_sample_performance(shell: Shell) -> None:
    """Open the sample in the Motion graph; takes, motions, key motions follow as they are ready."""
    from app.actions.performing_sample import TAKES, make_takes

    shell.open_session(sample_session())
    shell.show_workspace("performance")
    project, opened = shell.project, shell.opened
    if project is None or opened is None:
        return
    folder = tempfile.TemporaryDirectory(prefix="motionwright-")
    target = Path(folder.name) / f"{TAKES}.npz"
    made = project.call("Making the hound's takes", lambda progress: make_takes(target, progress=progress))

    def ended(job: Job) -> None:
        if job is not made:
            return
        project.job_ended.disconnect(ended)
        if job.state == "done":
            _join(project, target)
            opened.keeper.run_performance()
        folder.cleanup()

    project.job_ended.connect(ended)
    project.closing.connect(folder.cleanup)


def _join(project: Project, takes: Path) -> None:
    """Add both sequences; key motions are chosen once the graph is there."""
    from app.actions.performing_sample import choose_sample_keys, join_sample

    join_sample(project.session, takes)

    def finished(stage: Stage) -> None:
        if stage.name == "graph":
            project.stage_finished.disconnect(finished)
            if not project.document.performance.keys:
                choose_sample_keys(project.session)
                project.session.history.mark_saved()

    project.stage_finished.connect(finished)
