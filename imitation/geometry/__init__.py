"""Meshes, Laplacians, rotations, projections: shared by both engines."""

from imitation.geometry.measures import (
    edge_stretch,
    is_closed,
    mesh_volume,
    unique_edges,
    vertex_normals,
    volume_gradient,
)
from imitation.geometry.prepare import PreparedMesh, check_mesh, prepare_mesh
from imitation.geometry.projection import Camera
from imitation.geometry.regions import geodesic_regions, key_adjacency
from imitation.geometry.rotations import (
    axis_rotation,
    kabsch,
    nearest_rotation,
    quaternion_matrix,
    quaternion_of,
    quaternion_product,
    rotation_of,
)

__all__ = [
    "Camera",
    "PreparedMesh",
    "axis_rotation",
    "check_mesh",
    "edge_stretch",
    "geodesic_regions",
    "is_closed",
    "kabsch",
    "key_adjacency",
    "mesh_volume",
    "nearest_rotation",
    "prepare_mesh",
    "quaternion_matrix",
    "quaternion_of",
    "quaternion_product",
    "rotation_of",
    "unique_edges",
    "vertex_normals",
    "volume_gradient",
]
