"""The animation of a run: blocks in the colours that the pictures of the pushes give them."""

import numpy as np
from PIL import Image

from singulation_bringup.demo.film import Film
from singulation_bringup.drawing import colour_of
from singulation_core import Arrangement, CellGeometry, PlanarObject, conversions

SQUARE = np.array(((0.0, 0.0), (0.04, 0.0), (0.04, 0.04), (0.0, 0.04)))


def blocks(*names):
    return Arrangement([PlanarObject(name, SQUARE + (0.06 * k, 0.0)) for k, name in enumerate(names)])


def test_true_blocks_get_the_colours_of_what_the_loop_sees(tmp_path):
    film = Film(CellGeometry())
    for second in (1, 2):
        film.see_table(conversions.arrangement_to_msg(blocks(1, 2), conversions.stamp_of(float(second))))
    film.name_blocks(blocks(7, 4))
    assert film.save(tmp_path / "run.gif")
    with Image.open(tmp_path / "run.gif") as picture:
        colours = {colour for _, colour in picture.convert("RGB").getcolors(1000)}
    for name in (7, 4):
        assert tuple(round(255 * part) for part in colour_of(name)) in colours
    for name in (1, 2):
        assert tuple(round(255 * part) for part in colour_of(name)) not in colours


def test_nothing_seen_is_no_film(tmp_path):
    film = Film(CellGeometry())
    film.name_blocks(blocks(1))
    assert not film.save(tmp_path / "run.gif")
