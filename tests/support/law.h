// A law of the code, checked on random values inside a doctest TEST_CASE.
#pragma once

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <sstream>
#include <string>
#include <utility>

namespace ilf {

/// Checks `testable` (a lambda; its arguments are generated, or drawn inside with `*rc::gen::...`) on 100 values with
/// the fixed seed of main.cpp, so that a failure seen once is seen again. The environment's RC_PARAMS
/// ("seed=1 max_success=5000") is taken instead where it is set. Inside, state with RC_ASSERT or return a bool:
/// doctest's CHECK would report the failure but rapidcheck could not shrink it. The counterexample is printed with the
/// failing check.
template <class Testable>
void law(const std::string& sentence, Testable&& testable) {
    rc::detail::TestMetadata metadata;
    metadata.id = sentence;
    metadata.description = sentence;
    const rc::detail::TestResult result = rc::detail::checkTestable(std::forward<Testable>(testable), metadata);
    std::ostringstream outcome;
    rc::detail::printResultMessage(result, outcome);
    const bool holds = result.template is<rc::detail::SuccessResult>();
    CHECK_MESSAGE(holds, sentence, "\n", outcome.str());
}

}  // namespace ilf
