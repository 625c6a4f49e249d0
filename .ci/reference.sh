#!/usr/bin/env bash
# Mitsuba with an LLVM it can use, and FLIP: for the long tests of the renderer only.
# usage: reference.sh VENV
set -euo pipefail
venv=$1
"$venv/bin/python" -m pip --disable-pip-version-check install --quiet --group reference
ldconfig -p | grep -qE 'libLLVM(-|\.so\.)(1[7-9]|2[0-9])' && exit 0
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends libllvm19 >/dev/null
else
    echo "Mitsuba needs LLVM 17 or later; as root: apt-get install libllvm19" >&2
    exit 2
fi
