// Delay and pace of a projector's light, from recordings that real photodiodes made and from ones made here.
#include "devices/measure/edge_delay.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "tests/support/test_data.h"

using namespace ilf;
using namespace ilf::devices;

namespace {

struct ExpectedEdge {
    double time_s = 0.0, step_s = 0.0;
    bool rising = false, delayed = false;
};

/// What another program (videojitter) and its author read off the same recording.
std::vector<ExpectedEdge> expectedIn(const std::filesystem::path& report) {
    std::ifstream in(report);
    std::string line;
    std::getline(in, line);
    std::vector<ExpectedEdge> edges;
    while (std::getline(in, line)) {
        std::istringstream cells(line);
        std::string time, rising, step, valid, delayed;
        std::getline(cells, time, ',');
        std::getline(cells, rising, ',');
        std::getline(cells, step, ',');
        std::getline(cells, valid, ',');
        std::getline(cells, delayed, ',');
        REQUIRE(valid == "True");
        edges.push_back({std::stod(time), step.empty() ? 0.0 : std::stod(step), rising == "True", delayed == "True"});
    }
    return edges;
}

}  // namespace

TEST_CASE("edges of real recordings are those that were shown, none more and none less") {
    struct Case {
        const char* name;
        double frames_Hz;
        bool clean;  ///< the other one's light is four steps above its noise, and frames themselves come unevenly
    };
    for (const auto& [name, frames_Hz, clean] :
         {Case{"asuswmp_60p_at_240hz", 60.0, true}, Case{"evr_23p_at_60hz", 24000.0 / 1001.0, true},
          Case{"lg_119p_inst_osram_bpw34_u3f", 120000.0 / 1001.0, false}, Case{"lg_59p", 60000.0 / 1001.0, true}}) {
        CAPTURE(std::string(name));
        const auto sound = testData(std::string("07_signals/videojitter/") + name + "/recording.flac");
        if (!sound) return;
        const auto expected = expectedIn(sound->parent_path() / "test_output" / "report.csv");
        const auto recording = readRecording(*sound);
        REQUIRE(recording);
        const auto pace = paceIn(*recording);
        REQUIRE_MESSAGE(pace, pace.error().what);
        CHECK(pace->interval.si() == doctest::Approx(1.0 / frames_Hz).epsilon(2e-3));
        std::size_t at = 0;
        while (at < pace->edges.size() && pace->edges[at].time_s < expected.front().time_s - 0.25 / frames_Hz)
            ++at;
        CHECK(pace->extra == 0);
        CHECK(pace->confidence != Confidence::poor);
        // The one picture that was shown twice on purpose, and no other.
        REQUIRE(pace->held.size() == 1);
        REQUIRE(at + expected.size() <= pace->edges.size());
        CHECK(expected[pace->held.front() - at].delayed);
        // Where in its transition an edge is said to be differs between programs, by as much for all of a kind.
        std::vector<double> apart[2];
        int wrongKind = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const LightEdge& edge = pace->edges[at + i];
            wrongKind += edge.rising != expected[i].rising ? 1 : 0;
            apart[edge.rising ? 1 : 0].push_back(edge.time_s - expected[i].time_s);
        }
        CHECK(wrongKind == 0);
        for (const auto& kind : apart) {
            const Spread spread = spreadOf(kind);
            CHECK(std::abs(spread.median.si()) < 3e-3);
            CHECK(spread.deviation < (clean ? 0.12_ms : 0.5_ms));
            CHECK(spread.low > spread.median - (clean ? 0.1_ms : 0.5_ms));
        }
    }
}

namespace {

/// A projector that shows frames in turn white and black, `delay_s` after triggers of `interval_s`, and a photodiode
/// with a time constant, mains hum, drift and noise; `frames` holds what each frame shows.
struct Shown {
    double rate = 24000.0, interval_s = 1.0 / 60.0, delay_s = 0.00046, jitter_s = 0.0, slow_s = 30e-6;
    double noise_V = 0.02, drift_V = 0.5, lastsOf = 1.0;  ///< lastsOf: share of a frame that it is lit
    std::vector<bool> frames;

