# Sourced: finds a CPython that really runs. A pyenv shim may be on the PATH and answer "command not found".
# shellcheck shell=bash

python_works() { # program, accepted versions as a regular expression
  local version
  version=$("$1" -c 'import sys, venv, ensurepip; print("%d.%d" % sys.version_info[:2])' 2>/dev/null) || return 1
  [[ $version =~ ^($2)$ ]]
}

python_candidates() {
  local minor root
  [[ -z ${SINGULATION_PYTHON:-} ]] || printf '%s\n' "$SINGULATION_PYTHON"
  for minor in 12 13 11; do
    printf '%s\n' "python3.$minor" "/usr/bin/python3.$minor" "/usr/local/bin/python3.$minor" "/opt/python3.$minor/bin/python3"
    for root in "${PYENV_ROOT:-$HOME/.pyenv}" "$HOME/.local/share/uv/python"; do
      compgen -G "$root/versions/3.$minor.*/bin/python3" || true
      compgen -G "$root/cpython-3.$minor.*/bin/python3" || true
    done
  done
  printf 'python3\n'
}

find_python() { # accepted versions as a regular expression
  local candidate
  while read -r candidate; do
    if python_works "$candidate" "$1"; then "$candidate" -c 'import sys; print(sys.executable)'; return; fi
  done < <(python_candidates)
  fail "no usable CPython found (3.12 preferred; 3.11 and 3.13 serve too), with its venv module.
       Install one, for example: apt-get install python3.12 python3.12-venv
       or name one: SINGULATION_PYTHON=/path/to/python3.12 $0"
}
