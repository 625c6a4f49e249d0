#!/usr/bin/env bash
# Give the environment a software GL library unless one is there: the vtk wheel carries none.
# As root by the package manager; otherwise unpacked below the environment, where it is preloaded.
# usage: gl.sh VENV
set -euo pipefail
venv=$1

# 0: there is a library; 3: there is none; anything else: seatlook itself does not load.
probe() { "$venv/bin/python" -m seatlook doctor >/dev/null; }
works() {
    local code=0
    reason=$(probe 2>&1) || code=$?
    if [ $code != 0 ] && [ $code != 3 ]; then
        echo "$reason" >&2
        exit 1
    fi
    return $code
}
works && exit 0

if ! command -v apt-get >/dev/null || ! command -v dpkg >/dev/null; then
    cat >&2 <<'END'
No software GL library is found, and this system has no apt-get to fetch one.
Install Mesa's OSMesa library (libOSMesa.so.8) or Mesa's EGL (libEGL.so.1 with llvmpipe)
by your system's package manager, then run make again.
END
    exit 3
fi

# OSMesa is the smaller one; Mesa has none since 25.1, nor has Debian from there on.
wanted() {
    # Not grep -q: it would end apt-cache by a signal.
    if LC_ALL=C apt-cache "$@" policy libosmesa6 | grep 'Candidate: [^(]' >/dev/null; then
        echo libosmesa6
    else
        echo libegl1 libgl1-mesa-dri
    fi
}

if [ "$(id -u)" = 0 ]; then
    apt-get update -qq
    names=$(wanted)
    echo "installing the software GL library ($names)" >&2
    # shellcheck disable=SC2086 -- several names
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $names >/dev/null
else
    target=$(cd "$venv" && pwd)/lib/seatlook-gl
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    mkdir -p "$work/lists/partial" "$work/archives/partial" "$target"
    # Own state and cache, so that no right beyond reading the system's configuration is needed.
    own=(-qq -o "Dir::State::Lists=$work/lists" -o "Dir::Cache=$work" -o "APT::Sandbox::User="
        -o Debug::NoLocking=1)
    apt-get "${own[@]}" update
    names=$(wanted "${own[@]}")
    echo "unpacking the software GL library ($names) below $venv" >&2
    # A simulated installation names exactly the packages that are not there yet.
    packages=$(apt-get "${own[@]}" --simulate --no-install-recommends install $names |
        awk '$1 == "Inst" {print $2}')
    (cd "$work" && apt-get "${own[@]}" download $names $packages)
    for package in "$work"/*.deb; do
        dpkg -x "$package" "$target"
    done
fi

if ! works; then
    echo "$reason" >&2
    echo "the software GL library was installed but does not work; see the lines above" >&2
    exit 3
fi
