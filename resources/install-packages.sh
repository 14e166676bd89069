#!/bin/bash
# Installs the Debian packages of the given sections of debian-packages.txt, where any is missing.
# Usage: resources/install-packages.sh build run ...
set -euo pipefail
list="$(dirname "${BASH_SOURCE[0]}")/debian-packages.txt"

if ! command -v dpkg-query >/dev/null; then
    echo "This is not Debian: install the equivalents of $list yourself. Going on with what is here." >&2
    exit 0
fi

wanted=()
for section in "$@"; do
    mapfile -t names < <(awk -v want="[$section]" '
        { sub(/#.*/, "") } /^\[/ { inside = ($1 == want); next } inside && NF { print $1 }' "$list")
    [ "${#names[@]}" -gt 0 ] || { echo "debian-packages.txt has no section [$section]." >&2; exit 2; }
    wanted+=("${names[@]}")
done

installed="$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' "${wanted[@]}" 2>/dev/null |
    awk '$1 == "ii" || $1 == "hi" { print $2 }' || true)"
missing=()
for name in "${wanted[@]}"; do
    grep -qxF -- "$name" <<<"$installed" || missing+=("$name")
done
[ "${#missing[@]}" -gt 0 ] || exit 0

apt=(env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 -o Dpkg::Use-Pty=0 -qq -y)
install=(install --no-install-recommends "${missing[@]}")
prefix=()
if [ "$(id -u)" -ne 0 ]; then
    # Without a terminal sudo cannot ask for a password.
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
        prefix=(sudo)
    else
        {
            echo "These Debian packages are missing: ${missing[*]}"
            echo "Install them as root, then start again:"
            echo "    apt-get update && apt-get install --no-install-recommends ${missing[*]}"
        } >&2
        exit 1
    fi
fi
echo "Installing ${#missing[@]} missing Debian packages: ${missing[*]}" >&2
"${prefix[@]}" "${apt[@]}" update >&2
"${prefix[@]}" "${apt[@]}" "${install[@]}" >&2 </dev/null
