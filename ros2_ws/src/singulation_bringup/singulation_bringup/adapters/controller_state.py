"""What an ABB controller's state means for whoever wants to move the robot."""

from dataclasses import dataclass
from enum import IntEnum

_EGM_RUNNING = 5  # abb_rapid_sm_addin_msgs/StateMachineState: the state machine of a task runs EGM


class DriverMode(IntEnum):
    """Values are those of ``singulation_msgs/msg/DriverState``."""

    MOTORS_OFF = 0
    MOTORS_ON = 1
    GUARD_STOP = 2
    EMERGENCY_STOP = 3
    COLLISION_STOP = 4
    SYSTEM_FAILURE = 5


@dataclass(frozen=True, slots=True)
class ControllerState:
    """What ``abb_robot_msgs/SystemState`` and ``abb_rapid_sm_addin_msgs/RuntimeState`` tell.

    Args:
        motors_on: motors have power.
        auto_mode: automatic mode; motion from outside is refused in manual mode.
        rapid_running: the RAPID program runs.
        egm_running: an EGM session is open for each arm; None if that is not known.
    """

    motors_on: bool
    auto_mode: bool
    rapid_running: bool
    egm_running: bool | None


@dataclass(frozen=True, slots=True)
class Verdict:
    """Mode, whether motion is taken, and why not."""

    mode: DriverMode
    motion_enabled: bool
    text: str


def verdict(state: ControllerState, require_egm: bool) -> Verdict:
    """What the executor may be told.

    The public messages carry no emergency stop, guard stop or collision flag. What stopped the robot is therefore not
    guessed: every state but "everything runs" says that motion is not taken, and its text where to look.

    Args:
        state: of the controller.
        require_egm: whether motion counts as taken only while EGM is known to run.
    """
    if not state.motors_on:
        return Verdict(
            DriverMode.MOTORS_OFF, False, "motors off: switched off, emergency stop or guard stop; see the FlexPendant"
        )
    if not state.auto_mode:
        return Verdict(DriverMode.MOTORS_ON, False, "manual mode; switch the controller to automatic")
    if not state.rapid_running:
        return Verdict(
            DriverMode.MOTORS_ON,
            False,
            "the RAPID program does not run: stopped by a collision, by an error or by hand; see the event log",
        )
    if require_egm and not state.egm_running:
        known = "no EGM session is open" if state.egm_running is False else "nothing is known of EGM"
        return Verdict(DriverMode.MOTORS_ON, False, f"{known}; start EGM on both arms (start_egm_joint)")
    return Verdict(DriverMode.MOTORS_ON, True, "")


def egm_runs(state_machines: list[tuple[str, int]], tasks: tuple[str, ...]) -> bool | None:
    """Whether the state machine of every task runs EGM.

    Args:
        state_machines: RAPID task and its ``sm_state``.
        tasks: of both arms, such as ``T_ROB_L`` and ``T_ROB_R``.

    Returns:
        None if a task is not among the state machines.
    """
    states = dict(state_machines)
    if any(task not in states for task in tasks):
        return None
    return all(states[task] == _EGM_RUNNING for task in tasks)
