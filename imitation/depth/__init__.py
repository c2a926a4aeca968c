"""Dense depth of the background, what lies behind the subject, and the background as a mesh (paper A, 3.1)."""

from imitation.depth.checks import Range
from imitation.depth.collision import Collider, Penetration, penetration
from imitation.depth.completion import Background, Plate
from imitation.depth.depthmap import DepthMap
from imitation.depth.hiding import hiding_depth, shown_background
from imitation.depth.projection import projected
from imitation.depth.solve import DepthSolver, Sketch, background_depth
from imitation.depth.surface import BackgroundMesh, background_mesh, joined_mesh

__all__ = [
    "Background",
    "BackgroundMesh",
    "Collider",
    "DepthMap",
    "DepthSolver",
    "Penetration",
    "Plate",
    "Range",
    "Sketch",
    "background_depth",
    "background_mesh",
    "hiding_depth",
    "joined_mesh",
    "penetration",
    "projected",
    "shown_background",
]
