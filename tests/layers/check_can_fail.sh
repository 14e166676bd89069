#!/bin/bash
# Proves that check.sh sees what it is for: each file below breaks one rule, and must be named; a good tree must pass.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
tree="$(mktemp -d)"
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{app/output_core,core,ui,devices,projects,tests/core}

put() { printf '%s\n' "${@:2}" >"$tree/$1"; }
good() {
    put core/good.h '// A value that keeps the rules.' '#pragma once' '#include "core/other.h"' '#include <vector>'
    put core/good.cpp '#include "core/good.h"' '#include <opencv2/imgproc.hpp>'
    put ui/good.h '// A panel that knows core.' '#include "core/good.h"' '#include "ui/other.h"'
    put app/good.cpp '#include "ui/good.h"' '#include "devices/good.h"' '#include "ilf/version.h"'
    put tests/core/good.cpp '#include "core/good.h"' '#include "tests/support/law.h"' '#include <doctest/doctest.h>'
}
good
"$here/check.sh" "$tree" >/dev/null || { echo "check.sh refuses a good tree:"; "$here/check.sh" "$tree"; exit 1; }

caught=0
# breaks FILE LINE...: the check must fail and name FILE.
breaks() {
    put "$@"
    if report="$("$here/check.sh" "$tree" 2>&1)"; then
        echo "NOT CAUGHT: $*"
        exit 1
    fi
    grep -q "^$1:" <<<"$report" || { echo "$1 broke a rule, but the report names something else: $report"; exit 1; }
    rm "$tree/$1"
    caught=$((caught + 1))
}
breaks core/bad.cpp '#include "devices/stage.h"'
breaks core/bad.h '// A value.' '#include "ui/panel.h"'
breaks core/bad.h '// A value.' '#include <opencv2/core.hpp>'
breaks core/bad.cpp '#include "core/lens/parts_cv.h"'
breaks core/bad.h '// A value.' '#include "core/parts_cv.h"'
breaks core/bad.cpp '#include <imgui.h>'
breaks core/bad.cpp '#  include <nlohmann/json.hpp>'
breaks ui/bad.cpp '#include "projects/file.h"'
breaks devices/bad.cpp '#include "ui/panel.h"'
breaks projects/bad.h '// A file.' '#include <nlohmann/json.hpp>'
breaks projects/bad.cpp '#include "app/editor.h"'
breaks projects/bad.cpp '#include "../core/good.h"'
breaks core/bad.cpp '#include "optics/units.h"'
breaks app/output_core/bad.cpp '#include "projects/file.h"'
breaks app/output_core/bad.cpp '#include <GLFW/glfw3.h>'
breaks tests/core/bad.cpp '#include "ui/good.h"'
breaks ui/bad.h '#pragma once'
echo "check.sh catches all $caught broken files."
