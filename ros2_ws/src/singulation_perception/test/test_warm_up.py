"""After the warm-up nothing is left to compile: the first cloud is as fast as the second.

Nor do the steps that helper processes compile ahead need anything else than the warm-up does.
"""

import subprocess
import sys

PROGRAM = """
import sys
import singulation_perception
from numba.core.dispatcher import Dispatcher
from singulation_core.claimed_cache import ClaimedCache
from singulation_perception.warming import STEPS

singulation_perception.warm_up()
for step in STEPS:
    step()
for name, module in list(sys.modules.items()):
    if name.startswith("singulation_perception."):
        for function in vars(module).values():
            if isinstance(function, Dispatcher) and function.py_func.__module__ == name:
                if isinstance(function._cache, ClaimedCache) and len(function.signatures) != 1:
                    print(name, function.py_func.__name__, len(function.signatures))
"""


def test_every_compiled_function_is_compiled_once():
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
