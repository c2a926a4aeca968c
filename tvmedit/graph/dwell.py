"""How long a motion is played between entry and exit, every frame at least once (paper B, sections 5 and 8)."""

from __future__ import annotations

from tvmedit.graph.database import Node


def least_dwell(node: Node, entry: int, leave: int) -> int:
    """Fewest frames from an entry to the frame after which the node is left, such that every frame plays once.

    entry and leave are frames of the node's sequence, first <= frame <= last. A texton of n frames plays
    n + ((leave - entry + 1) mod n); further repeats add n each.
    """
    count = len(node)
    return count + (leave - entry + 1) % count


def dwell_frames(node: Node, entry: int, count: int) -> list[int]:
    """Frames played from an entry on, going round from last to first."""
    size = len(node)
    return [node.first + (entry - node.first + k) % size for k in range(count)]
