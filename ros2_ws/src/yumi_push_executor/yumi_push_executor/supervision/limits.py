"""Limits of the supervision. They stand here once; the node's parameters take their defaults from here."""

import dataclasses
from dataclasses import dataclass

from singulation_core import InvalidInputError


@dataclass(frozen=True, slots=True)
class SupervisionLimits:
    """Lengths in metres, angles in radians, times in seconds.

    A time counts as exceeded only when both the clock of the states (simulated time under ``use_sim_time``) and the
    steady clock of the machine say so, hence a simulation faster than real time is not stopped by a short hiccup of the
    machine; ``wall_silence`` bounds what the steady clock alone allows, so a paused or stepped clock cannot disable it.
    """

    state_age: float = 0.25  # joint states older than this are lost; at 50 mm/s the tip moves 12.5 mm meanwhile
    driver_age: float = 1.0  # a driver polled over RWS reports at 5 Hz
    state_delay: float = 0.5  # between a state's stamp and its arrival; also into the future
    wall_silence: float = 5.0
    blind_time: float = 0.5  # longest gap between two steps of the supervision

    start_distance: float = 0.03  # joint distance between the measured and the planned start
    clock_skew: float = 0.1  # by which stamps may differ from this machine's clock while an arm is followed
    start_latency: float = 0.4  # until an ordered motion is seen to begin
    path_tolerance: float = 0.02  # joint distance from the commanded path (10 mm at a reach of 0.5 m)
    lag: float = 0.25  # how far the arm may run behind the command, beyond the start latency
    progress_window: float = 0.15  # moved less than a tenth of the command in this time: no progress
    goal_tolerance: float = 0.005  # joint distance at the end of a segment
    goal_time: float = 1.0  # to settle there; never unlimited

    stopped_speed: float = 0.02  # joint speed that counts as standing [rad/s]
    stop_duration: float = 0.03  # of a stop at least
    stop_deceleration: float = 40.0  # of the joints, at the beginning of a stop [rad/s^2]
    stop_speed: float = 1.5  # joint speed of a stop's way back to the measured position [rad/s]
    stop_timeout: float = 1.0  # until standstill must have been seen
    lift_wait: float = 1.5  # for the driver to allow a retreat

    opening_tolerance: float = 0.001  # jaw opening against the order
    opening_drift: float = 0.003  # change of the opening during the motion
    gripper_speed: float = 0.05  # both fingers at 25 mm/s each [m/s]
    gripper_time: float = 1.0  # beyond the time that the speed explains

    def __post_init__(self) -> None:
        for item in dataclasses.fields(self):
            value = getattr(self, item.name)
            if not (0.0 < value < float("inf")):
                raise InvalidInputError(f"supervision: {item.name} is {value}; need a finite positive number")
        if not (self.goal_tolerance <= self.path_tolerance):
            raise InvalidInputError(
                f"supervision: goal_tolerance {self.goal_tolerance} rad exceeds path_tolerance "
                f"{self.path_tolerance} rad"
            )
        if not (self.state_age <= self.wall_silence):
            raise InvalidInputError(
                f"supervision: state_age {self.state_age} s exceeds wall_silence {self.wall_silence} s"
            )
