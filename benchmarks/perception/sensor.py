"""A structured-light camera above the table: ray-cast clouds with the errors of the real thing.

Modelled: pinhole raster, projector shadow, depth noise, table warp, loss of grazing surfaces, loss and flying points at
depth edges, random loss. The amounts at edges are assumptions; no PhoXi has been measured for them.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from benchmarks.perception.blocks import Block
from numpy.random import Generator
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray, convex_hull, inward_half_planes


@dataclass(frozen=True)
class Sensor:
    """Where the camera hangs and what it does to the depth [m, rad, shares of points]."""

    width: int = 2064
    height: int = 1544
    distance: float = 0.9
    tilt: float = np.radians(6.0)
    heading: float = 0.0
    baseline: float = 0.23
    noise: float = 0.0001
    warp: float = 0.00015
    grazing: float = np.radians(78.0)
    edge_loss: float = 0.5
    flying: float = 0.03
    loss: float = 0.003

    @property
    def focal(self) -> float:
        """In pixels: 2274 for the full raster."""
        return 2274.0 * self.width / 2064.0

    @property
    def table_from_camera(self) -> FloatArray:
        """4x4; the optical axis meets the table at its origin."""
        cosine, sine = np.cos(self.heading), np.sin(self.heading)
        forward = np.array((np.sin(self.tilt) * cosine, np.sin(self.tilt) * sine, -np.cos(self.tilt)))
        right = np.array((-sine, cosine, 0.0)) * -1.0
        pose = np.eye(4)
        pose[:3, 0], pose[:3, 1], pose[:3, 2] = right, np.cross(forward, right), forward
        pose[:3, 3] = -forward * self.distance
        return pose


@dataclass(frozen=True, eq=False)
class View:
    """One cloud (H, W, 3) float32 in the camera frame, NaN where nothing was measured, and the block of each point."""

    points: NDArray[np.float32]
    labels: NDArray[np.int16]


@lru_cache(maxsize=2)
def _rays(width: int, height: int, focal: float) -> FloatArray:
    """(H, W, 3) directions in the camera frame, z = 1."""
    u = (np.arange(width) - (width - 1) / 2) / focal
    v = (np.arange(height) - (height - 1) / 2) / focal
    rays = np.ones((height, width, 3))
    rays[..., 0], rays[..., 1] = np.meshgrid(u, v)
    return rays


def view(sensor: Sensor, blocks: list[Block], random: Generator) -> View:
    """The cloud that the sensor gives of the blocks on its table."""
    pose = sensor.table_from_camera
    rays = _rays(sensor.width, sensor.height, sensor.focal) @ pose[:3, :3].T
    origin = pose[:3, 3]
    depth = -origin[2] / rays[..., 2]
    ground = origin[:2] + depth[..., None] * rays[..., :2]
    depth = depth + _warp(sensor, ground, random) / rays[..., 2]
    labels = np.full(depth.shape, -1, dtype=np.int16)
    lost = np.zeros(depth.shape, dtype=bool)
    for number, block in enumerate(blocks):
        _draw(sensor, number, block, rays, origin, depth, labels, lost)
    lost |= _shadow(sensor, blocks, rays, origin, depth)
    depth[lost] = np.nan
    _spoil(sensor, depth, random)
    labels[np.isnan(depth)] = -1
    points = _rays(sensor.width, sensor.height, sensor.focal) * depth[..., None]
    return View(points.astype(np.float32), labels)


def _warp(sensor: Sensor, ground: FloatArray, random: Generator) -> FloatArray:
    """Smooth unevenness of table and calibration [m]."""
    total = np.zeros(ground.shape[:2])
    for _ in range(3):
        angle, phase = random.uniform(0, 2 * np.pi, 2)
        wave = 2 * np.pi / random.uniform(0.3, 0.8)
        total += np.sin(wave * (ground[..., 0] * np.cos(angle) + ground[..., 1] * np.sin(angle)) + phase)
    return np.asarray(total * sensor.warp / 3.0)


def _window(sensor: Sensor, corners: FloatArray) -> tuple[slice, slice]:
    """Pixels around the image of some points in ``table``."""
    pose = sensor.table_from_camera
    seen = (corners - pose[:3, 3]) @ pose[:3, :3]
    u = seen[:, 0] / seen[:, 2] * sensor.focal + (sensor.width - 1) / 2
    v = seen[:, 1] / seen[:, 2] * sensor.focal + (sensor.height - 1) / 2
    rows = slice(max(0, int(v.min()) - 1), max(0, min(sensor.height, int(v.max()) + 3)))
    columns = slice(max(0, int(u.min()) - 1), max(0, min(sensor.width, int(u.max()) + 3)))
    return rows, columns


def _draw(
    sensor: Sensor,
    number: int,
    block: Block,
    rays: FloatArray,
    origin: FloatArray,
    depth: FloatArray,
    labels: NDArray[np.int16],
    lost: NDArray[np.bool_],
) -> None:
    """Puts a block in front of what was seen so far."""
    corners = np.vstack(
        [np.column_stack((block.outline, np.full(len(block.outline), z))) for z in (block.base, block.height)]
    )
    window = _window(sensor, corners)
    ray, before = rays[window], depth[window]
    normals, offsets = inward_half_planes(block.outline)
    far = np.full(before.shape, np.inf)
    top = (block.height - origin[2]) / ray[..., 2]
    inside = ((origin[:2] + top[..., None] * ray[..., :2]) @ normals.T >= offsets).all(axis=-1)
    far[inside] = top[inside]
    grazing = np.zeros(before.shape, dtype=bool)
    for normal, offset in zip(normals, offsets, strict=True):
        facing = ray[..., :2] @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = (offset - origin[:2] @ normal) / facing
            hit = origin + reach[..., None] * ray
            on = (facing > 0) & (hit[..., 2] >= block.base) & (hit[..., 2] <= block.height) & (reach < far)
            on &= (hit[..., :2] @ normals.T >= offsets - 1e-9).all(axis=-1)
        far[on] = reach[on]
        grazing[on] = (facing[on] / np.linalg.norm(ray[on], axis=-1)) < np.cos(sensor.grazing)
    front = far < before
    depth[window] = np.where(front, far, before)
    labels[window] = np.where(front, number, labels[window])
    lost[window] = np.where(front, grazing, lost[window])


def _shadow(
    sensor: Sensor, blocks: list[Block], rays: FloatArray, origin: FloatArray, depth: FloatArray
) -> NDArray[np.bool_]:
    """What the projector, ``baseline`` along the camera's x, does not reach."""
    lamp = origin + sensor.baseline * sensor.table_from_camera[:3, 0]
    dark = np.zeros(depth.shape, dtype=bool)
    for block in blocks:
        scale = lamp[2] / (lamp[2] - block.height)
        cast = lamp[:2] + (block.outline - lamp[:2]) * scale
        covered = convex_hull(np.vstack((block.outline, cast)))
        reach = np.vstack([np.column_stack((covered, np.full(len(covered), z))) for z in (0.0, 0.045)])
        window = _window(sensor, reach)
        points = origin + depth[window][..., None] * rays[window]
        dark[window] |= _blocked(points, lamp, block)
    return dark


