"""The motion database: how many motions are kept, how large the graph is, by which method it is made."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QSlider, QVBoxLayout, QWidget

from app.model.edits import performance as edits
from app.window.controls import Chooser, Fold, NumberField, NumberRange, Row, label
from app.window.controls.own_keys import OwnKeys
from app.window.performance.state import PerformanceState
from app.window.performance.trial import Trial

if TYPE_CHECKING:
    from app.actions.performing_graph import Extent

FINE = 1000
LARGEST = 2.0
"""mu at the right end of the slider; more is typed."""
METHODS = (("robust", "Robust"), ("paper", "As printed"))


class DatabasePanel(QWidget):
    """While the slider moves another size is tried; it is an edit when it is let go."""

    def __init__(self, state: PerformanceState, trial: Trial) -> None:
        super().__init__()
        self.state, self.trial = state, trial
        self._extent: tuple[Any, Extent | None] = (None, None)
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 8, 12, 10)
        column.setSpacing(6)
        head = QHBoxLayout()
        self.kept = label("", "caption")
        head.addWidget(label("Motion database", "title"), 1)
        head.addWidget(self.kept)
        column.addLayout(head)
        self._size(column)
        self.graph_method = self._chooser("graph")
        self.features_method = self._chooser("features")
        self.graph_method.setToolTip("How transitions are found and pruned: robust, or equations 9 to 14 as printed")
        self.features_method.setToolTip("How frames are compared: robust, or equations 1 to 5 as printed")
        methods = Fold("Methods", opened=False)
        self.transitions = methods.caption
        methods.column.addWidget(Row("Transitions", self.graph_method))
        methods.column.addWidget(Row("Distances", self.features_method))
        column.addWidget(methods)
        state.results_changed.connect(self.refresh)
        state.document_changed.connect(self.refresh)
        trial.changed.connect(self.refresh)

    def _size(self, column: QVBoxLayout) -> None:
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.slider.setRange(0, round(LARGEST * FINE))
        self.slider.setSingleStep(10)
        self.slider.setPageStep(100)
        self.slider.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.slider.setAccessibleName("Graph size mu")
        self.slider.setToolTip("More keeps more transitions. The path that results is lit while you drag.")
        OwnKeys(self.slider)
        self.slider.valueChanged.connect(self._slid)
        self.slider.sliderReleased.connect(self._released)
        self.number = NumberField(NumberRange(0.0, 1000.0, 0.01, 3, "", 0.9), 0.9)
        self.number.setFixedWidth(58)
        self.number.setAccessibleName("Graph size mu as a number")
        self.number.changing.connect(self.trial.want)
        self.number.changed.connect(self._commit)
        head = QHBoxLayout()
        head.addWidget(label("Graph size \N{GREEK SMALL LETTER MU}"), 1)
        head.addWidget(self.number)
        column.addLayout(head)
        column.addWidget(self.slider)

    def _chooser(self, what: str) -> Chooser:
        made = Chooser(name=f"Method of {what}")
        for value, text in METHODS:
            made.addItem(text, value)
        made.activated.connect(lambda number: self._choose(what, METHODS[number][0]))
        return made

    # showing -----------------------------------------------------------------------------------------------------

    def refresh(self, *_: object) -> None:
        """Show the choices, and how much there is."""
        choice = self.state.document.performance
        for chooser, value in ((self.graph_method, choice.graph), (self.features_method, choice.features)):
            chooser.setCurrentIndex(0 if value == "robust" else 1)
        tried = self.trial.result
        mu = tried.mu if tried is not None else choice.mu
        if not self.slider.isSliderDown():
            self.slider.blockSignals(True)
            self.slider.setValue(round(mu * FINE))
            self.slider.blockSignals(False)
        self.number.set_value(mu)
        self._show_counts()

    def _show_counts(self) -> None:
        graph = self.state.graph
        if graph is None:
            self.kept.setText("")
            self.transitions.setText("")
            return
        if self._extent[0] is not graph:
            from app.actions.performing_graph import extent

            self._extent = (graph, extent(graph))
        found, tried = self._extent[1], self.trial.result
        assert found is not None
        self.kept.setText(f"{found.nodes} of {found.textons} textons")
        self.kept.setToolTip(f"{found.nodes} motions, each with one of its textons; {found.textons} textons in all")
        if tried is not None:
            self.transitions.setText(f"{int(tried.kept.sum())} transitions")
        else:
            apart = f", {found.parts} parts" if found.parts != 1 else ""
            self.transitions.setText(f"{found.transitions} transitions{apart}")
        self.transitions.setToolTip(
            "Every motion leads to every other one."
            if found.parts == 1
            else f"The graph falls into {found.parts} parts: not every motion leads to every other one."
        )

    # changing ----------------------------------------------------------------------------------------------------

    def _slid(self, value: int) -> None:
        mu = value / FINE
        self.number.set_value(mu)
        if self.slider.isSliderDown():
            self.trial.want(mu)
        else:
            self._commit(mu, gesture="graph size")

    def _released(self) -> None:
        self._commit(self.slider.value() / FINE)

    def _commit(self, mu: float, *, gesture: str | None = None) -> None:
        project = self.state.project
        if project is not None and mu != self.state.document.performance.mu:
            project.edit(edits.set_mu, mu, gesture=gesture)
            self.trial.release()
        else:
            self.trial.drop()

    def _choose(self, what: str, value: str) -> None:
        if self.state.project is not None and getattr(self.state.document.performance, what) != value:
            self.state.project.edit(edits.set_methods, **{what: value})
