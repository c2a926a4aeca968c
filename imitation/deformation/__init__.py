"""Detail-preserving deformation (paper A, 3.4)."""

from imitation.deformation.constraints import FrameConstraints
from imitation.deformation.deformer import Deformer
from imitation.deformation.pose import Pose
from imitation.deformation.session import DragSession

__all__ = ["Deformer", "DragSession", "FrameConstraints", "Pose"]
