"""Edits of lassos: corners added and removed, a lasso moved or removed, each undone by the document before."""

from __future__ import annotations

import pytest

from app.model.document import Document
from app.model.edits import masks, scene
from app.model.values import Clip, MediaRef, ModelError

SQUARE = ((10.0, 10.0), (50.0, 10.0), (50.0, 50.0), (10.0, 50.0))


@pytest.fixture
def drawn() -> Document:
    """A document with a square and a smaller one taken away in frame 3."""
    document = Document(clip=Clip(MediaRef("a.mp4", "x"), 100, 80, 10, 25.0))
    document = scene.add_lasso(document, 3, SQUARE).document
    return scene.add_lasso(document, 3, [(20, 20), (30, 20), (30, 30)], subtract=True).document


def test_a_corner_is_added_behind_another_and_removed_again(drawn: Document) -> None:
    """The new corner stands between its neighbours; taking it away gives the same value."""
    edit = masks.insert_lasso_point(drawn, 3, 0, 1, (60, 30))
    assert edit.document.masks[3].lassos[0].points == (SQUARE[0], SQUARE[1], (60.0, 30.0), SQUARE[2], SQUARE[3])
    assert edit.label == "Add mask point, frame 3"
    assert masks.remove_lasso_point(edit.document, 3, 0, 2).document == drawn
    last = masks.insert_lasso_point(drawn, 3, 0, 3, (5, 30)).document
    assert last.masks[3].lassos[0].points[-1] == (5.0, 30.0)


def test_a_lasso_is_moved_whole_and_only_it(drawn: Document) -> None:
    """All corners move, the other lasso is the same object."""
    after = masks.move_lasso(drawn, 3, 0, (5, -2)).document
    assert after.masks[3].lassos[0].points == tuple((x + 5, y - 2) for x, y in SQUARE)
    assert after.masks[3].lassos[1] is drawn.masks[3].lassos[1]


def test_lassos_are_removed_and_the_mask_with_the_last_that_adds(drawn: Document) -> None:
    """A mask that only takes away is no mask."""
    assert len(masks.remove_lasso(drawn, 3, 1).document.masks[3].lassos) == 1
    assert 3 not in masks.remove_lasso(drawn, 3, 0).document.masks


def test_what_is_not_there_is_refused(drawn: Document) -> None:
    """Three corners stay; frames, lassos and corners that are not there are named."""
    with pytest.raises(ModelError, match="only three points"):
        masks.remove_lasso_point(drawn, 3, 1, 0)
    with pytest.raises(ModelError, match="no such point"):
        masks.insert_lasso_point(drawn, 3, 0, 4, (0, 0))
    with pytest.raises(ModelError, match="no such lasso"):
        masks.move_lasso(drawn, 4, 0, (1, 1))
    with pytest.raises(ModelError, match="finite"):
        masks.move_lasso(drawn, 3, 0, (float("nan"), 1))
