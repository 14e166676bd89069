// What a brush dab costs on its way to the light: bytes and time of an update against the whole program, and the time
// from the finished program to the swap on the virtual clock.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <random>
#include <vector>

#include "devices/link/codec.h"
#include "devices/link/program_update.h"
#include "devices/simulated/virtual_stage.h"

namespace {

using namespace ilf;
using namespace ilf::devices;

constexpr Size kProjector{1024, 768};

/// A program whose tiles are all different, so that nothing is saved by uniform tiles.
Program busyProgram() {
    Program p;
    p.waveform = idealSine(0.0_D, 0.0_D, 2.27_D, 60.0_Hz, 0.0_s);
    p.projectorDelay = 0.46_ms;
    p.projector = kProjector;
    p.imageOfSlot = {0, 0, -1, -1, -1, -1, -1, 1, 1, 1, -1, -1, -1, -1, -1, 0};
    std::mt19937 random(1);
    for (int i = 0; i < 2; ++i) {
        LightImage image(kProjector);
        for (int row = 0; row < image.rows(); ++row) {
            for (int column = 0; column < image.columns(); ++column) {
                Tile tile;
                for (auto& v : tile.v)
                    v = static_cast<std::uint8_t>(random());
                image.setTile(column, row, boxed(tile));
            }
        }
        p.images.push_back(image);
    }
    return p;
}

/// Both images lit through a disc of radius 40 px around (x, y): the tiles a dab reaches, 4 to 9 of each.
Program dabbed(const Program& before, int x, int y, std::uint8_t value) {
    constexpr int kRadius = 40;
    Program p = before;
    for (auto& image : p.images) {
        for (int row = (y - kRadius) / kTile; row <= (y + kRadius) / kTile; ++row) {
            for (int column = (x - kRadius) / kTile; column <= (x + kRadius) / kTile; ++column) {
                Tile tile = *image.tile(column, row);
                for (int ty = 0; ty < kTile; ++ty) {
                    for (int tx = 0; tx < kTile; ++tx) {
                        const int dx = column * kTile + tx - x, dy = row * kTile + ty - y;
                        if (dx * dx + dy * dy <= kRadius * kRadius) tile.at(tx, ty) = value;
                    }
                }
                image.setTile(column, row, boxed(tile));
            }
        }
    }
    return p;
}

/// p50 and p95 of one run's times, microseconds.
void report(benchmark::State& state, std::vector<double> times_us) {
    std::sort(times_us.begin(), times_us.end());
    const auto at = [&](double share) {
        return times_us[static_cast<std::size_t>(share * double(times_us.size() - 1))];
    };
    state.counters["p50_us"] = at(0.50);
    state.counters["p95_us"] = at(0.95);
}

double since_us(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

/// Processor time of this thread: what other programs do on the machine is not on the virtual clock.
std::int64_t worked_ns() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

/// Hash, difference, encode; decode, assemble, verify: all but the socket.
void travel(benchmark::State& state, bool difference_) {
    const Program base = busyProgram();
    const std::uint64_t baseHash = contentHash(base);
    std::vector<double> times;
    std::size_t bytes = 0, tiles = 0;
    std::uint8_t value = 0;
    for (auto _ : state) {
        const Program next = dabbed(base, 500, 380, ++value);
        const auto start = std::chrono::steady_clock::now();
        const auto hash = contentHash(next);
        const auto update = difference_ ? difference(next, hash, &base, baseHash) : difference(next, hash);
        const auto wire = encoded({1, update});
        const auto message = decoded(wire);
        const auto arrived = assembled(std::get<ProgramUpdate>(message->body), &base, baseHash);
        benchmark::DoNotOptimize(arrived);
        const double time = since_us(start);
        state.SetIterationTime(time * 1e-6);
        times.push_back(time);
        bytes = wire.size();
        tiles = update.tiles.size();
        if (!arrived) state.SkipWithError("the program did not arrive");
    }
    state.counters["bytes"] = static_cast<double>(bytes);
    state.counters["tiles"] = static_cast<double>(tiles);
    report(state, std::move(times));
}

void dabTravels(benchmark::State& state) { travel(state, true); }
void wholeProgramTravels(benchmark::State& state) { travel(state, false); }

/// From the finished program to the swap: the link's and the stage's work as it takes here (processor time), added to
/// the virtual clock's wait for the sweep. Compiling is not in it.
void strokeToSwap(benchmark::State& state) {
    VirtualStage stage;
    Program base = busyProgram();
    if (!stage.load(base) || !stage.swap()) state.SkipWithError("the stage does not play");
    std::uint64_t baseHash = contentHash(base);
    std::mt19937 random(2);
    std::vector<double> times;
    double worst_ms = 0.0;
    for (auto _ : state) {
        Program next = dabbed(base, 100 + static_cast<int>(random() % 800U), 100 + static_cast<int>(random() % 500U),
                              static_cast<std::uint8_t>(random()));
        // A stroke ends at any phase of the sweep.
        stage.port.waitUntil(stage.port.nowNs() + static_cast<std::int64_t>(random() % 16'666'667U));
        const std::int64_t begun_ns = stage.port.nowNs();
        const std::int64_t start_ns = worked_ns();
        const auto hash = contentHash(next);
        const auto message = decoded(encoded({1, difference(next, hash, &base, baseHash)}));
        auto arrived = assembled(std::get<ProgramUpdate>(message->body), &base, baseHash);
        const bool loaded = arrived && stage.load(*arrived);
        stage.port.waitUntil(begun_ns + worked_ns() - start_ns);
        const bool shown = loaded && stage.swap();
        const double took_ms = static_cast<double>(stage.port.nowNs() - begun_ns) * 1e-6;
        if (!shown) state.SkipWithError("the stage does not play");
        state.SetIterationTime(took_ms * 1e-3);
        times.push_back(took_ms * 1e3);
        worst_ms = std::max(worst_ms, took_ms);
        base = std::move(next);
        baseHash = hash;
    }
    state.counters["worst_ms"] = worst_ms;
    state.counters["budget_ms"] = 1e3 / 60.0 + 2.0;
    report(state, std::move(times));
}

BENCHMARK(dabTravels)->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(wholeProgramTravels)->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(strokeToSwap)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
