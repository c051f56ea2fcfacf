# Sourced by every script here: where the project is, how steps are said, which Python is used.
# shellcheck shell=bash
set -euo pipefail

say() { printf '%s %s\n' "==>" "$*" >&2; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

# CMake, colcon and shebang lines break on blanks in a path. Such a project is worked on through a link without blanks.
project_root() {
  local real link
  real=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
  if [[ $real =~ ^[A-Za-z0-9_/.+-]+$ ]]; then printf '%s\n' "$real"; return; fi
  link="${TMPDIR:-/tmp}/singulation-$(id -u)-$(printf '%s' "$real" | cksum | cut -d' ' -f1)"
  [[ $link =~ ^[A-Za-z0-9_/.+-]+$ ]] || link="/tmp/${link##*/}"
  ln -sfn "$real" "$link"
  printf '%s\n' "$link"
}

ROOT=$(project_root)
VENV=$ROOT/.venv
WORKSPACE=$ROOT/ros2_ws
# scripts/test --cell-pins: an environment and a build beside the usual ones, of the same sources.
if [[ ${SINGULATION_PINS:-} == cell ]]; then
  VENV=$ROOT/.cell/venv
  WORKSPACE=$ROOT/.cell/ros2_ws
  mkdir -p "$WORKSPACE"
  ln -sfn ../../ros2_ws/src "$WORKSPACE/src"
fi
export ROOT VENV WORKSPACE

# "sourced" where a ROS 2 Jazzy installation is sourced, else "pypi".
ros_route() {
  if [[ ${ROS_DISTRO:-} == jazzy && -n ${AMENT_PREFIX_PATH:-} && -z ${SINGULATION_ENV:-} ]]; then
    echo sourced
  elif [[ -f $VENV/.route ]]; then
    cat "$VENV/.route"
  else
    echo pypi
  fi
}