    Recording recorded(std::uint32_t seed = 1) const {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        std::vector<double> begins;
        for (std::size_t k = 0; k < frames.size(); ++k)
            begins.push_back(0.02 + interval_s * static_cast<double>(k) + delay_s + jitter_s * normal(random));
        Recording recording{rate, {}, {}};
        const auto samples = static_cast<std::size_t>((0.04 + interval_s * static_cast<double>(frames.size())) * rate);
        double seen = 0.0;
        std::size_t frame = 0;
        constexpr int kFine = 8;
        for (std::size_t i = 0; i < samples; ++i) {
            const double now = static_cast<double>(i) / rate;
            const double since = std::fmod(now - 0.02, interval_s);
            recording.trigger.push_back((now >= 0.02 && since < 0.0005 ? 3.3 : 0.0) + 0.02 * normal(random));
            for (int f = 0; f < kFine; ++f) {
                const double fine = now + (f - kFine) / (rate * kFine);
                while (frame < frames.size() && fine >= begins[frame])
                    ++frame;
                const bool lit = frame > 0 && frames[frame - 1] && fine - begins[frame - 1] < lastsOf * interval_s;
                seen += ((lit ? 1.0 : 0.0) - seen) * (1.0 - std::exp(-1.0 / (rate * kFine * slow_s)));
            }
            recording.light.push_back(seen + noise_V * normal(random) + drift_V * std::sin(1.3 * now) +
                                      0.02 * std::sin(2.0 * 3.14159265 * 100.0 * now));
        }
        return recording;
    }
};

std::vector<bool> inTurn(std::size_t frames) {
    std::vector<bool> shown(frames);
    for (std::size_t k = 0; k < frames; ++k)
        shown[k] = k % 2 == 0;
    return shown;
}

}  // namespace

TEST_CASE("a known delay is measured through noise, hum and drift") {
    Shown shown;
    shown.frames = inTurn(240);
    const auto delays = delaysIn(shown.recorded());
    REQUIRE_MESSAGE(delays, delays.error().what);
    CHECK(std::abs((delays->delay.median - 0.46_ms).si()) < 60e-6);
    CHECK(delays->delay.deviation < 0.05_ms);
    CHECK(delays->missing == 0);
    CHECK(delays->extra == 0);
    CHECK(delays->confidence == Confidence::good);
    REQUIRE(delays->fallingLater);
    CHECK(std::abs(delays->fallingLater->si()) < 50e-6);
}

TEST_CASE("bare edges that drift along the samples give a delay far finer than a sample, without bias") {
    constexpr double kRate = 24000.0, kInterval_s = (1.0 + 40e-6) / 60.0;
    double sum_s = 0.0;
    int measured = 0;
    for (const double first_s : {0.0, 9e-6, 21e-6, 33e-6}) {
        for (const double delay_s : {0.46e-3, 0.47e-3, 0.4805e-3, 0.9e-3}) {
            CAPTURE(first_s);
            CAPTURE(delay_s);
            Recording recording{kRate, {}, {}};
            for (int i = 0; i < 48000; ++i) {
                const double since = std::fmod(i / kRate + kInterval_s - first_s, kInterval_s);
                recording.trigger.push_back(since < 0.0005 ? 3.3 : 0.0);
                recording.light.push_back(since >= delay_s && since < delay_s + 2e-3 ? 1.0 : 0.0);
            }
            const auto delays = delaysIn(recording, 0.6_ms);
            REQUIRE_MESSAGE(delays, delays.error().what);
            const double off_s = delays->mean.si() - delay_s;
            CHECK(std::abs(off_s) < 8e-6);  // a sample takes 42 us
            sum_s += off_s;
            ++measured;
        }
    }
    CHECK(std::abs(sum_s / measured) < 3e-6);
}

TEST_CASE("a photodiode that looks away now and then does not move the mean delay") {
    Shown shown;
    shown.frames = inTurn(240);
    shown.slow_s = 10e-6;
    shown.noise_V = 0.002;
    auto recording = shown.recorded();
    const auto before = delaysIn(recording);
    REQUIRE(before);
    // One edge of light comes 3 ms late.
    const auto from = static_cast<std::size_t>((0.02 + 100.0 / 60.0 + 0.0004) * shown.rate);
    std::fill_n(recording.light.begin() + static_cast<std::ptrdiff_t>(from), 72, recording.light[from - 4]);
    const auto after = delaysIn(recording);
    REQUIRE_MESSAGE(after, after.error().what);
    CHECK(std::abs((after->mean - before->mean).si()) < 2e-6);
}

TEST_CASE("jitter of a projector is told, and a slow photodiode moves the delay by as much as is said") {
    for (const double slow_s : {10e-6, 0.5e-3, 3e-3}) {
        CAPTURE(slow_s);
        Shown shown;
        shown.frames = inTurn(240);
        shown.slow_s = slow_s;
        shown.noise_V = 0.002;
        shown.jitter_s = 0.2e-3;
        const auto delays = delaysIn(shown.recorded());
        REQUIRE_MESSAGE(delays, delays.error().what);
        CHECK(delays->delay.median > 0.36_ms);
        CHECK(delays->delay.median < 0.46_ms + 0.4 * 3.0_ms);
        CHECK(delays->delay.deviation.si() == doctest::Approx(0.2e-3).epsilon(0.25));
    }
}

