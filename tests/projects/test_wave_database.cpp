// The wave database: what is saved comes back, and a damaged file is refused in words.
#include <doctest/doctest.h>
#include <sqlite3.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "projects/safe_file.h"
#include "projects/wave_checksum.h"
#include "projects/wave_database.h"
#include "projects/wave_schema.h"
#include "projects/wave_sqlite.h"
#include "tests/projects/folder.h"
#include "tests/projects/some_waves.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::projects;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string hex(std::string_view text) {
    Sha256 sum;
    sum.add(text);
    std::string out;
    for (const std::uint8_t byte : sum.value()) {
        out.push_back("0123456789abcdef"[byte / 16]);
        out.push_back("0123456789abcdef"[byte % 16]);
    }
    return out;
}

/// Runs SQL on the file, as another program would.
void tamper(const std::filesystem::path& file, const std::string& sql) {
    sqlite3* database = nullptr;
    REQUIRE(sqlite3_open(file.c_str(), &database) == SQLITE_OK);
    char* said = nullptr;
    const int status =
        sqlite3_exec(database, ("PRAGMA ignore_check_constraints=ON;" + sql).c_str(), nullptr, nullptr, &said);
    CHECK_MESSAGE(status == SQLITE_OK, sql, ": ", (said != nullptr ? said : ""));
    sqlite3_free(said);
    sqlite3_close(database);
}

/// The same by somebody who knows how checksums are made.
void reseal(const std::filesystem::path& file, const std::string& sql) {
    MemoryDatabase database;
    const bool done = database.execute("ATTACH '" + file.string() + "' AS f; " + sql +
                                       "; UPDATE f.wave SET sha256=(SELECT " + kWaveSeal +
                                       " FROM f.wave w, f.session s, f.device d WHERE w.id=wave.id AND "
                                       "s.id=w.session_id AND d.id=s.etl_id); DETACH f;");
    REQUIRE_MESSAGE(done, database.complaint());
}

/// The refusal's sentence; the file stays as it is.
std::string refusal(const std::filesystem::path& file) {
    const std::string before = contentOf(file);
    const auto opened = openWaves(file);
    CHECK(contentOf(file) == before);
    REQUIRE_MESSAGE(!opened, "was accepted");
    CHECK(opened.error().what.find('"' + file.string() + '"') != std::string::npos);
    CHECK(opened.error().what.back() == '.');
    return opened.error().what;
}

std::size_t filesIn(const Folder& folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path()))
        ++count;
    return count;
}

}  // namespace

