"""A renderer whose window is a picture in memory."""

from __future__ import annotations

from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow


class Offscreen:
    """Has the alpha channel that a picture over another one needs."""

    def __init__(self) -> None:
        self.render_window = vtkRenderWindow()
        self.render_window.SetOffScreenRendering(True)
        self.render_window.SetAlphaBitPlanes(1)
        self.render_window.SetSize(64, 64)
        self.renderer = vtkRenderer()
        self.render_window.AddRenderer(self.renderer)

    def finish(self) -> None:
        """Let go of the graphics memory; nothing can be drawn afterwards."""
        self.renderer.RemoveAllViewProps()
        self.render_window.Finalize()
        self.render_window.RemoveRenderer(self.renderer)
