#include "app/output_core/events.h"

#include <doctest/doctest.h>

#include <regex>
#include <set>
#include <string>

#include "tests/projects/folder.h"

namespace ilf::app {

TEST_CASE("events: each has a number of its own, and the operator's table lists it with its sentence") {
    const std::filesystem::path root(ILF_SOURCE_DIR);
    const std::string header = contentOf(root / "app/output_core/events.h");
    const std::string table = contentOf(root / "app/README.md");
    const std::regex event(R"re(constexpr Event k\w+\{(\d+), Weight::(\w+),\s*"([^"]+)"\})re");
    std::set<std::string> numbers;
    for (std::sregex_iterator one(header.begin(), header.end(), event), end; one != end; ++one) {
        const std::string number = (*one)[1], weight = (*one)[2], sentence = (*one)[3];
        CAPTURE(number);
        CHECK(numbers.insert(number).second);
        CHECK(table.find("| E-" + number + " | " + weight + " | " + sentence + " |") != std::string::npos);
    }
    const std::regex any("constexpr Event k");
    const auto declared = std::distance(std::sregex_iterator(header.begin(), header.end(), any), {});
    CHECK(numbers.size() == static_cast<std::size_t>(declared));
    CHECK(declared > 20);
}

}  // namespace ilf::app
