# For the scripts of this folder: an empty folder to work in, and messages.
source=$1 build=$2
: "${CC:=cc}" "${CXX:=c++}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*" >&2; exit 1; }
skip() { echo "skipped: $*"; exit 77; }
need() { command -v "$1" >/dev/null || skip "$1 is not installed"; }
# What a program prints has to be this.
expect() { [ "$1" = "$2" ] || fail "expected: $2
but it is: $1"; }
