"""Interactive point tracking (paper A, Appendix), dense flow, and masks carried through a clip."""

from imitation.tracking.clip import PreparedClip, prepare_clip
from imitation.tracking.flow import FlowField, compute_flow
from imitation.tracking.masks import carry_masks
from imitation.tracking.outlines import Outline, fill_outlines
from imitation.tracking.paper import PaperOptions
from imitation.tracking.point import track_point, track_span
from imitation.tracking.robust import RobustOptions
from imitation.tracking.suggest import rank_tracks, suggest_correction
from imitation.tracking.track import Span, SpanPlan, Track, assemble_track, plan_spans

__all__ = [
    "FlowField",
    "Outline",
    "PaperOptions",
    "PreparedClip",
    "RobustOptions",
    "Span",
    "SpanPlan",
    "Track",
    "assemble_track",
    "carry_masks",
    "compute_flow",
    "fill_outlines",
    "plan_spans",
    "prepare_clip",
    "rank_tracks",
    "suggest_correction",
    "track_point",
    "track_span",
]
