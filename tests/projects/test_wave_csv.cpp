// Waves as CSV: export writes what import reads, and what is wrong is named with file and line.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <sstream>

#include "projects/safe_file.h"
#include "projects/wave_csv.h"
#include "projects/wave_period.h"
#include "tests/projects/folder.h"
#include "tests/projects/some_waves.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::projects;

namespace {

/// A wave's file as somebody else's program would write it; each part can be spoilt.
struct Csv {
    std::string header = "# recorded on the bench\n# schema=1\n# etl_serial=A7\n# freq_Hz=60\n# u_unit=V\n"
                         "# u_min=-0.01\n# u_max=0.03\n# temp_C=29.5\n# periods_avg=8\n# provenance=measured\n";
    std::string columns = "t_s,u,P_D\n";
    std::vector<double> t, u, p;

    explicit Csv(std::size_t n = 250) {
        for (std::size_t i = 0; i < n; ++i) {
            t.push_back(static_cast<double>(i) / (60.0 * static_cast<double>(n)));
            u.push_back(0.01 + 0.02 * std::sin(2.0 * std::numbers::pi * 60.0 * t[i]));
            p.push_back(powerAt(60.0 * t[i]));
        }
    }
    static double powerAt(double x) {
        return 1.1 + 1.2 * std::cos(2.0 * std::numbers::pi * (x - 0.3)) + 0.05 * std::sin(6.0 * std::numbers::pi * x);
    }
    std::string text() const {
        std::ostringstream out;
        out.precision(12);
        out << header << columns;
        for (std::size_t i = 0; i < t.size(); ++i)
            out << t[i] << "," << u[i] << "," << p[i] << "\n";
        return out.str();
    }
};

std::string without(std::string text, const std::string& part) {
    const auto at = text.find(part);
    REQUIRE(at != std::string::npos);
    return text.erase(at, part.size());
}
std::string with(std::string text, const std::string& part, const std::string& other) {
    const auto at = text.find(part);
    REQUIRE(at != std::string::npos);
    return text.replace(at, part.size(), other);
}

std::string refusal(const std::string& csv) {
    const Folder folder;
    folder.put("one.csv", csv);
    const auto read = importWaves(folder.path());
    REQUIRE_MESSAGE(!read, "was accepted");
    CHECK(read.error().fault == Fault::badFile);
    CHECK(read.error().what.find("one.csv\"") != std::string::npos);
    CHECK(read.error().what.back() == '.');
    return read.error().what;
}
void refused(const std::string& csv, const std::string& part) {
    const std::string what = refusal(csv);
    CHECK_MESSAGE(what.find(part) != std::string::npos, what);
}

}  // namespace

TEST_CASE("CSV import: another program's wave is read, its noise estimated, nothing about it made up") {
    const Folder folder;
    Csv csv;
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 0.01);
    for (double& p : csv.p)
        p += noise(random);
    folder.put("one.csv", with(csv.text(), "\n", "\r\n"));
    const auto read = importWaves(folder.path());
    REQUIRE_MESSAGE(read, read.error().what);
    REQUIRE(read->records.size() == 1);
    const LensRecord& record = read->records[0];
    CHECK(record.family == "sine");
    CHECK(record.rate == 60.0_Hz);
    CHECK(record.temperature_C == 29.5);
    CHECK(record.periodsAveraged == 8);
    CHECK(record.provenance == Provenance::measured);
    CHECK(record.unit == DriveUnit::volt);
    CHECK(std::abs(record.noise_D - 0.01) < 0.002);
    CHECK(std::abs(record.drive.at(0.25) - 0.03) < 1e-12);
    CHECK(record.power_D.size() == 250);
    CHECK(read->lens.serial == "A7");
    CHECK(!read->lens.emulated);
    CHECK(read->method == "csv");
    REQUIRE(saveWaves(folder / "l.ilflens", *read));
    CHECK(openWaves(folder / "l.ilflens")->records[0].provenance == Provenance::measured);
}

