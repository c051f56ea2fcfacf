"""Union-find on an int32 array of parents, for compiled code."""

import numpy as np
from numpy.typing import NDArray

from singulation_perception.jit import compiled_part, compiled_part_maker

IntArray = NDArray[np.int32]


@compiled_part_maker
def single_sets(count: int) -> IntArray:
    """Parents of items none of which are joined."""
    parent = np.empty(count, dtype=np.int32)
    for item in range(count):
        parent[item] = item
    return parent


@compiled_part
def find_root(parent: IntArray, item: int) -> int:
    """Root of ``item``; halves the path on the way."""
    while parent[item] != item:
        parent[item] = parent[parent[item]]
        item = parent[item]
    return item


@compiled_part
def unite(parent: IntArray, first: int, second: int) -> None:
    """Joins two sets; the smaller root stays, so that numbers follow the order of the items."""
    a, b = find_root(parent, np.int64(first)), find_root(parent, np.int64(second))
    if a < b:
        parent[b] = a
    elif b < a:
        parent[a] = b


@compiled_part_maker
def numbered_roots(parent: IntArray) -> tuple[IntArray, int]:
    """Set number 0, 1, ... of every item, in the order of the first item, and how many sets there are."""
    numbers = np.empty(len(parent), dtype=np.int32)
    count = 0
    for item in range(len(parent)):
        root = find_root(parent, item)
        if root == item:
            numbers[item] = count
            count += 1
        else:
            numbers[item] = numbers[root]
    return numbers, count