TEST_CASE("frames shown twice leave their trigger without light; flashes count by their rise") {
    Shown shown;
    shown.frames = inTurn(200);
    shown.frames[60] = shown.frames[59];
    shown.frames[130] = shown.frames[129];
    for (std::size_t k = 61; k < 200; ++k)
        shown.frames[k] = !shown.frames[k - 1];
    shown.frames[130] = shown.frames[129];
    for (std::size_t k = 131; k < 200; ++k)
        shown.frames[k] = !shown.frames[k - 1];
    const auto twice = delaysIn(shown.recorded());
    REQUIRE_MESSAGE(twice, twice.error().what);
    CHECK(twice->missing == 2);
    CHECK(twice->extra == 0);
    CHECK(paceIn(shown.recorded()).value().held.size() == 2);

    shown.frames.assign(200, true);
    shown.frames[77] = false;
    shown.lastsOf = 0.3;
    shown.delay_s = 0.0151;  // nearly a whole interval
    const auto flashes = delaysIn(shown.recorded());
    REQUIRE_MESSAGE(flashes, flashes.error().what);
    CHECK_FALSE(flashes->fallingLater);
    CHECK(flashes->missing == 1);
    CHECK(std::abs(flashes->delay.median.si() - 0.0151) < 60e-6);
}

TEST_CASE("recordings that tell no delay are refused in words") {
    Shown shown;
    shown.frames = inTurn(120);
    const auto why = [](const Recording& recording) {
        const auto delays = delaysIn(recording);
        return delays ? std::string("measured") : delays.error().what;
    };
    Recording still = shown.recorded();
    std::fill(still.light.begin(), still.light.end(), 0.25);
    CHECK(why(still).find("never changes") != std::string::npos);

    Shown faint = shown;
    faint.noise_V = 3.0;
    CHECK(why(faint.recorded()).find("noise") != std::string::npos);

    Recording untriggered = shown.recorded();
    untriggered.trigger.clear();
    CHECK(why(untriggered).find("no trigger") != std::string::npos);
    untriggered = shown.recorded();
    std::fill(untriggered.trigger.begin(), untriggered.trigger.end(), 0.0);
    CHECK(why(untriggered).find("trigger's wire") != std::string::npos);

    Shown other = shown;
    other.interval_s = 1.0 / 71.3;
    Recording strange = shown.recorded();
    strange.light = other.recorded().light;
    strange.light.resize(strange.trigger.size(), 0.0);
    CHECK(why(strange).find("in step with no trigger") != std::string::npos);
}

TEST_CASE("a scope's table is read as it is; tables that are none are refused with their line") {
    if (const auto scope = testData("07_signals/sigrok/misc/square_wave_2ch/scope_3.csv")) {
        const auto recording = readRecording(*scope);
        REQUIRE_MESSAGE(recording, recording.error().what);
        CHECK(recording->samplesPerSecond == doctest::Approx(500e3));
        CHECK(recording->light.size() == 999);
        CHECK(recording->trigger.size() == 999);
        const auto found = edgesOf(recording->light, recording->samplesPerSecond, 0.1_ms);
        REQUIRE_MESSAGE(found, found.error().what);
        REQUIRE(found->edges.size() >= 4);  // 1.2 kHz over 2 ms
        CHECK(found->edges[2].time_s - found->edges[0].time_s == doctest::Approx(1.0 / 1200.0).epsilon(0.03));
    }
    const std::string path = "measure-recording-test.csv";
    const auto refusal = [&](const std::string& text) {
        std::ofstream(path) << text;
        const auto recording = readRecording(path);
        return recording ? std::string("read") : recording.error().what;
    };
    std::string good = "time,trigger,light\n";
    for (int i = 0; i < 100; ++i)
        good += std::to_string(i * 0.001) + ",0," + std::to_string(i % 7) + "\n";
    CHECK(refusal(good) == "read");
    CHECK(refusal(good + "0.1,0\n").find("line 102") != std::string::npos);
    CHECK(refusal(good + "0.1,0,x\n").find("line 102") != std::string::npos);
    CHECK(refusal(good + "0.9,0,1\n").find("equally spaced") != std::string::npos);
    CHECK(refusal("1\n2\n").find("two or three numbers") != std::string::npos);
    CHECK(refusal("0,1\n1,2\n").find("only 2 samples") != std::string::npos);
    CHECK(refusal("").find("no samples") != std::string::npos);
    std::remove(path.c_str());
    CHECK(readRecording(path).error().what.find("is no file") != std::string::npos);
}
