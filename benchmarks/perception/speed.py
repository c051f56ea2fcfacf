"""The whole way from a raw cloud to polygons: processor time beside the rivals', taking turns on the same clouds."""

import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from benchmarks.perception.open3d_rival import Open3dRival
from benchmarks.perception.pcl_rival import PclRival
from benchmarks.perception.scenes import AREA, FULL, HALF, Scene, make_scene
from benchmarks.perception.scoring import score
from benchmarks.perception.sensor import Sensor
from benchmarks.perception.tables import Table

from singulation_core import Arrangement, PlanarObject
from singulation_core.polygon import FloatArray, signed_area
from singulation_node.large_messages import keep_memory
from singulation_perception import SegmentationParameters, segment_cloud, warm_up
from singulation_perception.clouds import CloudField, CloudLayout, ScalarType
from singulation_perception.decoding import decode_points

SEED = 500_000
OURS = "ours"
RESOLUTIONS = {"0.8 M points": HALF, "3.2 M points": FULL}
_SLOW_ROUNDS = 1  # of what takes seconds


@dataclass(frozen=True)
class Recipe:
    """Of a rival: edge of the voxels (0 for none), tolerance of the clustering [m], smallest cluster [points]; of PCL
    whether it crops as its tutorials do, axis by axis, instead of with one box, which is faster, and whether it begins
    with the message, as ours does, instead of its own cloud.
    """

    leaf: float
    tolerance: float
    min_size: int
    pass_through: bool = False
    from_message: bool = False


RECIPES = {
    "voxel grid 2 mm": Recipe(0.002, 0.004, 20),
    "voxel grid 2 mm, from the message": Recipe(0.002, 0.004, 20, from_message=True),
    "voxel grid 2 mm, cropped by axes": Recipe(0.002, 0.004, 20, pass_through=True),
    "voxel grid 2 mm, cropped by axes, from the message": Recipe(
        0.002, 0.004, 20, pass_through=True, from_message=True
    ),
    "voxel grid 1 mm": Recipe(0.001, 0.003, 60),
    "full resolution": Recipe(0.0, 0.005, 60),
}


@dataclass(frozen=True)
class Answer:
    """Processor and wall milliseconds, how many objects, and their outlines if there are any."""

    processor: float
    wall: float
    objects: int
    arrangement: Arrangement | None = None


@dataclass(frozen=True)
class Contestant:
    """Does the job once when called; ``rounds`` limits how often."""

    run: Callable[[Scene], Answer]
    rounds: int


def speed_scenes(sensor: Sensor, count: int) -> dict[str, list[Scene]]:
    """Scenes of 25 blocks by kind."""
    noisy = Sensor(width=sensor.width, height=sensor.height, noise=0.0003)
    return {
        "apart, noise 0.1 mm": [make_scene(SEED + k, sensor) for k in range(count)],
        "apart, noise 0.3 mm": [make_scene(SEED + 10 + k, noisy) for k in range(count)],
        "touching pairs": [make_scene(SEED + 20 + k, sensor, group=2, gap=0.0) for k in range(count)],
    }


def run_speed(count: int, rounds: int, pcl: PclRival | None, with_open3d: bool, resolutions: list[str]) -> list[Table]:
    """Processor time and what was found, for the chosen resolutions; ours alone if there is no rival."""
    keep_memory()  # as every node of the suite does; without it fresh pages cost 4 ms a cloud
    warm_up()
    tables = []
    for name in resolutions:
        sensor = RESOLUTIONS[name]
        measured: dict[tuple[str, str], list[tuple[Answer, Scene]]] = defaultdict(list)
        scenes = speed_scenes(sensor, count)
        for turn in range(rounds):
            for kind, members in scenes.items():
                for scene in members:
                    _take_turns(turn, kind, scene, _rivals(scene, pcl, with_open3d), measured)
        tables.append(_table(name, measured))
    return tables


def _take_turns(
    turn: int,
    kind: str,
    scene: Scene,
    rivals: dict[str, Contestant],
    measured: dict[tuple[str, str], list[tuple[Answer, Scene]]],
) -> None:
    """Ours before each rival, so that both see the machine in the same state; every cloud comes out of cold caches."""
    if not rivals:
        measured[kind, OURS].append((_ours(scene), scene))
    for name, contestant in rivals.items():
        if turn < contestant.rounds:
            measured[kind, OURS].append((_ours(scene), scene))
            measured[kind, name].append((contestant.run(scene), scene))


