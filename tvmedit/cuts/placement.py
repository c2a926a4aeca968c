"""Where the performer stands: every clip is placed where the one before it would have gone on."""

from __future__ import annotations

import attrs
import numpy as np

from tvmedit.analysis import Analysis
from tvmedit.cuts.alignment import GroundMove, align_frames
from tvmedit.graph.motion_graph import MotionGraph
from tvmedit.graph.performance import Cut, Performance

WINDOW = (-1, 0, 1)
"""Frames around a joint that share one move."""
CARRIED = 3
"""Frames at the end of a sequence by which the body is carried on where nothing follows."""
Joint = tuple[int, int, int, int]
"""Sequence and frame left, sequence and frame entered."""


def align_performance(
    graph: MotionGraph, performance: Performance, *, known: dict[Joint, GroundMove] | None = None
) -> Performance:
    """Place all clips of a performance.

    At a cut from frame a to frame b, b is laid onto a + 1, the frame that would have come, so that travel, turning
    and speed go on; at a wrap, the first frame onto the one after the last. Where the sequence ends with a, b is laid
    onto a and carried on as the body moved in the last frames. The moves accumulate: a walk walks on.

    Parameters
    ----------
    graph : MotionGraph
    performance : Performance
        As ``compose`` makes it, aligned or not.
    known : dict, optional
        Moves of joints that were found before, in the same sequences; new ones are added.

    Returns
    -------
    Performance
        The same frames with ``transforms`` and the cuts' residuals. A loop's closing cut has its residual; the way
        from end to start is not forced to close.
    """
    known = {} if known is None else known
    transforms = np.zeros((len(performance), 3))
    here = GroundMove(0.0, 0.0, 0.0)
    cuts: list[Cut] = []
    position = 0
    for cut in performance.cuts:
        transforms[position : cut.position] = here.yaw, here.x, here.y
        position = cut.position
        move = joint_move(graph, cut, known)
        if cut.kind != "loop":
            here = here.after(move)
        cuts.append(attrs.evolve(cut, residual=move.residual))
    transforms[position:] = here.yaw, here.x, here.y
    return attrs.evolve(performance, transforms=transforms, cuts=tuple(cuts), aligned=True)


def joint_move(graph: MotionGraph, cut: Cut, known: dict[Joint, GroundMove] | None = None) -> GroundMove:
    """Move that lays the frame entered onto the successor of the frame left, in that frame's sequence."""
    source, target = graph.nodes[cut.source].sequence, graph.nodes[cut.target].sequence
    key = (source, cut.leave, target, cut.enter)
    if known is not None and key in known:
        return known[key]
    before, after = graph.analyses[source], graph.analyses[target]
    follows = min(cut.leave + 1, len(before) - 1)
    # The window is cut to what both sequences have: the two frames of a pair must lie equally far from the joint.
    shifts = [k for k in WINDOW if 0 <= follows + k < len(before) and 0 <= cut.enter + k < len(after)]
    yaw = float(before.headings[follows] - after.headings[cut.enter])
    move = align_frames(
        [after.samples[cut.enter + k] for k in shifts], [before.samples[follows + k] for k in shifts], yaw=yaw
    )
    if cut.leave + 1 > follows:
        move = _one_frame_on(before).after(move)
    if known is not None:
        known[key] = move
    return move


def _one_frame_on(analysis: Analysis) -> GroundMove:
    """Move of a body that goes on as it went in a sequence's last frames: what would have come was not filmed."""
    steps = min(CARRIED, len(analysis) - 1)
    if steps < 1:
        return GroundMove(0.0, 0.0, 0.0)
    turned = analysis.headings[-1] - analysis.headings[-1 - steps]
    yaw = float(np.angle(np.exp(1j * turned))) / steps
    c, s = np.cos(yaw), np.sin(yaw)
    x, y = analysis.centres[-1]
    ahead = analysis.centres[-1] + (analysis.centres[-1] - analysis.centres[-1 - steps]) / steps
    return GroundMove(yaw, float(ahead[0] - c * x + s * y), float(ahead[1] - s * x - c * y))
