"""The bytes of a coloured cloud. ``array('B')`` is what the message takes without looking at every byte."""

from array import array

import numpy as np
from numpy.typing import ArrayLike, NDArray

from singulation_core import InvalidInputError
from singulation_perception.clouds import CloudField, CloudLayout

XYZ = tuple(CloudField(name, 4 * place) for place, name in enumerate("xyz"))
XYZ_RGB = (*XYZ, CloudField("rgb", 12))

_UNLABELLED = 0x505860  # slate grey, so that the colours of the objects stand out


def encode_coloured(points: ArrayLike, labels: NDArray[np.integer]) -> tuple[CloudLayout, "array[int]"]:
    """Layout and bytes of x, y, z and a colour for each label.

    Args:
        points: (H, W, 3) or (N, 3) [m].
        labels: (H, W) or (N,), -1 for no object.

    Raises:
        InvalidInputError: shapes that do not fit each other.
    """
    xyz = np.asarray(points)
    layout = _layout(xyz.shape, XYZ_RGB)
    if labels.shape != xyz.shape[:-1]:
        raise InvalidInputError(f"labels of shape {labels.shape} do not fit points of shape {xyz.shape}")
    coloured = np.empty((*xyz.shape[:-1], 4), dtype="<f4")
    coloured[..., :3] = xyz
    coloured.view("<u4")[..., 3] = label_colours(int(labels.max(initial=-1)) + 1)[labels]
    return layout, _bytes(coloured)


def label_colours(count: int) -> NDArray[np.uint32]:
    """(count + 1,) packed 0xRRGGBB colours that neighbours in number do not share; the last one is for label -1."""
    golden = 0.381966  # steps around the colour circle by the golden angle never come close to an earlier one soon
    hues = (np.arange(count) * golden) % 1.0
    channels = (hues[:, None] * 6.0 + np.array((0.0, 4.0, 2.0))) % 6.0
    rgb = np.clip(np.abs(channels - 3.0) - 1.0, 0.0, 1.0) * 200 + 55
    packed = rgb.astype(np.uint32) @ np.array((1 << 16, 1 << 8, 1), dtype=np.uint32)
    return np.append(packed.astype(np.uint32), np.uint32(_UNLABELLED))


def _layout(shape: tuple[int, ...], fields: tuple[CloudField, ...]) -> CloudLayout:
    if len(shape) not in (2, 3) or shape[-1] != 3:
        raise InvalidInputError(f"points of shape {shape}, need (H, W, 3) or (N, 3)")
    height, width = (1, shape[0]) if len(shape) == 2 else shape[:2]
    step = 4 * len(fields)
    return CloudLayout(height, width, step, step * width, fields)


def _bytes(values: NDArray[np.float32]) -> "array[int]":
    data = array("B")
    data.frombytes(values.reshape(-1).view(np.uint8).data)
    return data
