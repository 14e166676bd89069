// One main for every test executable: doctest's, but a run of nothing is a failure, and the output is flushed before
// the leak checker ends the process.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>

namespace {

unsigned casesRun = 0;

/// Counts what the filters let through: ctest selects by file name, and a name that matches nothing must not pass.
struct Counter : doctest::IReporter {
    explicit Counter(const doctest::ContextOptions&) {}
    void report_query(const doctest::QueryData&) override {}
    void test_run_start() override {}
    void test_run_end(const doctest::TestRunStats& stats) override { casesRun = stats.numTestCasesPassingFilters; }
    void test_case_start(const doctest::TestCaseData&) override {}
    void test_case_reenter(const doctest::TestCaseData&) override {}
    void test_case_end(const doctest::CurrentTestCaseStats&) override {}
    void test_case_exception(const doctest::TestCaseException&) override {}
    void subcase_start(const doctest::SubcaseSignature&) override {}
    void subcase_end() override {}
    void log_assert(const doctest::AssertData&) override {}
    void log_message(const doctest::MessageData&) override {}
    void test_case_skipped(const doctest::TestCaseData&) override {}
};
REGISTER_LISTENER("counter", 1, Counter);

}  // namespace

int main(int argc, char** argv) {
    setenv("RC_PARAMS", "seed=20260101 max_success=100", 0);  // the laws' seed, unless the environment says otherwise
    doctest::Context context(argc, argv);
    int result = context.run();
    if (!context.shouldExit() && casesRun == 0) {
        std::printf("No test case matches: %s\n", argc > 1 ? argv[1] : "(no filter)");
        result = 1;
    }
    std::fflush(stdout);
    return result;
}
