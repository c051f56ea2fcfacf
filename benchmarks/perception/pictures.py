"""Pictures of segmented scenes to look at: synthetic ones beside their truth, recorded ones beside their labels."""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from benchmarks.perception.drawing import draw_image, draw_table, save
from benchmarks.perception.quality import HELD_OUT
from benchmarks.perception.scenes import AREA, FULL, HALF, Scene, make_scene
from numpy.typing import NDArray

from singulation_core import SingulationError
from singulation_perception import SegmentationParameters, segment_cloud
from singulation_perception.cloud_files import read_cloud_file
from singulation_perception.clouds import CloudField, RecordedCloud
from singulation_perception.decoding import decode_points

_LABELS = "label"
_FIRST_OBJECT = 20  # labels below it are table and ground in the recorded clouds of this kind
_PARTS = 10  # labels of one object
_TALLEST = 0.6  # m; recorded scenes are not of our blocks


def draw_synthetic(out: Path) -> list[Path]:
    """Blocks apart, touching pairs and triples at both resolutions, seen from above with the truth dashed."""
    scenes = {
        "apart": make_scene(HELD_OUT + 30_000, FULL),
        "pairs": make_scene(HELD_OUT + 30_001, FULL, blocks=24, group=2, gap=0.0, heights="equal"),
        "triples": make_scene(HELD_OUT + 30_002, FULL, blocks=24, group=3, gap=0.0, heights="uniform"),
        "pairs_half": make_scene(HELD_OUT + 30_001, HALF, blocks=24, group=2, gap=0.0, heights="equal"),
    }
    return [_synthetic(out / f"perception_{name}.png", scene) for name, scene in scenes.items()]


def _synthetic(path: Path, scene: Scene) -> Path:
    parameters = SegmentationParameters(table_from_camera=scene.table_from_camera, workspace=AREA)
    seen = segment_cloud(scene.points, parameters)
    figure, (left, right) = plt.subplots(1, 2, figsize=(17, 6), width_ratios=(1, 1.15))
    draw_image(left, seen.labels, _shaded(scene.points))
    left.set_title(f"{scene.points.shape[1]} x {scene.points.shape[0]} points, in the camera's image")
    draw_table(right, scene.points, seen, scene.truth)
    right.set_title("on the table; black: found, height in mm (confidence below 0.9); red dashed: truth")
    save(figure, path)
    return path


def draw_recorded(clouds: list[Path], out: Path) -> list[Path]:
    """Recorded clouds in image order, with the labels of their file (if it has any) beside ours."""
    return [_recorded(path, out / f"recorded_{path.stem}.png") for path in clouds]


def _recorded(cloud_path: Path, path: Path) -> Path:
    cloud = read_cloud_file(cloud_path)
    points = decode_points(cloud.data, cloud.layout)
    figure, axes = plt.subplots(1, 3, figsize=(19, 5.2))
    background = _shaded(points)
    try:
        seen = segment_cloud(points, SegmentationParameters(max_height=_TALLEST))
    except SingulationError as error:
        axes[0].set_title(f"refused: {error.code.name}")
    else:
        draw_image(axes[0], seen.labels, background)
        left_out = ", ".join(f"{reason} {count}" for reason, count in seen.dropped.items() if count)
        axes[0].set_title(f"{cloud_path.stem}: {len(seen.arrangement)} objects; left out: {left_out or 'nothing'}")
        draw_table(axes[2], points, seen)
    truth = _labels(cloud)
    if truth is not None:
        draw_image(axes[1], truth, background)
        axes[1].set_title(f"labels of the file: {len(np.unique(truth[truth >= 0]))} objects")
    save(figure, path)
    return path


def _labels(cloud: RecordedCloud) -> NDArray[np.int32] | None:
    """(H, W) object of each point, -1 for none; None if the file has no labels."""
    fields: list[CloudField] = [one for one in cloud.layout.fields if one.name == _LABELS]
    if not fields:
        return None
    layout = cloud.layout
    values = np.ndarray(
        (layout.height, layout.width),
        dtype="<u4",
        buffer=memoryview(cloud.data).cast("B"),
        offset=fields[0].offset,
        strides=(layout.row_step, layout.point_step),
    ).astype(np.int32)
    return np.where(values >= _FIRST_OBJECT, values // _PARTS, -1).astype(np.int32)


def _shaded(points: NDArray[np.float32]) -> NDArray[Any]:
    """(H, W) grey: how steeply the surface rises across the image; white where nothing was measured."""
    with np.errstate(invalid="ignore"):
        slope = np.nan_to_num(np.gradient(points[..., 2].astype(np.float64), axis=1))
        limit = float(np.percentile(np.abs(slope), 95)) or 1.0
        grey = 0.6 + 0.35 * np.clip(slope / limit, -1.0, 1.0)
    grey[~np.isfinite(points[..., 2])] = 1.0
    return np.asarray(grey)
