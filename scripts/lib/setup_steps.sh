# Sourced by scripts/setup: its three steps. A step leaves its stamp last, so an interrupted one is done again.
# shellcheck shell=bash

logged() { # log name, command: its output goes to the log, and to the terminal only when it fails
  local log=$WORKSPACE/log/$1
  mkdir -p "$WORKSPACE/log"
  if "${@:2}" >"$log" 2>&1 </dev/null; then return 0; fi
  tail -n 40 "$log" >&2
  say "the whole log: $log"
  return 1
}

needed_packages() { # route
  if [[ $1 == pypi ]]; then
    command -v cmake >/dev/null || echo cmake
    command -v g++ >/dev/null || echo g++
    command -v make >/dev/null || echo make
  fi
  local libraries
  libraries=$(ldconfig -p 2>/dev/null || /sbin/ldconfig -p)
  while read -r library package; do # what Open3D loads
    [[ $libraries == *"$library"* ]] || echo "$package"
  done <<'LIST'
libusb-1.0.so.0 libusb-1.0-0
libgomp.so.1 libgomp1
libGL.so.1 libgl1
libEGL.so.1 libegl1
libX11.so.6 libx11-6
LIST
}

test_packages() { # for tests only: the page of a run is looked at in a browser
  local name
  for name in chromium chromium-browser google-chrome; do
    if command -v "$name" >/dev/null; then return; fi
  done
  echo chromium
}

ensure_test_packages() { # without them all but a few tests can run
  (install_packages "$(test_packages)") || say "going on without; the tests that need it will fail"
}

ensure_system_packages() { # route
  install_packages "$(needed_packages "$1" | tr '\n' ' ')"
}

