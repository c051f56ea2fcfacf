"""Settings of the executor's tests."""

from hypothesis import settings

# What is compiled on first use takes seconds once; speed is measured in scripts/bench, not here.
settings.register_profile("executor", deadline=None)
settings.load_profile("executor")