TEST_CASE("CSV import: what is wrong is named with file and line") {
    const Csv good;
    const std::string text = good.text();
    Csv bad = good;
    bad.p[100] = std::nan("");
    refused(bad.text(), "line 112: P_D is no finite number: \"nan\"");
    bad = good;
    bad.u[0] = HUGE_VAL;
    refused(bad.text(), "line 12: u is no finite number: \"inf\"");
    bad = good;
    bad.t[5] = bad.t[4];
    refused(bad.text(), "line 17: time does not increase");
    bad = good;
    std::swap(bad.t[7], bad.t[8]);
    refused(bad.text(), "line 20: time does not increase");
    refused(with(text, "freq_Hz=60", "freq_Hz=60.2"), "line 261: the period is 16.6667 ms; at 60.2 Hz");
    bad = good;
    for (std::size_t i = 0; i < bad.p.size(); ++i)
        bad.p[i] += 0.2 * static_cast<double>(i) / 250.0;
    refused(bad.text(), "line 261: the power jumps by 0.200 D");
    for (const char* key :
         {"schema", "etl_serial", "freq_Hz", "u_unit", "u_min", "u_max", "temp_C", "periods_avg", "provenance"}) {
        const auto at = text.find(std::string("# ") + key);
        refused(without(text, text.substr(at, text.find('\n', at) - at + 1)),
                "lacks the line \"# " + std::string(key) + "=");
    }
    refused(with(text, "u_unit=V", "u_unit=mV"), "line 5: u_unit must be V or A, not \"mV\"");
    refused(with(text, "schema=1", "schema=2"), "line 2: schema is 2");
    refused(with(text, "temp_C=29.5", "temp_C=warm"), "line 8: temp_C is no finite number: \"warm\"");
    refused(with(text, "provenance=measured", "provenance=real"), "line 10: provenance must be");
    refused(with(text, "freq_Hz=60", "freq_Hz=-60"), "freq_Hz must be above 0");
    refused(with(text, "u_max=0.03", "u_max=-0.03"), "u_max is less than u_min");
    refused(with(text, "u_max=0.03", "u_max=0.05"), "another drive than the column u");
    refused(with(text, "t_s,u,P_D", "t,u,P"), "line 11: the columns must be t_s,u,P_D");
    refused(with(text, "# temp_C", "# u_unit=A\n# temp_C"), "line 8: \"u_unit\" is given a second time");
    refused(good.header, "has no samples");
    refused(Csv(63).text(), "has 63 samples; a period needs at least 64");
    refused(text + "0.1,2\n", "line 262: a sample has three values");
    refused(text + "0.1,2,x\n", "line 262: P_D is no finite number: \"x\"");
}

TEST_CASE("CSV import: 0.1 % of the period is the limit, equally spaced or not") {
    const std::string text = Csv().text();
    const Folder folder;
    folder.put("one.csv", with(text, "freq_Hz=60", "freq_Hz=60.05"));
    CHECK(importWaves(folder.path()));
    folder.put("one.csv", with(text, "freq_Hz=60", "freq_Hz=60.07"));
    CHECK(!importWaves(folder.path()));
    Csv uneven;
    for (std::size_t i = 0; i < uneven.t.size(); ++i)
        uneven.t[i] += i % 2 == 0 ? 0.0 : 1e-5;
    CHECK(!notAPeriod(uneven.t, 60.0));
    CHECK(notAPeriod(uneven.t, 61.5)->why.find("period") != std::string::npos);
    CHECK(notAPeriod(uneven.t, 58.5)->why.find("period") != std::string::npos);
}

TEST_CASE("CSV import: unequal times are brought to 250 equally spaced samples") {
    law("resampled is the wave itself", [] {
        const auto n = static_cast<std::size_t>(*rc::gen::inRange(120, 600));
        const double late = 0.001 * *rc::gen::inRange(0, 900) / static_cast<double>(n);
        std::vector<double> t, p;
        for (std::size_t i = 0; i < n; ++i) {
            const double x =
                late + (static_cast<double>(i) + 0.0004 * *rc::gen::inRange(-1000, 1000)) / static_cast<double>(n);
            t.push_back(x / 60.0);
            p.push_back(Csv::powerAt(x));
        }
        const auto even = resampled(t, p, 60.0);
        RC_ASSERT(even.size() == kTableSamples);
        for (std::size_t k = 0; k < even.size(); ++k)
            RC_ASSERT(std::abs(even[k] - Csv::powerAt(static_cast<double>(k) / 250.0)) < 1e-3);
    });
    Csv csv(300);
    for (std::size_t i = 0; i < csv.t.size(); ++i) {
        const double x = (static_cast<double>(i) + 0.3 * std::sin(static_cast<double>(i))) / 300.0;
        csv.t[i] = x / 60.0;
        csv.u[i] = 0.01 + 0.02 * std::sin(2.0 * std::numbers::pi * x);
        csv.p[i] = Csv::powerAt(x);
    }
    const Folder folder;
    folder.put("one.csv", csv.text());
    const auto read = importWaves(folder.path());
    REQUIRE_MESSAGE(read, read.error().what);
    REQUIRE(read->records[0].power_D.size() == 250);
    for (std::size_t k = 0; k < 250; ++k)
        CHECK(std::abs(read->records[0].power_D[k] - Csv::powerAt(static_cast<double>(k) / 250.0)) < 1e-3);
}

TEST_CASE("CSV import: noise alone is no jump at the seam, and ten times as much is one") {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 0.02);
    int refusals = 0, found = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<double> p;
        for (int k = 0; k < 250; ++k)
            p.push_back(Csv::powerAt(k / 250.0) + noise(random));
        CHECK(std::abs(noiseOf(p) - 0.02) < 0.007);
        refusals += jumpAtSeam(p, 0.02) ? 1 : 0;
        for (int k = 0; k < 250; ++k)
            p[static_cast<std::size_t>(k)] += 0.2 * k / 250.0;
        found += jumpAtSeam(p, 0.02) ? 1 : 0;
    }
    CHECK(refusals <= 1);
    CHECK(found >= 1990);
}

