#!/usr/bin/env bash
# Make the virtual environment and install seatlook in it, editable.
# usage: environment.sh VENV
set -euo pipefail
venv=$1

can_apt() { [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; }
apt() {
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}
find_python() {
    local candidate
    for candidate in ${PYTHON:-python3.11 python3.12 python3.13 python3}; do
        if command -v "$candidate" >/dev/null &&
            "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
            echo "$candidate"
            return
        fi
    done
}

python=$(find_python)
if [ -z "$python" ] && can_apt; then
    apt python3 python3-venv
    python=$(find_python)
fi
if [ -z "$python" ]; then
    echo "seatlook needs Python 3.11 or later; install it, or name it: make PYTHON=/path/to/python3" >&2
    exit 2
fi

if ! [ -x "$venv/bin/python" ] || ! "$venv/bin/python" -m pip --version >/dev/null 2>&1; then
    echo "making $venv with $("$python" --version)" >&2
    if ! "$python" -c 'import ensurepip' 2>/dev/null; then
        # Debian splits ensurepip from python3.
        if can_apt; then
            apt python3-venv
        elif "$python" -m pip --version >/dev/null 2>&1; then
            "$python" -m venv --without-pip "$venv"
            "$python" -m pip --python "$venv/bin/python" install --quiet pip
        else
            echo "this Python cannot make environments; as root: apt-get install python3-venv" >&2
            exit 2
        fi
    fi
    [ -x "$venv/bin/pip" ] || "$python" -m venv "$venv"
fi

echo "installing seatlook and its packages" >&2
pip=("$venv/bin/python" -m pip --disable-pip-version-check --quiet)
# Dependency groups came with pip 25.1.
"${pip[@]}" install --upgrade 'pip>=25.1'
"${pip[@]}" install --editable .
