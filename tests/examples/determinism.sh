#!/usr/bin/env bash
# Trace hashes of all examples by several builds of `ipos` side by side; fails when two differ.
#   tests/examples/determinism.sh build/release/tools/ipos build/dev/tools/ipos build/clang/tools/ipos
set -euo pipefail
[ $# -ge 2 ] || { sed -n '2,3s/^# \{0,1\}//p' "$0"; exit 64; }
examples=$(cd "$(dirname "$0")/../../examples" && pwd)
seconds=${SECONDS_EACH:-20}
status=0 plants=0
while read -r plant; do
  hashes=()
  for ipos in "$@"; do
    hashes+=("$("$ipos" run "$plant" --for "${seconds}s" --trace-hash=1ms 2>&1 >/dev/null | sed -n 's/^trace hash //p' || true)")
  done
  verdict=equal
  for hash in "${hashes[@]}"; do
    [ -n "$hash" ] && [ "$hash" = "${hashes[0]}" ] || { verdict=DIFFERENT; status=1; }
  done
  printf '%-45s %s %s\n' "${plant#"$examples"/}" "$verdict" "${hashes[0]:-none}"
  plants=$((plants + 1))
done < <(find "$examples" -name '*.toml' ! -name '*.test.toml' ! -name '*.campaign.toml' | sort)
echo "$plants plants, ${seconds} s each, $# builds"
exit $status
