#!/usr/bin/env bash
# make_keystore.sh FOLDER: a keystore with one enclave for each node of the suite, from policy.xml beside this script.
# Needs a sourced ROS 2 Jazzy with ros2 security (package sros2). Run it again after changing the policy.
set -euo pipefail
here=$(cd -P "$(dirname "${BASH_SOURCE[0]}")" && pwd)
[[ $# -eq 1 ]] || { sed -n '2,3s/^# //p' "${BASH_SOURCE[0]}" >&2; exit 2; }
keystore=$1
command -v ros2 >/dev/null || { echo "error: source ROS 2 Jazzy first: source /opt/ros/jazzy/setup.bash" >&2; exit 1; }
ros2 security --help >/dev/null 2>&1 || { echo "error: sudo apt install ros-jazzy-sros2" >&2; exit 1; }

umask 077 # private keys are for their owner
[[ -d $keystore ]] || ros2 security create_keystore "$keystore"
ros2 security generate_artifacts -k "$keystore" -p "$here/policy.xml"

cat <<TEXT
The keystore is in $keystore. In every terminal, before launching:
  export ROS_SECURITY_KEYSTORE=$(realpath "$keystore")
  export ROS_SECURITY_ENABLE=true
  export ROS_SECURITY_STRATEGY=Enforce   # Permissive, the default, lets everybody in who has no key
and for ros2 commands:
  export ROS_SECURITY_ENCLAVE_OVERRIDE=/singulation/admin
TEXT
