"""The faults that are tried, each while the arm travels and while it pushes where that makes a difference."""

from collections.abc import Callable

from benchmarks.supervision.faults import Scenario, inject
from benchmarks.supervision.robot import BenchRobot

from yumi_push_executor.supervision import Phase, Supervisor

_BOTH = (Phase.APPROACH, Phase.PUSH)
_Happen = Callable[[BenchRobot, Supervisor], None]


def scenarios() -> list[Scenario]:
    """All of them, in the order of the list of fault cases."""
    return [*_states(), *_tracking(), *_requests(), *_stops(), *_commands(), *_hands()]


def _each(case: str, name: str, happen: _Happen, test: str, phases: tuple[Phase, ...] = _BOTH) -> list[Scenario]:
    when = dict.fromkeys(_BOTH, 0.6)
    return [Scenario(case, name, phase, when.get(phase, 0.0), happen, test) for phase in phases]


def _states() -> list[Scenario]:
    lost = "test_lost_states_stop_the_arm_on_its_path"
    return [
        *_each("E7", "joint states stop", inject("drop_states"), lost),
        *_each("E7", "joint states are NaN", inject("nan_states"), lost),
        *_each("E7", "joint states are all zero", inject("zero_states"), lost),
        *_each("E8", "joint states freeze", inject("freeze_states"), "test_frozen_states_are_noticed_and_not_believed"),
    ]


def _tracking() -> list[Scenario]:
    test = "test_an_arm_that_is_too_slow_is_stopped"
    return [*_each("E9, E10", "joints slower than ordered (0.02 rad/s)", inject("slow"), test)]


def _requests() -> list[Scenario]:
    test = "test_a_request_to_stop_is_obeyed_within_a_tenth_of_a_second_without_a_jump"
    return [
        *_each("E11", "cancel", lambda _, supervisor: supervisor.cancel(), test),
        *_each("E11", "halt", lambda _, supervisor: supervisor.halt("the halt service was called"), test),
    ]


def _stops() -> list[Scenario]:
    test = "test_a_safety_stop_ends_the_motion"
    names = ("emergency_stop", "guard_stop", "motors_off", "system_failure")
    found = [one for name in names for one in _each("E16", name.replace("_", " "), inject(name), test)]
    released = "test_a_released_emergency_stop_resumes_nothing"
    collided = "test_a_collision_waits_for_the_driver_and_then_lifts"
    uncleared = "test_a_collision_that_the_driver_does_not_clear_ends_without_a_retreat"
    link = "test_frozen_states_are_noticed_and_not_believed"
    return [
        *found,
        *_each("E16", "emergency stop, released after 0.1 s", inject("emergency_stop", 0.1), released),
        *_each("E18", "collision, cleared by the controller's handler", inject("collision"), collided),
        *_each("E18", "collision, not cleared", inject("collision", -1.0), uncleared),
        *_each("E14", "link to the controller lost (EGM)", inject("egm_timeout"), link),
    ]


def _commands() -> list[Scenario]:
    lost = "test_a_lost_order_ends_and_its_stop_does_not_start_the_arm"
    first = (Phase.GRIPPER,)
    return [
        *_each("E17", "orders get lost", inject("drop_commands"), lost, first),
        *_each("E17", "orders come 0.6 s late", inject("delay_commands", 0.6), lost, first),
    ]


def _hands() -> list[Scenario]:
    stuck = "test_jaws_that_do_not_move_are_stuck"
    calibration = "test_a_hand_that_loses_its_calibration_ends_the_motion"
    return [
        *_each("-", "jaws stuck", inject("gripper_stuck"), stuck, (Phase.GRIPPER,)),
        *_each("-", "hand loses its calibration", inject("gripper_uncalibrated"), calibration),
    ]
