"""Files from and for the outside: video, images, masks, meshes, sequences, cameras, tracks."""

from app.formats.cameras import read_cameras, write_cameras
from app.formats.images import ImageFrames, open_images, read_image, write_image
from app.formats.masks import read_mask, read_masks, write_mask
from app.formats.meshes import read_mesh, write_mesh
from app.formats.meshfile import MeshFile
from app.formats.sequence import MeshSequence
from app.formats.sequences import read_sequence, write_sequence
from app.formats.source import FrameSource, Picture
from app.formats.tracks import TrackFile, read_tracks, write_tracks
from app.formats.video import VideoFrames, open_video
from app.formats.video_write import write_video, write_working_copy

__all__ = [
    "FrameSource",
    "ImageFrames",
    "MeshFile",
    "MeshSequence",
    "Picture",
    "TrackFile",
    "VideoFrames",
    "open_images",
    "open_video",
    "read_cameras",
    "read_image",
    "read_mask",
    "read_masks",
    "read_mesh",
    "read_sequence",
    "read_tracks",
    "write_cameras",
    "write_image",
    "write_mask",
    "write_mesh",
    "write_sequence",
    "write_tracks",
    "write_video",
    "write_working_copy",
]
