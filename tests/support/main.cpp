// One main for every test executable: doctest's, with the output flushed before the leak checker ends the process.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>

int main(int argc, char** argv) {
    doctest::Context context(argc, argv);
    const int result = context.run();
    std::fflush(stdout);
    return result;
}
