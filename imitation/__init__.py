"""Engine of motion imitation from a handheld video: arrays in, arrays out (Zhang et al., "Motion Imitation with a Handheld Camera")."""

from imitation.cameras import CameraPath
from imitation.errors import Cancelled, InputError, NoSolution
from imitation.geometry import Camera

__all__ = ["Camera", "CameraPath", "Cancelled", "InputError", "NoSolution"]
