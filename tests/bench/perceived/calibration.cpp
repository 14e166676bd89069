#include "tests/bench/perceived/calibration.h"

#include <array>
#include <cstddef>
#include <thread>
#include <vector>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace ilf::bench {
namespace {

/// Chains that do not wait for each other: latency 4 times two units, with room to spare.
constexpr int kChains = 12;
constexpr int kSteps = 200'000;
/// Keeps results alive.
volatile float sink = 0.0F;

#if defined(__x86_64__)
/// A number the compiler knows nothing of.
volatile float opaque = 0.999999F;

__attribute__((target("avx512f"))) void fma512() {
    __m512 sums[kChains];
    for (auto& sum : sums)
        sum = _mm512_set1_ps(1.0F);
    const __m512 factor = _mm512_set1_ps(opaque), term = _mm512_set1_ps(1.0F - opaque);
    for (int i = 0; i < kSteps; ++i) {
#pragma GCC unroll 12
        for (std::size_t c = 0; c < kChains; ++c)
            sums[c] = _mm512_fmadd_ps(sums[c], factor, term);
    }
    for (const auto& sum : sums)
        sink = sink + _mm512_cvtss_f32(sum);
}
__attribute__((target("avx2,fma"))) void fma256() {
    __m256 sums[kChains];
    for (auto& sum : sums)
        sum = _mm256_set1_ps(1.0F);
    const __m256 factor = _mm256_set1_ps(opaque), term = _mm256_set1_ps(1.0F - opaque);
    for (int i = 0; i < kSteps; ++i) {
#pragma GCC unroll 12
        for (std::size_t c = 0; c < kChains; ++c)
            sums[c] = _mm256_fmadd_ps(sums[c], factor, term);
    }
    for (const auto& sum : sums)
        sink = sink + _mm256_cvtss_f32(sum);
}
void fma128() {  // every x86-64 has SSE2: a product and a sum instead
    __m128 sums[kChains];
    for (auto& sum : sums)
        sum = _mm_set1_ps(1.0F);
    const __m128 factor = _mm_set1_ps(opaque), term = _mm_set1_ps(1.0F - opaque);
    for (int i = 0; i < kSteps; ++i) {
#pragma GCC unroll 12
        for (std::size_t c = 0; c < kChains; ++c)
            sums[c] = _mm_add_ps(_mm_mul_ps(sums[c], factor), term);
    }
    for (const auto& sum : sums)
        sink = sink + _mm_cvtss_f32(sum);
}
#else
/// What the compiler makes of it elsewhere.
void fma128() {
    std::array<float, 4 * kChains> sums;
    sums.fill(1.0F);
    for (int i = 0; i < kSteps; ++i)
        for (float& sum : sums)
            sum = sum * 0.999999F + 1e-6F;
    for (const float sum : sums)
        sink = sink + sum;
}
#endif

double gflops(void (*run)(), int lanes, const std::string& name, Table& table) {
    const Times times = timed({0.2, 40, 10, 60}, [&](int) { run(); });
    const double best = 2.0 * lanes * kChains * static_cast<double>(kSteps) / (times.least * 1e6);
    Row row{.section = "machine", .scene = "", .method = name, .what = "multiply-adds", .threads = 1, .times = times};
    row.figure = best;
    row.unit = "GFLOP/s";
    table.add(row);
    return best;
}

/// Bandwidth as STREAM counts it: two arrays read, one written.
double triad(std::size_t floats, int threads, const std::string& what, Table& table) {
    std::vector<float> a(floats, 1.0F), b(floats, 2.0F), c(floats, 3.0F);
    const auto part = [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i)
            a[i] = b[i] + 3.0F * c[i];
    };
    // Threads start once and pass often enough that starting does not count.
    const int passes = static_cast<int>(std::max<std::size_t>(1, (std::size_t{1} << 25U) / floats));
    const auto all = [&](std::size_t from, std::size_t to) {
        for (int pass = 0; pass < passes; ++pass) {
            part(from, to);
            sink = sink + a[from];
        }
    };
    const Times times = timed({0.4, 10, 4, 10}, [&](int) {
        if (threads == 1) return all(0, floats);
        std::jthread other(all, floats / 2, floats);
        all(0, floats / 2);
    });
    const double best = 3.0 * sizeof(float) * static_cast<double>(floats) * passes / (times.least * 1e6);
    Row row{.section = "machine", .scene = "", .method = "triad", .what = what, .threads = threads, .times = times};
    row.figure = best;
    row.unit = "GB/s";
    table.add(row);
    return best;
}

}  // namespace

Machine calibrated(Table& table) {
    Machine machine;
    machine.gflops = gflops(fma128, 4, "128 bit", table);
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        machine.gflops = std::max(machine.gflops, gflops(fma256, 8, "256 bit", table));
    if (__builtin_cpu_supports("avx512f"))
        machine.gflops = std::max(machine.gflops, gflops(fma512, 16, "512 bit", table));
#endif
    constexpr std::size_t kFar = std::size_t{24} << 20U, kNear = std::size_t{750'000};  // 3 x 96 MB, 3 x 3 MB
    machine.triad1 = triad(kFar, 1, "288 MB", table);
    machine.triad2 = triad(kFar, 2, "288 MB", table);
    triad(kNear, 1, "9 MB", table);
    machine.cached2 = triad(kNear, 2, "9 MB", table);
    return machine;
}

}  // namespace ilf::bench
