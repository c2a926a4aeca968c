"""Commands of time, which here move the playhead of the performance, or of the sequence that is looked at."""

from __future__ import annotations

from collections.abc import Callable

from app.window.performance.state import PerformanceState

FASTEST = 8.0
CLIP_ONLY = {"range_in", "range_out", "range_all", "visited_back", "visited_on"}
"""Commands that belong to the clip, which is not in sight."""


class TimeCommands:
    """Plays, steps, and goes from cut to cut."""

    def __init__(self, state: PerformanceState) -> None:
        self.state = state

    def command(self, name: str) -> bool:
        """Do a command; says whether it was one."""
        place, last = self.state.place, max(self.state.places - 1, 0)
        steps = {
            "previous": place - 1,
            "next": place + 1,
            "back_ten": place - 10,
            "on_ten": place + 10,
            "first": 0,
            "last": last,
        }
        if name in steps:
            self.state.playback.stop()
            self.state.show_place(min(max(steps[name], 0), last))
            return True
        handlers: dict[str, Callable[[], object]] = {
            "play": self._play,
            "stop": self.state.playback.stop,
            "forward": lambda: self._shuttle(1),
            "backward": lambda: self._shuttle(-1),
            "previous_mark": lambda: self._to_cut(-1),
            "next_mark": lambda: self._to_cut(1),
            "next_problem": self._to_worst,
        }
        if name in handlers:
            handlers[name]()
        return name in handlers or name in CLIP_ONLY

    def _play(self) -> None:
        if self.state.playback.playing:
            self.state.playback.stop()
        else:
            self.state.play()

    def _shuttle(self, sign: int) -> None:
        speed = self.state.playback.speed
        faster = speed * 2 if speed * sign > 0 else float(sign)
        self.state.play(max(min(faster, FASTEST), -FASTEST))

    def _to_cut(self, sign: int) -> None:
        """Go to the cut before or after, and choose it."""
        performance = self.state.performance
        if performance is None:
            return
        here = self.state.position
        cuts = [
            (cut.position, number)
            for number, cut in enumerate(performance.cuts)
            if cut.kind == "cut" and (cut.position - here) * sign > 0
        ]
        if cuts:
            self._go(*(min(cuts) if sign > 0 else max(cuts)))

    def _to_worst(self) -> None:
        """Go to the cut whose step is seen most, then to the next."""
        placed = self.state.placed
        if placed is None:
            return
        scored = [
            (seam.score, seam.position, number)
            for number, seam in enumerate(placed.seams)
            if seam.kind == "cut" and seam.position < self.state.frame_count
        ]
        order = [(position, number) for _, position, number in sorted(scored, reverse=True)]
        if order:
            numbers = [number for _, number in order]
            after = numbers.index(self.state.cut) + 1 if self.state.cut in numbers else 0
            self._go(*order[after % len(order)])

    def _go(self, position: int, number: int) -> None:
        self.state.playback.stop()
        self.state.show_position(position)
        self.state.select_cut(number)
