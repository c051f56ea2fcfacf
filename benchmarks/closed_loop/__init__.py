"""The closed loop: see ``singulation_bringup.closed_loop.main``."""
