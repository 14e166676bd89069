// `optics eval` and `optics table`: what other programs read of the formulas.
#include "app/headless/optics_command.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "app/exit_code.h"
#include "tests/core/optics/golden_file.h"
#include "tests/core/optics/golden_rows.h"
#include "tests/projects/folder.h"

using namespace ilf;
using namespace ilf::app;

namespace {

std::string contentOf(const std::string& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("optics eval: golden inputs give golden outputs, bit for bit but for the angles") {
    const Folder folder;
    const std::string in = folder.put("in.csv", std::string("# a comment\n") + kGoldenRows);
    const std::string out = (folder.path() / "out.csv").string();
    REQUIRE(opticsEvalCommand({"precise", in, out}) == kDone);
    std::istringstream golden(kGoldenRows), written(contentOf(out));
    std::string header;
    std::getline(written, header);
    CHECK(header.starts_with("tag,w,N,Dr,E,s,s_minus_1,uE,duE,dEi,x2,K_far"));
    CHECK(header.ends_with("Pmin_near,status"));
    for (const GoldenRow& row : goldenRows(golden)) {
        std::string line, cell;
        REQUIRE(std::getline(written, line));
        std::istringstream cells(line);
        std::getline(cells, cell, ',');
        CHECK(cell == row.tag);
        std::getline(cells, cell, ',');
        CHECK(std::strtod(cell.c_str(), nullptr) == row.w);
        for (std::size_t i = 0; i < kOptics; ++i) {
            std::getline(cells, cell, ',');
            const auto optic = static_cast<Optic>(i);
            CHECK(row.error(optic, std::strtod(cell.c_str(), nullptr)) <= preciseBound(optic, row.tag));
        }
    }
}

TEST_CASE("optics eval: infinity, the pole and the fast paths are written, and none of it is NaN") {
    const Folder folder;
    const std::string in = folder.put("in.csv", "w,P,e,r,Pe,De,Da,x1\n"
                                                "inf,1.5,0x1p-5,0x1p-6,64,0x1p-8,0x1p-18,0.0625\n"
                                                "1,2,1,0x1p-6,64,0x1p-8,0x1p-18,0.0625\n");
    const std::string out = (folder.path() / "out.csv").string();
    for (const char* path : {"precise", "fast64", "fast32"}) {
        REQUIRE(opticsEvalCommand({path, in, out}) == kDone);
        const std::string text = contentOf(out);
        CHECK(text.find("at-infinity") != std::string::npos);
        CHECK(text.find(",pole") != std::string::npos);
        CHECK(text.find("nan") == std::string::npos);
    }
}

TEST_CASE("optics eval: a bad file or path is refused and nothing is written") {
    const Folder folder;
    const std::string out = (folder.path() / "out.csv").string();
    const std::string noColumn = folder.put("a.csv", "w,P,e,r,Pe,De,Da\n1,1,1,1,1,1,1\n");
    const std::string noNumber = folder.put("b.csv", "w,P,e,r,Pe,De,Da,x1\n1,two,1,1,1,1,1,1\n");
    CHECK(opticsEvalCommand({"precise", noColumn, out}) == kFailed);
    CHECK(opticsEvalCommand({"precise", noNumber, out}) == kFailed);
    CHECK(opticsEvalCommand({"precise", folder.put("c.csv", ""), out}) == kFailed);
    CHECK(opticsEvalCommand({"precise", (folder.path() / "none.csv").string(), out}) == kFailed);
    CHECK(opticsEvalCommand({"exactly", noNumber, out}) == kFailed);
    CHECK(opticsTableCommand({"far", false, false}) == kFailed);
    CHECK_FALSE(std::filesystem::exists(out));
}
