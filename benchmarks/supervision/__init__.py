"""How the supervision reacts to faults of the simulated driver, and many pushes executed under it."""
