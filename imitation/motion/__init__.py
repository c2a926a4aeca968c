"""Anchors (paper A, 3.2), track transfer (3.3), lifting and depth smoothing (3.5)."""

from imitation.motion.anchors import anchor_depths
from imitation.motion.contacts import Contact
from imitation.motion.keys import KeyTracks, key_tracks
from imitation.motion.lifting import Lift, LiftSettings, lift_tracks
from imitation.motion.polishing import pixel_noise, polish
from imitation.motion.smoothing import smooth_depths
from imitation.motion.transfer import transfer_track

__all__ = [
    "Contact",
    "KeyTracks",
    "Lift",
    "LiftSettings",
    "anchor_depths",
    "key_tracks",
    "lift_tracks",
    "pixel_noise",
    "polish",
    "smooth_depths",
    "transfer_track",
]
