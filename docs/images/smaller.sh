#!/usr/bin/env bash
# Makes pictures of screens a third of their size: smaller.sh PICTURE.png...
# A screen has few colours, so a palette of 48 shows the same. Needs pngquant and optipng.
set -euo pipefail
pngquant --force --speed 1 --ext .png 48 "$@"
optipng -quiet -o3 "$@"
