#!/usr/bin/env bash
# Sources ROS, the virtual environment and the workspace, then runs the command.
set -eo pipefail # not -u: the setup files of ROS read variables that are not set
SUITE=${SUITE:-$(cd -P "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)}

# shellcheck disable=SC1090,SC1091
source "${ROS_SETUP:-/opt/ros/${ROS_DISTRO:-jazzy}/setup.bash}"
export VIRTUAL_ENV=$SUITE/.venv PATH=$SUITE/.venv/bin:$PATH
# shellcheck disable=SC1091
source "$SUITE/ros2_ws/install/local_setup.bash"

# With the host's network, discovery would otherwise reach every ROS system in the building.
export ROS_AUTOMATIC_DISCOVERY_RANGE=${ROS_AUTOMATIC_DISCOVERY_RANGE:-LOCALHOST}
export MPLBACKEND=${MPLBACKEND:-Agg} PYTHONUNBUFFERED=1
exec "$@"
