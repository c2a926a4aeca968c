"""The program that makes the sample world: bodies, gaits, scene, camera, picture, truth."""

from resources.world.body import Body, make_body
from resources.world.camera import make_camera
from resources.world.gait import Walk, walk
from resources.world.skeleton import OTHER, SUBJECT, Proportions
from resources.world.terrain import Stairs

__all__ = ["OTHER", "SUBJECT", "Body", "Proportions", "Stairs", "Walk", "make_body", "make_camera", "walk"]
