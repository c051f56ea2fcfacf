"""A picture of the coloured cloud that perception publishes: segments in colour, shaded by depth."""

from typing import Any

import numpy as np

from singulation_core.polygon import FloatArray

_CONTRAST = 0.55  # share of the brightness that depth decides


def label_view(message: Any) -> FloatArray | None:
    """(H, W, 3) colours 0..1 of ``perception/labels``; None for a cloud without image order."""
    if message.height <= 1:
        return None
    values = np.frombuffer(message.data, dtype="<f4").reshape(message.height, message.width, 4)
    packed = values.view("<u4")[..., 3]
    colours = np.stack(((packed >> 16) & 255, (packed >> 8) & 255, packed & 255), axis=-1) / 255.0
    depth = values[..., 2].astype(np.float64)
    valid = np.isfinite(depth) & (depth != 0.0)
    if not valid.any():
        return np.asarray(colours)
    near, far = np.percentile(depth[valid], (1.0, 95.0))
    shade = 1.0 - _CONTRAST * np.clip((depth - near) / max(far - near, 1e-6), 0.0, 1.0)
    return np.where(valid[..., None], colours * shade[..., None], 0.12)
