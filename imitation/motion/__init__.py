"""Anchors (paper A, 3.2), track transfer (3.3), lifting and depth smoothing (3.5)."""

from imitation.motion.alignment import Similarity, align_character
from imitation.motion.anchors import anchor_depths
from imitation.motion.contacts import Contact
from imitation.motion.footing import lifted_feet
from imitation.motion.keys import KeyTracks, key_tracks
from imitation.motion.lifting import Lift, LiftSettings, lift_tracks
from imitation.motion.polishing import pixel_noise, polish
from imitation.motion.proposals import propose_contacts
from imitation.motion.smoothing import smooth_depths
from imitation.motion.symmetry import mirror_motion
from imitation.motion.transfer import transfer_track

__all__ = [
    "Contact",
    "KeyTracks",
    "Lift",
    "LiftSettings",
    "Similarity",
    "align_character",
    "anchor_depths",
    "key_tracks",
    "lift_tracks",
    "lifted_feet",
    "mirror_motion",
    "pixel_noise",
    "polish",
    "propose_contacts",
    "smooth_depths",
    "transfer_track",
]
