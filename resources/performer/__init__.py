"""A performer whose every motion is known: labelled time-varying meshes, meshed anew in every frame."""

from resources.performer.captures import (
    broken_capture,
    capture_options,
    drifting,
    random_script,
    similar_script,
    single,
)
from resources.performer.mesher import body_mesh
from resources.performer.motions import MOTIONS, PERIODS, motion_pose
from resources.performer.sequence import Capture, Part, perform
from resources.performer.skeleton import JOINTS, body_capsules, body_joints

__all__ = [
    "JOINTS",
    "MOTIONS",
    "PERIODS",
    "Capture",
    "Part",
    "body_capsules",
    "body_joints",
    "body_mesh",
    "broken_capture",
    "capture_options",
    "drifting",
    "motion_pose",
    "perform",
    "random_script",
    "similar_script",
    "single",
]
