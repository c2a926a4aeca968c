"""Files from and for the outside: video, images, masks, meshes, sequences, cameras, tracks."""

from app.formats.images import ImageFrames, open_images, read_image, write_image
from app.formats.source import FrameSource, Picture
from app.formats.video import VideoFrames, open_video
from app.formats.video_write import write_video, write_working_copy

__all__ = [
    "FrameSource",
    "ImageFrames",
    "Picture",
    "VideoFrames",
    "open_images",
    "open_video",
    "read_image",
    "write_image",
    "write_video",
    "write_working_copy",
]