TEST_CASE("CSV import: the manifest says which files, in which order, and what they leave out") {
    const Folder folder;
    const std::string text = Csv().text();
    folder.put("b.csv", without(text, "# temp_C=29.5\n"));
    folder.put("a.csv", text);
    folder.put("unused.csv", "nothing of use");
    folder.put("manifest.csv", "file,temp_C\nb.csv,33\na.csv,\n");
    const auto read = importWaves(folder.path());
    REQUIRE_MESSAGE(read, read.error().what);
    REQUIRE(read->records.size() == 2);
    CHECK(read->records[0].temperature_C == 33.0);
    CHECK(read->records[1].temperature_C == 29.5);
    CHECK(read->records[1].id == 2);
    const auto refusedWith = [&](const std::string& manifest, const std::string& part) {
        folder.put("manifest.csv", manifest);
        const auto no = importWaves(folder.path());
        REQUIRE(!no);
        CHECK_MESSAGE(no.error().what.find(part) != std::string::npos, no.error().what);
    };
    refusedWith("name\na.csv\n", "line 1: there must be a column \"file\"");
    refusedWith("file,id\na.csv\n", "line 2: 1 values for 2 columns");
    refusedWith("file\n../a.csv\n", "no file beside the manifest");
    refusedWith("file\nnot-there.csv\n", "does not exist");
    refusedWith("file,id\na.csv,4\nb.csv,4\n", "lacks the line \"# temp_C");
    refusedWith("file,id,temp_C\na.csv,4,\nb.csv,4,30\n", "id 4 is that of a file before");
    refusedWith("file,temp_C\n", "no CSV files");
    folder.put("other.csv", with(text, "etl_serial=A7", "etl_serial=A8"));
    refusedWith("file\na.csv\nother.csv\n", "another lens");
    CHECK(importWaves(folder / "nowhere").error().fault == Fault::notFound);
}

TEST_CASE("CSV export writes what import reads: every field, powers within what a file of 16 bits loses") {
    const Folder folder;
    REQUIRE(saveWaves(folder / "l", someWaves()));
    const WaveFile waves = *openWaves(folder / "l");
    REQUIRE(exportWaves(folder / "csv", waves));
    const auto read = importWaves(folder / "csv");
    REQUIRE_MESSAGE(read, read.error().what);
    CHECK(read->lens == waves.lens);
    CHECK(read->recordedUtc == waves.recordedUtc);
    CHECK(read->method == waves.method);
    REQUIRE(read->records.size() == waves.records.size());
    for (std::size_t i = 0; i < waves.records.size(); ++i)
        CHECK(difference(waves.records[i], read->records[i]) == "");
    REQUIRE(read->shaped.size() == 1);
    CHECK(difference(waves.shaped[0], read->shaped[0]) == "");

    const auto again = exportWaves(folder / "csv", waves);
    REQUIRE(!again);
    CHECK(again.error().what.find("not empty") != std::string::npos);
}

TEST_CASE("CSV: any database goes through export, import and a database unchanged") {
    law("export then import is the record", [] {
        WaveFile waves = someWaves();
        waves.shaped.clear();
        waves.delays.clear();
        waves.lens.emulated = *rc::gen::arbitrary<bool>();
        waves.records.resize(1);
        LensRecord& record = waves.records[0];
        record.family = *rc::gen::element<std::string>("sine", "multisine");
        record.rate = Hertz::fromSi(0.01 * *rc::gen::inRange(100, 50000));
        record.temperature_C = 0.01 * *rc::gen::inRange(-1000, 9000);
        record.provenance = *rc::gen::element(Provenance::measured, Provenance::simulated, Provenance::imported);
        const double a = 1e-4 * *rc::gen::inRange(1, 2000);
        record.drive.c = {1e-4 * *rc::gen::inRange(-1000, 1000), {0.0, -a}};
        if (record.family == "multisine") record.drive.c.push_back({a / 3.0, 0.1 * a});
        Harmonics power;
        for (int k = 0; k <= 5; ++k)
            power.c.emplace_back(0.01 * *rc::gen::inRange(-200, 200),
                                 k == 0 ? 0.0 : 0.01 * *rc::gen::inRange(-200, 200));
        record.power_D = samplesOf(power, static_cast<std::size_t>(*rc::gen::inRange(64, 400)));
        const Folder folder;
        RC_ASSERT(exportWaves(folder / "csv", waves).has_value());
        const auto read = importWaves(folder / "csv");
        if (!read) RC_FAIL(read.error().what);
        RC_ASSERT(difference(record, read->records[0]) == std::string());
        RC_ASSERT(read->lens == waves.lens);
    });
}

TEST_CASE("CSV export: whichever step fails, no half folder is left") {
    int steps = 0;
    for (int step = 1;; ++step) {
        const Folder folder;
        bool reached = false, saved = false;
        {
            const FailAt failing(step, Failing::fullDisk);
            saved = exportWaves(folder / "csv", someWaves()).has_value();
            reached = failing.reached();
        }
        if (std::filesystem::exists(folder / "csv")) CHECK(importWaves(folder / "csv")->records.size() == 4);
        if (saved) CHECK(std::filesystem::exists(folder / "csv"));
        if (!reached) break;
        steps = step;
    }
    CHECK(steps > 10);
}
