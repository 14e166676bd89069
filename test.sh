#!/bin/bash
# Installs what is missing, builds and runs the tests. ./test.sh --help says more.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
cd "$root"
usage() {
    cat <<END
Usage: ./test.sh           what is shipped, in release (core, panels, programs, real window and processes), then core,
                           devices and projects under ASan+UBSan
       ./test.sh --quick   all tests, in release only
       ./test.sh --full    everything: all tests in release and under both sanitizers, 100 kills instead of 10,
                           clang-tidy, formatting, every benchmark run once
The last line is the summary over all runs; the exit code is 0 when nothing failed.
END
}
mode=default
case "${1:-}" in
    "") ;;
    --quick) mode=quick ;;
    --full) mode=full ;;
    --help | -h) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
esac

sections=(build run test)
[ "$mode" = quick ] || sections+=(sanitize bench)
[ "$mode" = full ] && sections+=(lint)
resources/install-packages.sh "${sections[@]}"

export CCACHE_BASEDIR="$root" CCACHE_NOHASHDIR=1 CTEST_OUTPUT_ON_FAILURE=1
jobs="$(nproc)"
total=0
failed=0
failures=()  # lines for the summary

say() { printf '\n==== %s\n' "$*"; }

# build PRESET TARGET...: configures and builds; a build that fails ends the run.
build() {
    local preset="$1"
    shift
    say "building $preset: $*"
    cmake --preset "$preset" --log-level=WARNING
    cmake --build --preset "$preset" --parallel "$jobs" --target "$@"
}

# tests PRESET CTEST_ARGUMENT...: runs ctest and adds its counts to the summary.
tests() {
    local preset="$1" log summary status=0
    shift
    log="build/$preset/ctest.log"
    say "testing $preset"
    ctest --test-dir "build/$preset" --parallel "$jobs" --no-tests=error "$@" 2>&1 | tee "$log" || status=$?
    summary="$(grep -E 'tests passed, [0-9]+ tests failed out of [0-9]+' "$log" | tail -n 1 || true)"
    if [ -z "$summary" ]; then
        failed=$((failed + 1)) total=$((total + 1))
        failures+=("$preset: ctest ended with status $status and no summary")
        return
    fi
    failed=$((failed + $(sed -E 's/.* ([0-9]+) tests failed.*/\1/' <<<"$summary")))
    total=$((total + $(sed -E 's/.*out of ([0-9]+).*/\1/' <<<"$summary")))
    while read -r line; do failures+=("$preset: $line"); done < <(
        sed -n '/The following tests FAILED/,$p' "$log" | grep -E '^[[:space:]]+[0-9]+ - ' || true)
}

# check NAME COMMAND...: one check that is not ctest's, counted as one test.
check() {
    local name="$1"
    shift
    say "$name"
    total=$((total + 1))
    if ! "$@"; then
        failed=$((failed + 1))
        failures+=("$name")
    fi
}

sources() { git ls-files --cached --others --exclude-standard -- '*.cpp' '*.h'; }
formatted() { sources | xargs clang-format-19 --dry-run --Werror; }
tidy() {
    # File by file: neither joined nor behind precompiled headers.
    cmake --preset asan-ubsan -B build/tidy -DCMAKE_UNITY_BUILD=OFF -DILF_PCH=OFF --log-level=WARNING
    cmake --build build/tidy --target ilf_generated_messages
    sources | grep '\.cpp$' | grep -v -E '^tests/(bench|layers)/' |
        xargs -P "$jobs" -n 4 clang-tidy-19 -p build/tidy --quiet --warnings-as-errors='*'
}
benchmarks() {
    local bench status=0
    for bench in build/release/bin/bench_*; do
        [ -x "$bench" ] || continue
        echo "-- $(basename "$bench")"
        "$bench" --benchmark_min_time=0.1 || status=1
    done
    return "$status"
}

export ILF_KILLS="${ILF_KILLS:-$([ "$mode" = full ] && echo 100 || echo 10)}"
support="$root/tests/support"
export ASAN_OPTIONS="detect_stack_use_after_return=1:strict_string_checks=1"
export LSAN_OPTIONS="suppressions=$support/lsan.supp:print_suppressions=0"
export UBSAN_OPTIONS="print_stacktrace=1"
export TSAN_OPTIONS="suppressions=$support/tsan.supp:halt_on_error=0:second_deadlock_stack=1"
case "$mode" in
    quick)
        build release all
        tests release
        ;;
    default)
        # Drivers and files are built for the sanitizers only: once is enough, and half the time is compiling.
        build release illuminatedfocus illuminatedfocus-core make-samples optics_stress test_core test_ui test_app test_process
        tests release --exclude-regex '^(devices|projects)/'
        build asan-ubsan test_core test_devices test_projects
        tests asan-ubsan --tests-regex '^(core|devices|projects)/'
        ;;
    full)
        build release all benches
        tests release
        unit=(test_core test_devices test_projects test_ui test_app)
        for preset in asan-ubsan tsan; do
            build "$preset" "${unit[@]}"
            tests "$preset" --tests-regex '^(core|devices|projects|ui|app)/'
        done
        check "clang-format" formatted
        check "clang-tidy" tidy
        check "benchmarks" benchmarks
        ;;
esac

say "summary"
if [ "${#failures[@]}" -gt 0 ]; then printf 'FAILED %s\n' "${failures[@]}"; fi
percent=0
[ "$total" -eq 0 ] || percent=$(((total - failed) * 100 / total))
echo "$percent% tests passed, $failed tests failed out of $total"
[ "$failed" -eq 0 ]