TEST_CASE("the checksum is SHA-256 (FIPS 180-4 examples)") {
    CHECK(hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    CHECK(hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    CHECK(hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
          "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    CHECK(hex(std::string(1000000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("wave database: what is saved comes back, powers within half a step, and saving it again changes nothing") {
    const Folder folder;
    const auto file = folder / "lens.ilflens";
    const WaveFile waves = someWaves();
    REQUIRE(saveWaves(file, waves));
    const auto opened = openWaves(file);
    REQUIRE_MESSAGE(opened, opened.error().what);
    CHECK(opened->lens == waves.lens);
    CHECK(opened->recordedUtc == waves.recordedUtc);
    CHECK(opened->method == waves.method);
    CHECK(opened->software == waves.software);
    CHECK(opened->delays == waves.delays);
    REQUIRE(opened->records.size() == waves.records.size());
    for (std::size_t i = 0; i < waves.records.size(); ++i)
        CHECK(difference(waves.records[i], opened->records[i]) == "");
    REQUIRE(opened->shaped.size() == waves.shaped.size());
    for (std::size_t i = 0; i < waves.shaped.size(); ++i)
        CHECK(difference(waves.shaped[i], opened->shaped[i]) == "");
    CHECK(filesIn(folder) == 1);

    const std::string bytes = contentOf(file);
    REQUIRE(saveWaves(file, *openWaves(file)));
    const auto again = openWaves(file);
    for (std::size_t i = 0; i < waves.records.size(); ++i) {
        for (std::size_t k = 0; k < waves.records[i].power_D.size(); ++k)
            CHECK(std::abs(again->records[i].power_D[k] - opened->records[i].power_D[k]) < 1e-12);
    }
    CHECK(contentOf(file).size() == bytes.size());
}

TEST_CASE("wave database: any record comes back within its 16 bits") {
    const Folder folder;
    law("saved then opened is the record", [&] {
        WaveFile waves = someWaves();
        waves.shaped.clear();
        LensRecord record = waves.records[0];
        record.id = *rc::gen::inRange<std::int64_t>(1, std::int64_t{1} << 50);
        record.family = *rc::gen::element<std::string>("sine", "multisine", "it's \"quoted\"");
        record.rate = Hertz::fromSi(0.001 * *rc::gen::inRange(1, 1000000));
        const auto count = static_cast<std::size_t>(*rc::gen::inRange(1, 600));
        const double middle = *rc::gen::inRange(-1000, 1000), step = *rc::gen::element(0.0, 1e-9, 0.01, 1e6);
        record.power_D.clear();
        for (std::size_t i = 0; i < count; ++i)
            record.power_D.push_back(middle + step * *rc::gen::inRange(-1000, 1000));
        waves.records = {record};
        RC_ASSERT(saveWaves(folder / "one", waves).has_value());
        const auto opened = openWaves(folder / "one");
        RC_ASSERT(opened.has_value());
        RC_ASSERT(opened->records.size() == std::size_t{1});
        RC_ASSERT(difference(record, opened->records[0]) == std::string());
    });
}

TEST_CASE("wave database: ids that are 0 get the next free numbers; a wave is found by its id, or its lack is said") {
    const Folder folder;
    WaveFile waves = someWaves();
    for (auto& record : waves.records)
        record.id = 0;
    waves.records[1].id = 40;
    waves.shaped[0].id = 0;
    REQUIRE(saveWaves(folder / "l", waves));
    const auto opened = openWaves(folder / "l");
    REQUIRE(opened);
    CHECK(opened->records[0].id == 40);
    CHECK(opened->records[1].id == 41);
    CHECK(opened->shaped[0].id == 40 + static_cast<std::int64_t>(waves.records.size()));
    CHECK(difference(waves.records[1], *waveOf(*opened, 40)) == "");
    CHECK(waveOf(*opened, opened->shaped[0].id)->family == "shaped");
    const auto missing = waveOf(*opened, 7);
    REQUIRE(!missing);
    CHECK(missing.error().fault == Fault::notFound);
    CHECK(missing.error().what.find("no wave 7") != std::string::npos);
}

TEST_CASE("wave database: what cannot be saved is refused before the file is touched") {
    const Folder folder;
    const auto file = folder / "l";
    REQUIRE(saveWaves(file, someWaves()));
    const std::string before = contentOf(file);
    const auto refused = [&](const char* part, const std::function<void(WaveFile&)>& spoil) {
        WaveFile waves = someWaves();
        spoil(waves);
        const auto saved = saveWaves(file, waves);
        REQUIRE_MESSAGE(!saved, part);
        CHECK_MESSAGE(saved.error().what.find(part) != std::string::npos, saved.error().what);
        CHECK(contentOf(file) == before);
    };
    refused("no waves", [](WaveFile& w) { w.records.clear(), w.shaped.clear(); });
    refused("power that is not finite", [](WaveFile& w) { w.records[0].power_D[3] = std::nan(""); });
    refused("no samples", [](WaveFile& w) { w.records[0].power_D.clear(); });
    refused("no rate", [](WaveFile& w) { w.records[0].rate = Hertz::fromSi(0.0); });
    refused("drive that is not finite", [](WaveFile& w) { w.records[0].drive.c[1] = kInfinity; });
    refused("no drive", [](WaveFile& w) { w.records[0].drive.c.clear(); });
    refused("no temperature", [](WaveFile& w) { w.records[0].temperature_C = std::nan(""); });
    refused("those of another wave", [](WaveFile& w) { w.records[1].id = w.records[0].id; });
    refused("those of another wave", [](WaveFile& w) { w.records.push_back(w.records[0]), w.records.back().id = 0; });
    refused("eye", [](WaveFile& w) { w.lens.eye = "third"; });
    refused("not finite", [](WaveFile& w) { w.shaped[0].errors_D[0] = kInfinity; });
    refused("delay", [](WaveFile& w) { w.delays[0].delay_s = kInfinity; });
}

TEST_CASE(
    "wave database: whichever step of saving fails, the file is the old one or the new one, alone in its folder") {
    WaveFile before = someWaves(), after = someWaves();
    after.records.resize(1);
    after.records[0].temperature_C = 35.0;
    int steps = 0;
    for (int step = 1;; ++step) {
        const Folder folder;
        const auto file = folder / "l";
        REQUIRE(saveWaves(file, before));
        bool reached = false, saved = false;
        {
            const FailAt failing(step, Failing::fullDisk);
            saved = saveWaves(file, after).has_value();
            reached = failing.reached();
        }
        const auto opened = openWaves(file);
        REQUIRE(opened);
        CHECK((opened->records.size() == before.records.size() || opened->records.size() == 1));
        if (saved) CHECK(opened->records[0].temperature_C == 35.0);
        CHECK(filesIn(folder) == 1);
        if (!reached) break;
        steps = step;
    }
    CHECK(steps >= 4);
}

TEST_CASE("wave database: a file that is not one is refused with what it is") {
    const Folder folder;
    CHECK(refusal(folder.put("a", "{ \"json\": 1 }")).find("not a wave database") != std::string::npos);
    CHECK(refusal(folder.put("b", "")).find("is empty") != std::string::npos);
    CHECK(openWaves(folder / "nowhere").error().fault == Fault::notFound);
    tamper(folder / "other", "CREATE TABLE t(x); PRAGMA application_id=7;");
    CHECK(refusal(folder / "other").find("another program") != std::string::npos);
    const auto newer = folder / "newer";
    REQUIRE(saveWaves(newer, someWaves()));
    tamper(newer, "PRAGMA user_version=2");
    CHECK(refusal(newer).find("newer version (format 2, this one reads 1)") != std::string::npos);
    const auto log = folder / "log";
    REQUIRE(saveWaves(log, someWaves()));
    tamper(log, "PRAGMA journal_mode=WAL; UPDATE wave SET temp_C=31");
    CHECK(refusal(log).find("write-ahead log") != std::string::npos);
}

TEST_CASE("wave database: content that cannot be is refused, naming the wave") {
    const Folder folder;
    const auto refused = [&](const std::string& sql, const std::string& part) {
        const auto file = folder / "l";
        REQUIRE(saveWaves(file, someWaves()));
        tamper(file, sql);
        const std::string what = refusal(file);
        CHECK_MESSAGE(what.find(part) != std::string::npos, what);
    };
    refused("UPDATE wave SET scale=9e999 WHERE id=2", "2: its scale or offset is no finite number");
    refused("UPDATE wave SET scale='x' WHERE id=2", "scale");
    refused("UPDATE wave SET offset=-9e999 WHERE id=2", "scale or offset");
    refused("UPDATE wave SET data=substr(data,2) WHERE id=1", "1: it has 499 bytes of samples where 250 samples");
    refused("UPDATE wave SET n=10 WHERE id=1", "500 bytes");
    refused("UPDATE wave SET data=CAST(zeroblob(500) AS BLOB) WHERE id=3", "3: it does not match its checksum");
    refused("UPDATE wave SET sha256=NULL WHERE id=3", "checksum");
    refused("UPDATE wave SET temp_C=31 WHERE id=3", "checksum");
    refused("UPDATE wave SET temp_C=NULL WHERE id=3", "temperature");
    refused("UPDATE wave SET id=77 WHERE id=3", "checksum");
    refused("UPDATE session SET provenance='measured'", "checksum");
    refused("UPDATE device SET model='lively'", "checksum");
    refused("UPDATE wave SET drive_unit='mA' WHERE id=2", "counted in \"mA\"");
    refused("UPDATE wave SET drive_unit='A' WHERE id=2", "volts and amperes");
    refused("UPDATE wave SET freq_Hz=0", "rate");
    refused("UPDATE wave SET u_max=u_min-1", "not in order");
    refused("UPDATE wave SET u_harm=x'0102' WHERE family='multisine'", "");
    refused("UPDATE session SET p_gain=0", "gain");
    refused("UPDATE wave SET session_id=99", "missing");
    refused("DELETE FROM wave", "no waves");
    refused("DELETE FROM wave WHERE family='shaped'", "lacks wave");
    refused("UPDATE model SET params=zeroblob(length(params))", "checksum");
    refused("UPDATE model SET params=x'00'", "checksum");
    refused("DROP TABLE session", "tables");
    refused("INSERT INTO device VALUES(9,'etl','other','s','L',''); INSERT INTO session(id,etl_id,utc,method,noise_D,"
            "provenance) VALUES(9,9,'','',0,'measured'); UPDATE wave SET session_id=9 WHERE id=2",
            "second lens");
}

TEST_CASE("wave database: a well sealed file of another writer is read by its gain, offset and phase, and checked") {
    const Folder folder;
    const auto file = folder / "l";
    REQUIRE(saveWaves(file, someWaves()));
    reseal(file, "UPDATE wave SET p_max=p_max+0.01 WHERE id=2");
    CHECK(refusal(file).find("2: its p_min and p_max are not the extremes") != std::string::npos);
    REQUIRE(saveWaves(file, someWaves()));
    reseal(file, "UPDATE session SET p_gain=2, p_offset_D=0.5");
    const auto opened = openWaves(file);
    REQUIRE_MESSAGE(opened, opened.error().what);
    CHECK(std::abs(opened->records[0].power_D[9] - (0.5 + 2.0 * someWaves().records[0].power_D[9])) < 1e-3);
    REQUIRE(saveWaves(file, someWaves()));
    reseal(file, "UPDATE wave SET phase0_s=0.25/freq_Hz WHERE id=1");
    const Harmonics drive = openWaves(file)->records[0].drive, before = someWaves().records[0].drive;
    CHECK(std::abs(drive.at(0.1) - before.at(0.35)) < 1e-12);  // sample 0 comes a quarter after the drive's zero phase
}

TEST_CASE("wave database: cut anywhere, it is refused") {
    const Folder folder;
    const auto file = folder / "l";
    REQUIRE(saveWaves(file, someWaves()));
    const std::string whole = contentOf(file);
    for (std::size_t length = 0; length < whole.size(); length += length < 200 ? 1 : 97)
        refusal(folder.put("cut", std::string_view(whole).substr(0, length)));
    for (std::size_t gone = 1; gone < 200; ++gone)
        refusal(folder.put("cut", std::string_view(whole).substr(0, whole.size() - gone)));
}

TEST_CASE("wave database: whatever byte is flipped, the file is refused or its content is what was saved") {
    const Folder folder;
    const auto file = folder / "l";
    REQUIRE(saveWaves(file, someWaves()));
    const std::string whole = contentOf(file);
    const WaveFile saved = *openWaves(file);
    std::mt19937_64 random(1);
    int refusals = 0, accepted = 0;
    const auto check = [&](const std::string& bytes) {
        const auto opened = openWaves(folder.put("flipped", bytes));
        opened ? ++accepted : ++refusals;
        if (!opened) return true;
        bool same = opened->lens == saved.lens && opened->records == saved.records && opened->delays.size() <= 1 &&
                    opened->shaped.size() == saved.shaped.size();
        for (std::size_t i = 0; same && i < saved.shaped.size(); ++i)
            same = difference(saved.shaped[i], opened->shaped[i]).empty();
        return same;
    };
    for (int i = 0; i < 6000; ++i) {
        std::string bytes = whole;
        const std::size_t flips = i % 3 == 0 ? 1 + random() % 8 : 1;
        for (std::size_t k = 0; k < flips; ++k)
            bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
        CHECK_MESSAGE(check(bytes), "flip ", i);
    }
    CHECK(refusals > 1000);
    CHECK(accepted > 0);  // bytes that nothing uses
}
