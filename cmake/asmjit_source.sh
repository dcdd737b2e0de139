#!/usr/bin/env bash
# Gets the source of asmjit, of which a build for Windows makes its machine code: Debian has the library for its own processors
# only. By Debian's tools out of its archive, with their checks of signatures, and without a trace elsewhere.
# usage: asmjit_source.sh FOLDER      FOLDER/src/asmjit is there then
set -euo pipefail
mkdir -p "${1:?}"
folder=$(cd "$1" && pwd)
[ -e "$folder/src/asmjit" ] && exit

apt=$folder/apt
rm -rf "$apt"
mkdir -p "$apt/lists/partial" "$apt/archives/partial"
# The archives this Debian has its packages from; often its own list says nothing of their sources.
keys=/usr/share/keyrings/debian-archive-keyring.gpg
apt-get indextargets --format "deb-src [signed-by=$keys] \$(REPO_URI) \$(RELEASE) main" \
  'Created-By: Packages' 'Label: Debian' 'Component: main' | sort -u >"$apt/sources.list"
cat >"$apt/apt.conf" <<EOC
APT::Sandbox::User "root";
Dir { State "$apt"; State::status "/dev/null"; Cache "$apt"; Etc { SourceList "$apt/sources.list"; SourceParts "/dev/null"; }; };
EOC
export APT_CONFIG=$apt/apt.conf
apt-get update -qq
# apt has checked the files; dpkg-source would look for the key of a person.
(cd "$apt" && apt-get source -qq --download-only asmjit && dpkg-source --no-check --no-copy -x asmjit_*.dsc source >/dev/null)
mv "$apt/source/src" "$folder/"
rm -rf "$apt"
