import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from singulation_bringup.tracking import Tracker
from singulation_core import Arrangement, PlanarObject

SQUARE = np.array(((0.0, 0.0), (0.04, 0.0), (0.04, 0.04), (0.0, 0.04)))
TRIANGLE = np.array(((0.0, 0.0), (0.05, 0.0), (0.0, 0.05)))


def block(identity, outline, x, y, turn=0.0):
    return PlanarObject(identity, outline - outline.mean(axis=0)).moved((x, y), turn)


def test_ids_last_when_perception_numbers_anew_and_blocks_move():
    tracker = Tracker()
    first = tracker.update(Arrangement([block(5, SQUARE, 0, 0), block(9, TRIANGLE, 0.05, 0)]))
    second = tracker.update(Arrangement([block(0, TRIANGLE, 0.1, 0.02, 1.0), block(1, SQUARE, 0.01, 0.0)]))
    assert second.lasting_ids == {0: first.lasting_ids[9], 1: first.lasting_ids[5]}
    assert second.lost == ()
    assert second.found == ()


def test_swapped_places_are_told_apart_by_shape():
    tracker = Tracker()
    first = tracker.update(Arrangement([block(0, SQUARE, 0, 0), block(1, TRIANGLE, 0.05, 0)]))
    second = tracker.update(Arrangement([block(0, TRIANGLE, 0, 0), block(1, SQUARE, 0.05, 0)]))
    assert second.lasting_ids == {0: first.lasting_ids[1], 1: first.lasting_ids[0]}


def test_a_hidden_block_is_reported_and_recognised_when_it_comes_back():
    tracker = Tracker()
    both = Arrangement([block(0, SQUARE, 0, 0), block(1, TRIANGLE, 0.08, 0)])
    first = tracker.update(both)
    hidden = tracker.update(Arrangement([block(0, SQUARE, 0, 0)]))
    assert hidden.lost == (first.lasting_ids[1],)
    again = tracker.update(both)
    assert again.lasting_ids == first.lasting_ids
    assert again.lost == ()


def test_a_far_block_is_a_new_one():
    tracker = Tracker()
    tracker.update(Arrangement([block(0, SQUARE, 0, 0)]))
    second = tracker.update(Arrangement([block(0, SQUARE, 0.5, 0)]))
    assert second.found == (1,)
    assert second.lost == (0,)


def test_a_row_of_equal_blocks_pushed_by_one_length_is_told_apart_by_what_was_expected():
    tracker = Tracker()
    first = tracker.update(Arrangement([block(i, SQUARE, 0.041 * i, 0) for i in range(3)]))
    moved = [block(first.lasting_ids[i], SQUARE, 0.041 * (i + 1), 0) for i in range(3)]
    seen = Arrangement([block(9 - i, SQUARE, 0.041 * (i + 1), 0) for i in range(3)])
    second = tracker.update(seen, expected=Arrangement(moved))
    assert second.lasting_ids == {9 - i: first.lasting_ids[i] for i in range(3)}


def test_blocks_first_seen_as_one_are_no_lost_block():
    pair = np.array(((0.0, 0.0), (0.081, 0.0), (0.081, 0.04), (0.0, 0.04)))
    tracker = Tracker()
    first = tracker.update(Arrangement([PlanarObject(0, pair)]))
    second = tracker.update(Arrangement([PlanarObject(4, SQUARE), PlanarObject(5, SQUARE + (0.041, 0.0))]))
    assert second.given_up == (first.lasting_ids[0],)
    assert second.lost == ()
    assert len(second.found) == 2


WHOLE = np.array(((0.0, 0.0), (0.05, 0.0), (0.05, 0.03), (0.0, 0.03)))
PIECES = (WHOLE - (0.01, 0.0)).clip(0.0, None), WHOLE.clip(None, (0.01, 1.0))


def outlined(identity, outline):
    return PlanarObject(identity, outline)


def test_a_piece_that_was_seen_once_is_no_lost_block_when_its_block_is_whole_again():
    large, small = PIECES
    whole = Arrangement([outlined(0, WHOLE)])
    tracker = Tracker()
    first = tracker.update(whole)
    cut = tracker.update(Arrangement([outlined(0, large + (0.01, 0.0)), outlined(1, small)]))
    again = tracker.update(whole)
    assert cut.lasting_ids[0] == again.lasting_ids[0] == first.lasting_ids[0]
    assert again.given_up == (cut.lasting_ids[1],)
    assert again.lost == again.covered == ()
    assert tracker.update(whole).lost == ()


def test_a_block_seen_twice_beside_another_is_lost_when_the_two_are_seen_as_one():
    large, small = PIECES
    apart = Arrangement([outlined(0, large + (0.01, 0.0)), outlined(1, small)])
    tracker = Tracker()
    tracker.update(Arrangement([outlined(0, WHOLE)]))
    tracker.update(apart)
    second = tracker.update(apart)
    assert tracker.update(Arrangement([outlined(0, WHOLE)])).covered == (second.lasting_ids[1],)


def test_a_block_that_was_there_from_the_start_is_lost_when_it_is_seen_as_a_part_of_another():
    large, small = PIECES
    tracker = Tracker()
    first = tracker.update(Arrangement([outlined(0, large + (0.01, 0.0)), outlined(1, small)]))
    assert tracker.update(Arrangement([outlined(0, WHOLE)])).covered == (first.lasting_ids[1],)


def test_a_block_under_another_outline_is_covered():
    pair = np.array(((0.0, 0.0), (0.081, 0.0), (0.081, 0.04), (0.0, 0.04)))
    tracker = Tracker()
    tracker.update(Arrangement([PlanarObject(0, SQUARE), PlanarObject(1, SQUARE + (0.041, 0.0))]))
    assert tracker.update(Arrangement([PlanarObject(0, pair)])).covered == (0, 1)
    far = Arrangement([PlanarObject(0, SQUARE + (0.0, 0.4))])
    assert tracker.update(far).covered == ()


def test_empty_looks_are_no_trouble():
    tracker = Tracker()
    assert tracker.update(Arrangement([])).lost == ()
    tracker.update(Arrangement([block(3, SQUARE, 0, 0)]))
    assert tracker.update(Arrangement([])).lost == (0,)


@given(st.permutations(range(6)), st.floats(-0.01, 0.01), st.floats(-0.01, 0.01))
def test_small_moves_keep_every_identity(order, dx, dy):
    places = [(0.06 * column, 0.06 * row) for row in range(2) for column in range(3)]
    tracker = Tracker()
    first = tracker.update(Arrangement([block(i, SQUARE, *places[i]) for i in range(6)]))
    moved = [block(new, SQUARE, places[old][0] + dx, places[old][1] + dy) for new, old in enumerate(order)]
    second = tracker.update(Arrangement(moved))
    assert second.lasting_ids == {new: first.lasting_ids[old] for new, old in enumerate(order)}
