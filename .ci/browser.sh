#!/usr/bin/env bash
# Chromium and its driver, for the tests of the gallery page only.
# usage: browser.sh VENV
set -euo pipefail
venv=$1
"$venv/bin/python" -m pip --disable-pip-version-check install --quiet --group browser
command -v chromium >/dev/null && exit 0
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium >/dev/null
else
    echo "the page tests need Chromium; as root: apt-get install chromium" >&2
    exit 2
fi
