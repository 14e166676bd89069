#!/bin/bash
# Fails on an #include that breaks the layers, and on a header that does not say what it is for.
# Usage: check.sh ROOT
set -euo pipefail
cd "$1"
mapfile -t files < <(find app core ui devices projects tests -path tests/layers -prune -o \
    -type f \( -name '*.h' -o -name '*.cpp' \) -print 2>/dev/null | sort)
[ "${#files[@]}" -gt 0 ] || { echo "No sources under $1."; exit 1; }

awk '
# The folder whose rules a file follows: tests/core/... follows core (and may use tests/support besides).
function layerOf(path, parts, count) {
    count = split(path, parts, "/")
    if (parts[1] == "app" && parts[2] == "output_core" && count > 2) return "app/output_core"
    if (parts[1] == "app" && parts[2] == "core_main.cpp") return "app/output_core"
    return parts[1]
}
function complain(reason) { printf "%s:%d: %s\n", FILENAME, FNR, reason; bad = 1 }
BEGIN {
    ours = "^(app|core|ui|devices|projects|tests)/"
    may["core"] = "^core/"
    may["ui"] = "^(core|ui)/"
    may["devices"] = "^(core|devices)/"
    may["projects"] = "^(core|projects)/"
    may["app/output_core"] = "^((core|devices|app/output_core)/|app/rigs[.]h$)"
    may["app"] = "^(app|core|ui|devices|projects)/"
    mayTest["core"] = "^(core|tests/(core|support))/"
    mayTest["ui"] = "^(core|ui|tests/(ui|support))/"
    mayTest["devices"] = "^(core|devices|tests/(devices|support))/"
    mayTest["projects"] = "^(core|projects|tests/(projects|support))/"
}
FNR == 1 {
    header = FILENAME ~ /\.h$/
    layer = layerOf(FILENAME)
    if (layer == "tests") {
        split(FILENAME, testParts, "/")
        allowed = testParts[2] in mayTest ? mayTest[testParts[2]] : ours
    } else {
        allowed = may[layer]
    }
    if (header && $0 !~ /^\/\/ [^ \t]/) complain("the first line of a header is one // sentence saying what it is for")
}
/^[ \t]*#[ \t]*include[ \t]*["<]/ {
    name = $0
    sub(/^[^"<]*["<]/, "", name)
    sub(/[">].*/, "", name)
    quoted = $0 ~ /include[ \t]*"/
    if (name ~ /(^|\/)\.\.\//) complain("includes start at the repository root, not at " name)
    else if (name ~ ours) {
        if (name !~ allowed) complain((layer == "tests" ? "this test" : layer) " must not include " name)
    } else if (quoted && name ~ /\// && name !~ /^ilf\/version\.h$/)  # a bare name is a file of the same folder
        complain("\"" name "\": includes of ours start at the repository root, as in \"core/...\"")
    if (layer == "core" && name ~ /^(imgui|nlohmann|libusb|zmq|GLFW|epoxy|spdlog|opencv2\/(imgcodecs|videoio|highgui|opencv))/)
        complain("core is values and pure functions: it must not include " name)
    if (layer == "core" && header && FILENAME !~ /_cv\.h$/ && name ~ /^(opencv2|flatbuffers)/)
        complain("OpenCV stays inside .cpp files of core, and what they share in a header *_cv.h: " name)
    folder = FILENAME
    sub(/[^\/]*$/, "", folder)
    if (name ~ /^core\/.*_cv\.h$/ && (header || name !~ "^" folder "[^/]*$"))
        complain("only .cpp files of its own folder may include " name)
    if (header && name ~ /^nlohmann/ && name !~ /json_fwd/) complain("nlohmann json is never in a header (it compiles for seconds): " name)
    if (layer == "app/output_core" && name ~ /^(imgui|GLFW|epoxy|opencv2\/(imgcodecs|videoio|highgui))/)
        complain("the output core has no window and no pictures: " name)
}
END { exit bad }
' "${files[@]}"
echo "${#files[@]} files keep the layers."