install_packages() { # names, separated by blanks
  local missing=$1 command
  [[ -n ${missing// /} ]] || return 0
  command="apt-get update && apt-get install -y --no-install-recommends -o DPkg::Lock::Timeout=120 ${missing% }"
  if [[ $SYSTEM_PACKAGES == install ]] && command -v apt-get >/dev/null; then
    if [[ $(id -u) == 0 ]]; then
      say "installing Debian/Ubuntu packages: $missing"
      DEBIAN_FRONTEND=noninteractive logged apt.txt bash -c "$command" && return 0
    elif sudo -n true 2>/dev/null; then
      say "installing Debian/Ubuntu packages with sudo: $missing"
      logged apt.txt sudo -n env DEBIAN_FRONTEND=noninteractive bash -c "$command" && return 0
    fi
  fi
  fail "packages are missing. Install them with this command, then run again:
       sudo sh -c '$command'"
}

requirement_files() { # route
  if [[ $1 == sourced ]]; then
    echo "$ROOT/requirements/cell.txt" "$ROOT/requirements/development.txt"
  elif [[ ${SINGULATION_PINS:-} == cell ]]; then
    echo "$ROOT/requirements/ros.txt" "$ROOT/requirements/cell_pins.txt" "$ROOT/requirements/development.txt"
  else
    echo "$ROOT/requirements/ros.txt" "$ROOT/requirements/libraries.txt" "$ROOT/requirements/development.txt"
  fi
}

ensure_environment() { # route
  local route=$1 files wanted python options=()
  read -r -a files <<<"$(requirement_files "$route")"
  wanted="$route $(cat "${files[@]}" "$ROOT/requirements/constraints.txt" | cksum)"
  if [[ $(cat "$VENV/.stamp" 2>/dev/null) == "$wanted" ]] && "$VENV/bin/python" -c '' 2>/dev/null; then
    [[ $QUIET == yes ]] || say "environment is up to date ($VENV)"
    return
  fi
  if [[ $route == sourced ]]; then python=$(find_python '3\.12'); options=(--system-site-packages)
  elif [[ ${SINGULATION_PINS:-} == cell ]]; then python=$(find_python '3\.12')
  else python=$(find_python '3\.1[123]'); fi
  say "making the virtual environment ${VENV#"$ROOT/"} with $python ($("$python" --version)), ROS: $route"
  "$VENV/bin/python" -c 'import pip' 2>/dev/null || "$python" -m venv --clear "${options[@]}" "$VENV"
  say "installing Python packages (about 2.2 GB on disk, 1 to 3 minutes)"
  if [[ $route == pypi ]]; then
    local constraint=(-c "$ROOT/requirements/constraints.txt")
  else
    local constraint=()
  fi
  logged pip.txt "$VENV/bin/python" -m pip install --disable-pip-version-check --no-input "${constraint[@]}" \
    "${files[@]/#/-r}" || fail "pip could not install the packages; its words are above"
  [[ ${SINGULATION_PINS:-} != cell ]] || logged pip_without_dependencies.txt "$VENV/bin/python" -m pip install --no-input --no-deps \
    -r "$ROOT/requirements/cell_pins_without_dependencies.txt" || fail "pip could not install Pinocchio; its words are above"
  [[ $route == sourced ]] || "$VENV/bin/python" "$ROOT/scripts/lib/mend_cmake_paths.py" >&2
  printf '%s\n' "$route" >"$VENV/.route"
  rm -rf "$WORKSPACE/build" "$WORKSPACE/install"
  printf '%s\n' "$wanted" >"$VENV/.stamp"
}

build_inputs() { # what a build depends on; Python sources are linked, so their edits need none
  cd "$WORKSPACE/src" && find . \( -name package.xml -o -name 'setup.*' -o -name CMakeLists.txt -o -name '*.msg' -o -name '*.srv' \
    -o -name '*.action' -o -path '*/launch/*' -o -path '*/config/*' -o -path '*/urdf/*' -o -path '*/rviz/*' -o -path '*/foxglove/*' \
    -o -path '*/security/*' \) -type f -print0 | sort -z | xargs -0 cksum
}

ensure_build() { # route
  local wanted
  wanted="$ROOT $(cat "$VENV/.stamp") $(build_inputs | cksum)"
  if [[ $(cat "$WORKSPACE/install/.stamp" 2>/dev/null) == "$wanted" ]]; then
    [[ $QUIET == yes ]] || say "workspace is up to date ($WORKSPACE/install)"
    return
  fi
  say "building the workspace with colcon (about half a minute the first time)"
  [[ $(cat "$WORKSPACE/install/.root" 2>/dev/null) == "$ROOT" ]] || rm -rf "$WORKSPACE/build" "$WORKSPACE/install"
  mkdir -p "$WORKSPACE/install"
  printf '%s\n' "$ROOT" >"$WORKSPACE/install/.root"
  rm -f "$WORKSPACE/install/.stamp"
  logged build.txt colcon_build "$1" || fail "colcon build failed; its words are above"
  printf '%s\n' "$wanted" >"$WORKSPACE/install/.stamp"
}

colcon_build() ( # route; in a subshell, for its folder and environment
  cd "$WORKSPACE" || exit 1
  export PATH=$VENV/bin:$PATH VIRTUAL_ENV=$VENV
  [[ $1 != pypi ]] || export AMENT_PREFIX_PATH=$VENV CMAKE_PREFIX_PATH=$VENV
  # Through this environment's Python, so that the executables start with it.
  "$VENV/bin/python" -m colcon build --symlink-install --event-handlers console_direct+ \
    --cmake-args -DBUILD_TESTING=OFF -DPython3_EXECUTABLE="$VENV/bin/python" -DPython3_FIND_VIRTUALENV=ONLY
)

kernel_sources() { # files with compiled functions, and those that say how they are compiled
  grep -rlE --include='*.py' '^@(njit|compiled)|numba\.njit|njit\(' "$WORKSPACE/src" | sort
}

ensure_compiled() {
  local wanted
  [[ -d $WORKSPACE/install/singulation_bringup ]] || return 0 # a layer of a container image without our packages
  wanted="$(cat "$VENV/.stamp") $(kernel_sources | xargs cksum | cksum) $(uname -m) $(grep -m1 'model name' /proc/cpuinfo || true)"
  [[ $(cat "$WORKSPACE/install/.compiled" 2>/dev/null) != "$wanted" ]] || return 0
  say "compiling the numerical kernels (about a minute the first time)"
  # Numba does not notice that a function in another file, compiled into this one, has changed.
  find -L "$WORKSPACE/src" -name '*.nb[ic]' -delete
  (
    SINGULATION_ENV='' # our own environment, whatever called us
    source "$ROOT/scripts/lib/environment.sh"
    logged compile.txt "$VENV/bin/python" -m singulation_bringup.commands.compile_kernels
  ) || fail "the kernels could not be compiled; the words of the compiler are above"
  printf '%s\n' "$wanted" >"$WORKSPACE/install/.compiled"
}
