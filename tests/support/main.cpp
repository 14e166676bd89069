// One main for every test executable: doctest's, with the output flushed before the leak checker ends the process.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    setenv("RC_PARAMS", "seed=20260101 max_success=100", 0);  // the laws' seed, unless the environment says otherwise
    doctest::Context context(argc, argv);
    const int result = context.run();
    std::fflush(stdout);
    return result;
}
