#!/bin/bash
# Installs what is missing, builds, and opens the studio. ./run.sh --help says more.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
sample="$root/projects/samples/museum-guide.ilfd"

usage() {
    cat <<END
Usage: ./run.sh                    open the studio on the museum sample, with simulated devices
       ./run.sh --rig emulated     the same over the drivers of real devices and emulated cables (also --rig FILE,
                                   --bits N, --simulated-lens LENS)
       ./run.sh --headless [FILE]  no window: plan, compile and play FILE (the museum sample) for 2 s on a core of its
                                   own; pictures and report go to ./results; takes --rig and its like as well
       ./run.sh ARGUMENTS...       pass ARGUMENTS to the studio: a project or picture, or a command such as
                                   plan, render, validate, run, --list-bindings, --version
Without a display the first two do what --headless does. The exit code is the program's:
0 done, 1 failed, 2 usage, 3 device, 4 unsafe plan.
END
}
if [ "${1:-}" = "--help" ] || [ "${1:-}" = "-h" ]; then
    usage
    exit 0
fi

"$root/resources/install-packages.sh" build run

# Talk of the build goes to stderr, so that e.g. `./run.sh plan FILE --json` can be piped.
build="$root/build/release"
export CCACHE_BASEDIR="$root" CCACHE_NOHASHDIR=1
{
    cmake -S "$root" --preset release --log-level=WARNING -DBUILD_TESTING=OFF
    cmake --build "$build" --parallel "$(nproc)"
} >&2
studio="$build/bin/illuminatedfocus"

# FILE may be anywhere among options that take a value; none: the sample.
headless() {
    local results="$root/results" status=0
    only_rig_options "$@" && set -- "$sample" "$@"
    mkdir -p "$results"
    "$studio" run "$@" --seconds 2 --report "$results/report.json" --pictures "$results" || status=$?
    echo "Written to $results:"
    find "$results" -type f -printf '  %P  (%s bytes)\n' | sort
    exit "$status"
}

# Nothing, or nothing but which rig and lens to play on: then there is a sample to open.
only_rig_options() {
    while [ "$#" -gt 0 ]; do
        case "$1" in
            --rig | --bits | --simulated-lens) [ "$#" -ge 2 ] && shift 2 || return 1 ;;
            --rig=* | --bits=* | --simulated-lens=*) shift ;;
            *) return 1 ;;
        esac
    done
}

if [ "${1:-}" = "--headless" ]; then
    shift
    headless "$@"
elif ! only_rig_options "$@"; then
    exec "$studio" "$@"
elif [ -z "${DISPLAY:-}" ]; then
    echo "No display (DISPLAY is not set): running without a window, as ./run.sh --headless does." >&2
    headless "$@"
else
    exec "$studio" "$sample" "$@"
fi
