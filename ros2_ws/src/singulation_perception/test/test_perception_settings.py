import dataclasses

import numpy as np
import pytest

from singulation_core import CellGeometry, InvalidInputError
from singulation_perception import SegmentationParameters
from singulation_perception.perception_settings import PerceptionSettings

SETTINGS = PerceptionSettings()


def test_defaults_are_those_of_the_cell_and_the_library():
    np.testing.assert_allclose(SETTINGS.camera_pose, CellGeometry().table_from_camera)
    used, library = SETTINGS.segmentation(None), SegmentationParameters()
    assert used.workspace == CellGeometry().workspace
    for field in dataclasses.fields(library):
        if field.name != "workspace":
            assert getattr(used, field.name) == getattr(library, field.name), field.name


def test_fixed_tolerances_reach_the_library_only_when_asked_for():
    changed = dataclasses.replace(SETTINGS, tolerance=0.005, outline_tolerance=0.004)
    assert changed.segmentation(None).tolerance is None
    fixed = dataclasses.replace(changed, automatic_tolerances=False).segmentation(None)
    assert (fixed.tolerance, fixed.outline_tolerance) == (0.005, 0.004)
    assert dataclasses.replace(SETTINGS, crop_to_workspace=False).segmentation(None).workspace is None


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"camera_quaternion": (0.0, 0.0, 0.0, 2.0)}, "camera_quaternion"),
        ({"camera_quaternion": (0.0, 0.0, 1.0)}, "camera_quaternion"),
        ({"camera_position": (0.0, float("nan"), 1.0)}, "camera_position"),
        ({"camera_position": ()}, "camera_position"),
        ({"workspace": (0.1, -0.1, 0.0, 0.1)}, "workspace"),
        ({"workspace": (0.1, 0.2, 0.3)}, "workspace has 3 numbers, need 4"),
        ({"min_size": 100, "max_size": 10}, "min_size"),
        ({"min_height": 0.2, "max_height": 0.1}, "max_height"),
        ({"table_frame": ""}, "table_frame"),
    ],
)
def test_values_that_contradict_each_other_are_refused(change, text):
    with pytest.raises(InvalidInputError, match=text):
        dataclasses.replace(SETTINGS, **change)
