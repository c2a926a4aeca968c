"""How the measuring of the background stands, in words, and what can be asked for."""

from __future__ import annotations

from dataclasses import dataclass

from app.stages.job import Job
from app.stages.stage import Stage
from app.window.project import Project

LABEL = "Measuring the background"
FLAT = {
    "static": "The camera stands still: the pictures show no depth.",
    "rotation": "The camera only turns: the pictures show no depth.",
    "planar": "The background is one flat surface: there is no other depth to measure.",
    "failed": "The cameras could not be solved: nothing can be measured.",
}


@dataclass(frozen=True)
class BackgroundState:
    """State for the list of steps, a few words, one sentence, and the command that helps: measure, stop, contacts."""

    state: str
    text: str
    sentence: str
    action: str = "measure"

    @property
    def ready(self) -> bool:
        """Whether there is something to show."""
        return self.state == "done"


def measuring(project: Project) -> Job | None:
    """The job that measures the background, if one is under way."""
    key = project.session.stages.depth.key
    return next((job for job in project.progress if any(each.key == key for each in job.targets)), None)


def _under_way(project: Project) -> float | None:
    """The share that is done where something else has it measured, such as a film that needs it; None where nothing."""
    if not project.progress:
        return None
    depth = project.session.stages.depth
    states = [project.state(each) for each in depth.closure() if each.name.split("/")[0] == depth.name]
    return states.count("fresh") / len(states) if "running" in states else None


def background_state(project: Project) -> BackgroundState:
    """How it stands."""
    stages = project.session.stages
    depth, state = stages.depth, project.state(stages.depth)
    job = measuring(project)
    if job is not None:
        text = f"{100 * project.progress[job][0]:.0f} %"
        return BackgroundState("running", f"being measured, {text}", f"{LABEL}: {text}.", "stop")
    if state == "fresh":
        if project.state(stages.world) == "fresh":
            count = _key_frames(project, depth)
            document = project.document
            offer = document.world.ground == "local" and any(track.contacts for track in document.tracks)
            return BackgroundState("done", count, f"Measured: {count}.", "contacts" if offer else "")
        return BackgroundState("stale", "the ground is missing", "The ground has to be laid again.")
    share = _under_way(project)
    if share is not None:
        text = f"{100 * share:.0f} %"
        return BackgroundState("running", f"being measured, {text}", f"{LABEL}: {text}.", "")
    reason = why_unmeasured(project)
    if reason:
        return BackgroundState("failed", reason, reason)
    if state == "blocked":
        reason = depth.why_blocked() or "Something is missing."
        return BackgroundState("optional", reason[:1].lower() + reason[1:].rstrip("."), reason, "")
    path = project.result(stages.cameras)
    if path is not None and path.verdict in FLAT:
        return BackgroundState("optional", "no depth to be seen", FLAT[path.verdict], "")
    if state == "stale":
        return BackgroundState("stale", "out of date", "What it was measured from has changed.")
    return BackgroundState("optional", "not measured", "It has not been measured yet.")


def why_unmeasured(project: Project) -> str:
    """Why measuring failed, in one sentence; empty where it did not, or was not tried."""
    depth, runner = project.session.stages.depth, project.session.runner
    if depth in project.session.cache:
        return ""
    return next((reason for stage in depth.closure() if (reason := runner.why_failed(stage))), "")


def _key_frames(project: Project, depth: Stage) -> str:
    """How many frames were measured: the plan says so, the maps themselves are large and stay where they are."""
    plan = next((each for each in depth.needs if each.name == "depth/plan"), None)
    found = project.result(plan) if plan is not None else None
    return f"{len(found.keys)} key frames" if found is not None else "measured"


def measure(project: Project) -> None:
    """Measure the background, and lay the ground where it is missing."""
    stages = project.session.stages
    project.start(LABEL, stages.depth, stages.world)


def stop(project: Project) -> None:
    """Stop measuring; key frames that are finished stay where they are results of their own."""
    job = measuring(project)
    if job is not None:
        job.cancel()