def _rivals(scene: Scene, pcl: PclRival | None, with_open3d: bool) -> dict[str, Contestant]:
    rivals: dict[str, Contestant] = {}
    if pcl is not None:
        pcl.load(scene.points)
        for name, recipe in RECIPES.items():
            rivals[f"PCL, {name}"] = Contestant(_pcl(pcl, recipe), _SLOW_ROUNDS if recipe.leaf == 0.0 else 1_000)
    if not with_open3d:
        return rivals
    open3d = Open3dRival()
    open3d.load(scene.points, AREA, scene.table_from_camera)
    for name, recipe in RECIPES.items():
        if recipe.leaf == 0.001 or recipe.pass_through:  # the others are enough to see where Open3D stands
            continue
        rivals[f"Open3D, {name}"] = Contestant(_open3d(open3d, recipe), _SLOW_ROUNDS)
    return rivals


def _ours(scene: Scene) -> Answer:
    """From the bytes of the message and its layout."""
    parameters = SegmentationParameters(table_from_camera=scene.table_from_camera, workspace=AREA)
    data, layout = scene.points.reshape(-1).view(np.uint8), _layout(scene)
    processor, wall = time.process_time(), time.perf_counter()
    arrangement = segment_cloud(decode_points(data, layout), parameters).arrangement
    processor, wall = time.process_time() - processor, time.perf_counter() - wall
    return Answer(1e3 * processor, 1e3 * wall, len(arrangement), arrangement)


def _layout(scene: Scene) -> CloudLayout:
    height, width = scene.points.shape[:2]
    fields = tuple(CloudField(name, 4 * place, ScalarType.FLOAT32) for place, name in enumerate("xyz"))
    return CloudLayout(height, width, 12, 12 * width, fields)


def _pcl(rival: PclRival, recipe: Recipe) -> Callable[[Scene], Answer]:
    def run(scene: Scene) -> Answer:
        processor, wall, outlines = rival.pipeline(
            recipe.leaf,
            recipe.tolerance,
            recipe.min_size,
            AREA,
            scene.table_from_camera,
            pass_through=recipe.pass_through,
        )
        if recipe.from_message:
            more_processor, more_wall = rival.convert()
            processor, wall = processor + more_processor, wall + more_wall
        objects = [PlanarObject(number, _counter_clockwise(outline)) for number, outline in enumerate(outlines)]
        return Answer(processor, wall, len(objects), Arrangement(objects))

    return run


def _open3d(rival: Open3dRival, recipe: Recipe) -> Callable[[Scene], Answer]:
    return lambda _: Answer(*rival.pipeline(recipe.leaf, recipe.tolerance, recipe.min_size))


def _counter_clockwise(outline: FloatArray) -> FloatArray:
    return outline if signed_area(outline) > 0.0 else np.ascontiguousarray(outline[::-1])


def _table(resolution: str, measured: dict[tuple[str, str], list[tuple[Answer, Scene]]]) -> Table:
    columns = ["scenes", "program", "processor ms", "fastest", "95 %", "wall ms", "times ours", "found", "IoU", "runs"]
    table = Table(
        f"speed_{resolution[:3].replace('.', '_')}",
        f"Raw cloud to polygons, {resolution}",
        columns,
        notes=[
            "Median of the processor time of all threads over all scenes and rounds. `times ours`: against the median "
            "of our runs between those of the rival's. `found`: share of the true blocks with an intersection over "
            "union above 0.8; `IoU`: its mean over those. Open3D has no polygons and stops at the clusters. PCL "
            "starts from its own cloud, but for `from the message`, where making that cloud is counted as ours is.",
        ],
    )
    for (kind, name), answers in measured.items():
        ours = np.median([one.processor for one, _ in measured[kind, OURS]])
        times = np.array([one.processor for one, _ in answers])
        wall = float(np.median([one.wall for one, _ in answers]))
        figures = [float(np.median(times)), float(times.min()), float(np.percentile(times, 95)), wall]
        ratio = float(np.median(times) / ours)
        table.rows.append([kind, name, *figures, ratio, *_quality(answers), len(answers)])
    return table


def _quality(answers: list[tuple[Answer, Scene]]) -> tuple[str, float]:
    matches = [m for one, scene in answers if one.arrangement for m in score(one.arrangement, scene.truth)]
    if not matches:
        return "-", float("nan")
    found = [match.overlap for match in matches if match.found]
    return f"{100 * len(found) / len(matches):.1f} %", float(np.mean(found)) if found else float("nan")
