# Sourced: puts the built workspace into the environment of this shell.
# shellcheck shell=bash
# The guard keeps a nested call from taking our own environment for a sourced ROS installation.
if [[ -z ${SINGULATION_ENV:-} ]]; then
  route=$(ros_route)
  if [[ $route == pypi ]]; then
    export AMENT_PREFIX_PATH=$VENV CMAKE_PREFIX_PATH=$VENV ROS_DISTRO=jazzy ROS_VERSION=2 ROS_PYTHON_VERSION=3
  fi
  export VIRTUAL_ENV=$VENV PATH=$VENV/bin:$PATH
  set +u
  # shellcheck disable=SC1091
  [[ ! -f $WORKSPACE/install/local_setup.bash ]] || source "$WORKSPACE/install/local_setup.bash"
  set -u
  export SINGULATION_ENV=$route
  # Discovery stays on this machine unless the user chose otherwise.
  export ROS_AUTOMATIC_DISCOVERY_RANGE=${ROS_AUTOMATIC_DISCOVERY_RANGE:-LOCALHOST}
  export MPLBACKEND=${MPLBACKEND:-Agg} PYTHONUNBUFFERED=1
fi
