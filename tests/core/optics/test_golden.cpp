// The kernel against the reference's exact values: every row of the golden files within its bound, and the special
// cases.
#include <array>
#include <cstdio>
#include <fstream>
#include <optional>

#include "tests/core/optics/golden_file.h"
#include "tests/core/optics/golden_rows.h"
#include "tests/support/law.h"

using namespace ilf;

namespace {

/// A golden file (IF_GOLDEN, by default ../shared/reference/golden beside the repository), or nothing, said aloud.
std::optional<std::vector<GoldenRow>> goldenFile(const char* name) {
    const char* set = std::getenv("IF_GOLDEN");
    const std::filesystem::path folder =
        set != nullptr ? std::filesystem::path(set)
                       : std::filesystem::path(ILF_SOURCE_DIR) / ".." / "shared" / "reference" / "golden";
    std::ifstream file(folder / name);
    if (!file) {
        std::printf("SKIPPED: golden file absent: %s (set IF_GOLDEN to the folder that holds it)\n",
                    (folder / name).c_str());
        std::fflush(stdout);
        return std::nullopt;
    }
    return goldenRows(file);
}

void checkPrecise(const std::vector<GoldenRow>& rows) {
    std::array<double, kOptics> worst{};
    for (const GoldenRow& row : rows) {
        const OpticsValues got = evaluate(row.in, OpticsPath::precise);
        for (std::size_t i = 0; i < kOptics; ++i) {
            const auto optic = static_cast<Optic>(i);
            const double error = row.error(optic, got[optic]);
            worst[i] = std::max(worst[i], error);
            CAPTURE(row.tag);
            CAPTURE(word(optic));
            CAPTURE(row.w);
            CHECK(error <= preciseBound(optic, row.tag));
        }
        CHECK(ulps(blurDiameterPrecise(row.in), row.expected(Optic::Dr)) <= 1.0);
    }
    std::printf("precise, %zu rows, worst ulp:", rows.size());
    for (std::size_t i = 0; i < kOptics; ++i)
        std::printf(" %s %.0f", std::string(word(static_cast<Optic>(i))).c_str(), worst[i]);
    std::printf("\n");
}

/// The fast path's promises, for numbers of `digits` bits: inputs with |e P| <= 0.5.
void checkFast(const std::vector<GoldenRow>& rows, OpticsPath path, int digits) {
    int used = 0;
    const double u = std::ldexp(1.0, -digits);
    double worstBlur = 0.0;
    for (const GoldenRow& row : rows) {
        if (std::abs(row.in.lensToPupil * row.in.power) > 0.5) continue;
        ++used;
        const OpticsValues got = evaluate(row.in, path);
        CAPTURE(row.tag);
        CAPTURE(row.w);
        const double blur = std::abs(got[Optic::Dr] - row.expected(Optic::Dr)) / (u * row.blurScale);
        worstBlur = std::max(worstBlur, blur);
        CHECK(blur <= 8.0);
        CHECK(row.error(Optic::s, got[Optic::s], digits) <= 4.0);
        CHECK(row.error(Optic::sMinus1, got[Optic::sMinus1], digits) <= 5.0);
        CHECK(row.error(Optic::uE, got[Optic::uE], digits) <= 3.0);
        CHECK(row.error(Optic::dEi, got[Optic::dEi], digits) <= 2.0);
        if (row.tag == "refgrid") CHECK(row.error(Optic::pMinFar, got[Optic::pMinFar], digits) <= 3.0);
    }
    CHECK(used > 300);
    std::printf("fast, %d bits, %d rows: worst D_r %.2f u of its scale\n", digits, used, worstBlur);
}

OpticsCase exactCase(double w, double power) {
    OpticsCase in;
    in.setDistance(w);
    in.power = power;
    in.lensToPupil = 0.03125;
    in.retina = 0.015625;
    in.eyePower = 64.0;
    in.pupil = 0.00390625;
    in.confusion = 0x1p-18;
    in.height = 0.0625;
    return in;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("golden: the rows that are always here hold to the bounds") {
    std::istringstream text(kGoldenRows);
    const auto rows = goldenRows(text);
    REQUIRE(rows.size() == 22);
    checkPrecise(rows);
}

TEST_CASE("golden: every row of the binary64 file holds to the bounds, precise and fast") {
    const auto rows = goldenFile("stress_f64.csv");
    if (!rows) return;
    CHECK(rows->size() == 1375);
    checkPrecise(*rows);
    checkFast(*rows, OpticsPath::fast64, 53);
}

TEST_CASE("golden: every row of the binary32 file holds to the bounds, precise and fast") {
    const auto rows = goldenFile("stress_f32.csv");
    if (!rows) return;
    CHECK(rows->size() == 660);
    checkPrecise(*rows);
    checkFast(*rows, OpticsPath::fast32, 24);
}

TEST_CASE("special: with P = 1/w the intermediate image lies at infinity and the scale does not care") {
    const auto got = evaluate(exactCase(0.5, 2.0), OpticsPath::precise);
    CHECK(std::isinf(got[Optic::dEi]));
    CHECK(got[Optic::s] == 1.0625);
    CHECK(got[Optic::Dr] == 0.0);
    CHECK(got[Optic::uE] == doctest::Approx(0.1243549945467614350313548).epsilon(1e-15));
    CHECK(got.status == OpticsStatus::ok);
}

TEST_CASE("special: an object at infinity is a value like others") {
    const auto got = evaluate(exactCase(kInfinity, 1.5), OpticsPath::precise);
    CHECK(got.status == OpticsStatus::atInfinity);
    CHECK(ulps(got[Optic::E], 1.57377049180327868852459) <= 1.0);
    CHECK(ulps(got[Optic::Dr], 0.00009605532786885245901639344) <= 1.0);
    CHECK(ulps(got[Optic::sMinus1], 0.04918032786885245901639344) <= 1.0);
    CHECK(ulps(got[Optic::pMinFar], 0.06237816764132553606237817) <= 1.0);
    CHECK(got[Optic::uE] == 0.0);
}

TEST_CASE("special: an object at the lens, a contact lens, the pole") {
    const auto atLens = evaluate(exactCase(0.0, 5.0), OpticsPath::precise);
    CHECK(atLens.status == OpticsStatus::atLens);
    CHECK(atLens[Optic::N] == 0.03125);
    CHECK(atLens[Optic::Dr] == 0.001953125);
    CHECK(atLens[Optic::s] == 1.0);
    CHECK(std::isinf(atLens[Optic::pMinFar]));

    OpticsCase contact = exactCase(0.5, 3.0);
    contact.lensToPupil = 0.0;
    const auto touching = evaluate(contact, OpticsPath::precise);
    CHECK(touching[Optic::s] == 1.0);
    CHECK(touching[Optic::E] == 1.0);
    CHECK(touching[Optic::pMinFar] == 2.0 + touching[Optic::kFar]);

    OpticsCase pole = exactCase(1.0, 2.0);
    pole.lensToPupil = 1.0;
    const auto there = evaluate(pole, OpticsPath::precise);
    CHECK(there.status == OpticsStatus::pole);
    CHECK(there[Optic::N] == 0.0);
    CHECK(std::isinf(there[Optic::Dr]));
    CHECK(there[Optic::uE] == doctest::Approx(1.570796326794896619231322).epsilon(1e-15));
}

TEST_CASE("status: every case of the analysis has its own word") {
    const auto statusOf = [](const OpticsCase& in) {
        const OpticsStatus precise = evaluate(in, OpticsPath::precise).status;
        CHECK(evaluate(in, OpticsPath::fast64).status == precise);
        CHECK(evaluate(in, OpticsPath::fast32).status == precise);
        return std::string(word(precise));
    };
    CHECK(statusOf(exactCase(0.5, 3.0)) == "ok");
    CHECK(statusOf(exactCase(1.0, 0.0)) == "no-far-border");
    CHECK(statusOf(exactCase(-0.5, 3.0)) == "negative-distance");
    CHECK(statusOf(exactCase(0.5, 32.0)) == "past-the-pole");
    CHECK(statusOf(exactCase(0.0625, 3.0)) == "beyond-the-lens");
    OpticsCase myope = exactCase(1.0, 0.0);
    myope.eyePower = 68.0;
    CHECK(statusOf(myope) == "already-blurred");
    myope.eyePower = 100.0;
    CHECK(statusOf(myope) == "far-point-between");
    OpticsCase none = exactCase(1.0, 1.0);
    none.pupil = 0.0;
    CHECK(statusOf(none) == "zero-pupil");
    none.power = std::numeric_limits<double>::quiet_NaN();
    CHECK(statusOf(none) == "not-a-number");
}

TEST_CASE("no case at all gives a NaN, on any path") {
    constexpr std::array<double, 10> kHard = {0.0, -0.0, 1.0, -1.0, 64.0, 0.015625, 0x1p-1074, 1e18, -1e18, 1e300};
    std::size_t state = 1;
    const auto next = [&] {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return kHard[(state >> 33U) % kHard.size()];
    };
    for (int i = 0; i < 20000; ++i) {
        OpticsCase in{next(), next(), next(), next(), next(), next(), next(), next(), next()};
        for (const auto path : {OpticsPath::precise, OpticsPath::fast64, OpticsPath::fast32}) {
            const auto got = evaluate(in, path);
            for (const double value : got.values)
                REQUIRE_FALSE(std::isnan(value));
        }
    }
}

TEST_CASE("map: the blur of a map of distances is the fast path's, and infinity and NaN count as far") {
    OpticsCase in = exactCase(1.0, 2.5);
    in.eyePower = 63.5;
    std::vector<float> distances = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(),
                                    0.0F};
    for (int i = 1; i < 1000; ++i)
        distances.push_back(0.01F * static_cast<float>(i));
    std::vector<float> blur(distances.size());
    blurDiameters(distances, in, blur);
    CHECK(blur[0] == blur[1]);
    for (std::size_t i = 0; i < distances.size(); ++i) {
        in.setDistance(i == 1 ? kInfinity : static_cast<double>(distances[i]));
        const auto exactly = evaluate(in, OpticsPath::precise);
        const double t = (in.q - in.p * in.power) / (in.p + in.lensToPupil * (in.q - in.p * in.power));
        const double scale = in.pupil * std::max(std::abs(1.0 - in.retina * in.eyePower), std::abs(in.retina * t));
        CHECK(std::abs(static_cast<double>(blur[i]) - exactly[Optic::Dr]) <= 8.0 * 0x1p-24 * scale);
    }
}
