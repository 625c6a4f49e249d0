#!/usr/bin/env bash
# Chromium and its driver, three.js, and what checks scripts, for the tests of the page and the GLB.
# usage: browser.sh VENV
set -euo pipefail
venv=$1
apt() {
    if [ "$(id -u)" != 0 ] || ! command -v apt-get >/dev/null; then
        echo "the page tests need $1; as root: apt-get install $*" >&2
        exit 2
    fi
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}
"$venv/bin/python" -m pip --disable-pip-version-check install --quiet --group browser
command -v npm >/dev/null || apt npm
npm install --silent --no-audit --no-fund --no-save --prefix "$venv/three" three@0.187.0 \
    typescript@7.0.2 eslint@10.15.0 @eslint/js@10.0.1
command -v chromium >/dev/null || apt chromium
