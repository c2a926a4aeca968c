"""A performer whose every motion is known: labelled time-varying meshes, meshed anew in every frame."""

from resources.performer.captures import (
    broken_capture,
    capture_options,
    drifting,
    random_script,
    similar_script,
    single,
)
from resources.performer.hound import HoundCapture, perform_hound
from resources.performer.hound_motions import HOUND_MOTIONS, HOUND_PERIODS
from resources.performer.mesher import body_mesh
from resources.performer.motions import MOTIONS, PERIODS, motion_pose
from resources.performer.script import Part
from resources.performer.sequence import Capture, perform
from resources.performer.skeleton import JOINTS, body_capsules, body_joints

__all__ = [
    "HOUND_MOTIONS",
    "HOUND_PERIODS",
    "JOINTS",
    "MOTIONS",
    "PERIODS",
    "Capture",
    "HoundCapture",
    "Part",
    "body_capsules",
    "body_joints",
    "body_mesh",
    "broken_capture",
    "capture_options",
    "drifting",
    "motion_pose",
    "perform",
    "perform_hound",
    "random_script",
    "similar_script",
    "single",
]
