"""Array types of the kernels."""

import numpy as np
from numpy.typing import NDArray

IntArray = NDArray[np.int64]