def _blocked(points: FloatArray, lamp: FloatArray, block: Block) -> NDArray[np.bool_]:
    """Which segments from the points to the lamp pass through the block."""
    normals, offsets = inward_half_planes(block.outline)
    way = lamp - points
    enter = np.full(points.shape[:2], 1e-4)
    leave = np.minimum(1.0, (block.height - points[..., 2]) / way[..., 2])
    enter = np.maximum(enter, (block.base - points[..., 2]) / way[..., 2])
    for normal, offset in zip(normals, offsets, strict=True):
        inside = points[..., :2] @ normal - offset
        rate = way[..., :2] @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            cut = -inside / rate
        enter = np.where(rate > 0, np.maximum(enter, cut), enter)
        leave = np.where(rate < 0, np.minimum(leave, cut), leave)
        leave = np.where((rate == 0) & (inside < 0), -1.0, leave)
    return np.asarray(enter < leave)


def _spoil(sensor: Sensor, depth: FloatArray, random: Generator) -> None:
    """Noise, loss and flying points, in place."""
    neighbour = _edge_neighbour(depth)
    edge = ~np.isnan(neighbour[0]) | neighbour[1]
    draw = random.random(depth.shape, dtype=np.float32)
    flying = edge & (draw < sensor.flying) & ~np.isnan(neighbour[0])
    gone = (edge & (draw >= sensor.flying) & (draw < sensor.flying + sensor.edge_loss)) | (draw > 1 - sensor.loss)
    mix = random.random(int(flying.sum()))
    depth[flying] += mix * (neighbour[0][flying] - depth[flying])
    depth += sensor.noise * random.standard_normal(depth.shape, dtype=np.float32)
    depth[gone] = np.nan


def _edge_neighbour(depth: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Depth of a neighbour more than 2 mm off (NaN if none), and whether a neighbour is missing."""
    other = np.full(depth.shape, np.nan)
    missing = np.zeros(depth.shape, dtype=bool)
    valid = ~np.isnan(depth)
    for axis in (0, 1):
        for step in (1, -1):
            moved = np.roll(depth, step, axis=axis)
            with np.errstate(invalid="ignore"):
                jump = np.abs(moved - depth) > 0.002
            other[jump] = moved[jump]
            missing |= valid & np.isnan(moved)
    return other, missing
