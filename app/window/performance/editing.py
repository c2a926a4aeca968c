"""What a person does to a performance, as edits on the one history; what cannot be done is said in words."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.model.edits import performance as edits
from app.model.performance import Motion
from app.window.performance.state import PerformanceState


class PerformanceEditing(QObject):
    """Key motions by their place, motions by their node. ``told`` gives a sentence on what was not done, and why;
    ``key_changed`` the place of the key motion that is chosen.
    """

    told = Signal(str)
    key_changed = Signal(int)

    def __init__(self, state: PerformanceState, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.state = state
        self.key = -1
        """The key motion that is chosen in the timeline."""
        self.replacing = -1
        """The key motion in whose place the next chosen motion comes."""

    # key motions -------------------------------------------------------------------------------------------------

    def append(self, node: int, place: int | None = None) -> bool:
        """Add a motion as key motion at the end, or before another; the last one once more plays it longer."""
        state, project = self.state, self.state.project
        if project is None or not 0 <= node < len(state.motions):
            return False
        motion = state.motions[node]
        if self._is_forbidden(node):
            self.told.emit(f"{motion.name} is forbidden: allow it first.")
            return False
        if self.replacing >= 0 and place is None:
            return self.replace(self.replacing, node)
        keys = state.document.performance.keys
        before = (len(keys) if place is None else place) - 1
        if 0 <= before < len(keys) and state.motion_node(keys[before].motion) == node:
            return self.repeat(before, 1)
        if before + 1 < len(keys) and state.motion_node(keys[before + 1].motion) == node:
            return self.repeat(before + 1, 1)
        done = project.edit(edits.add_key, motion.motion, place=place)
        if done:
            self.choose(before + 1)
        return done

    def replace(self, place: int, node: int) -> bool:
        """Put another motion in a key motion's place."""
        self.replacing = -1
        project = self.state.project
        return project is not None and project.edit(edits.replace_key, place, self.state.motions[node].motion)

    def pick_another(self) -> None:
        """Let the next motion that is chosen stand where the one out of reach stands."""
        gap = self.state.gap
        if gap is None:
            return
        keys = self.state.document.performance.keys
        nodes = [self.state.motion_node(key.motion) for key in keys]
        pairs = [place for place in range(1, len(nodes)) if (nodes[place - 1], nodes[place]) == (gap.start, gap.goal)]
        self.replacing = pairs[0] if pairs else len(nodes) - 1
        self.choose(self.replacing)
        name = self.state.motions[nodes[self.replacing]].name
        self.told.emit(f"Double-click the motion that takes the place of {name}. Esc leaves it as it is.")

    def remove(self, place: int) -> bool:
        """Take a key motion away."""
        project = self.state.project
        if project is None or not 0 <= place < len(self.state.document.performance.keys):
            return False
        self.choose(-1)
        return project.edit(edits.remove_key, place)

    def move(self, place: int, to: int) -> bool:
        """Move a key motion to another place in the order."""
        project, count = self.state.project, len(self.state.document.performance.keys)
        if project is None or not 0 <= place < count or not 0 <= to < count or place == to:
            return False
        done = project.edit(edits.move_key, place, to)
        self.choose(to)
        return done

    def repeat(self, place: int, step: int) -> bool:
        """Play a key motion once more, or once less."""
        state, project = self.state, self.state.project
        keys = state.document.performance.keys
        if project is None or not 0 <= place < len(keys):
            return False
        node = state.motion_node(keys[place].motion)
        if step > 0 and node >= 0 and not state.motions[node].cyclic:
            self.told.emit(f"{state.motions[node].name} does not repeat: it is played once.")
            return False
        count = keys[place].repeats + step
        return count >= 1 and project.edit(edits.set_repeats, place, count)

    def choose(self, place: int) -> None:
        """Choose a key motion in the timeline, or none."""
        if place != self.key:
            self.key = place
            self.key_changed.emit(place)

    def cancel(self) -> bool:
        """Pick nothing; says whether something was to be picked."""
        was, self.replacing = self.replacing >= 0, -1
        return was

    # what may be played --------------------------------------------------------------------------------------------

    def forbid(self, node: int) -> bool:
        """Forbid a motion, or allow it again."""
        state, project = self.state, self.state.project
        if project is None or not 0 <= node < len(state.motions):
            return False
        motion = state.motions[node]
        if self._is_forbidden(node):
            named = [each for each in state.document.performance.forbidden if state.motion_node(each) == node]
            return project.edit(edits.set_forbidden, named[0], False)
        places = [k for k, key in enumerate(state.document.performance.keys) if state.motion_node(key.motion) == node]
        if places:
            self.told.emit(f"{motion.name} is key motion {places[0] + 1}: remove it from the timeline first.")
            return False
        return project.edit(edits.set_forbidden, motion.motion, True)

    def _is_forbidden(self, node: int) -> bool:
        return any(self.state.motion_node(motion) == node for motion in self.state.document.performance.forbidden)

    def use_gap_mu(self) -> bool:
        """Take the smallest mu that connects what is apart."""
        gap, project = self.state.gap, self.state.project
        return gap is not None and gap.mu is not None and project is not None and project.edit(edits.set_mu, gap.mu)

    # cuts --------------------------------------------------------------------------------------------------------

    def is_hard(self, cut: int) -> bool:
        """Whether a cut shall not be blended."""
        return cut in self.state.hard_cuts()

    def set_hard(self, cut: int, hard: bool) -> bool:
        """Leave a cut as it is, or blend it again."""
        state, project = self.state, self.state.project
        if project is None or state.performance is None or not 0 <= cut < len(state.performance.cuts):
            return False
        leave, enter = state.cut_motions(cut)
        return project.edit(edits.set_hard_cut, leave, enter, hard)

    def key_through(self, block_place: int, node: int) -> bool:
        """Make a motion on the way a key motion, before the key motion at a place."""
        project = self.state.project
        if project is None or not 0 <= node < len(self.state.motions):
            return False
        motion: Motion = self.state.motions[node].motion
        return project.edit(edits.add_key, motion, place=block_place)
