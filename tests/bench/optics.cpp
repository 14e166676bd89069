// One blur diameter D_r: what it costs and how wrong it is, for the paper's form as printed and for ours.
#include <benchmark/benchmark.h>
#include <mpfr.h>

#include <cmath>
#include <ctime>
#include <vector>

#include "core/optics/kernel.h"
#include "tests/stress/exact_optics.h"

namespace {

using namespace ilf;

/// The reference eye looking at 0.25 to 2.5 m through 0 to 5 D, with the exact values. Emmetropic: 1 - r P_e is next to
/// 0.
struct Grid {
    static constexpr std::size_t kDistances = 1024, kPowers = 11;
    std::vector<double> distances;
    std::vector<float> floats;
    std::vector<OpticsCase> eyes;
    std::vector<long double> exact, exactOfFloats;  // 64 bits: half an ulp is seen

    Grid() {
        for (std::size_t i = 0; i < kDistances; ++i) {
            distances.push_back(0.25 * std::pow(10.0, static_cast<double>(i) / double(kDistances - 1)));
            floats.push_back(static_cast<float>(distances.back()));
        }
        stress::ExactOptics reference;
        for (std::size_t k = 0; k < kPowers; ++k) {
            OpticsCase eye;
            eye.power = 0.5 * static_cast<double>(k);
            // Floats, so that both precisions are asked the same.
            eye.lensToPupil = 0.02F;
            eye.retina = static_cast<float>(1.0 / 60.0);
            eye.eyePower = 60.0;
            eye.pupil = 0.004F;
            eye.confusion = 4.848e-6F;
            eyes.push_back(eye);
            for (std::size_t i = 0; i < kDistances; ++i) {
                eye.setDistance(distances[i]);
                reference.work(eye);
                exact.push_back(reference.longValue(Optic::Dr));
                eye.setDistance(static_cast<double>(floats[i]));
                reference.work(eye);
                exactOfFloats.push_back(reference.longValue(Optic::Dr));
            }
        }
    }
};

const Grid& grid() {
    static const Grid made;
    return made;
}

/// Worst error in units of the last of `digits` bits.
template <class Real>
double worstUlp(const std::vector<Real>& got, const std::vector<long double>& exact, int digits) {
    long double worst = 0.0L;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        int exponent = 0;
        std::frexp(exact[i], &exponent);
        worst = std::max(worst, std::ldexp(std::abs(static_cast<long double>(got[i]) - exact[i]), digits - exponent));
    }
    return static_cast<double>(worst);
}

/// This thread's own seconds: what others do on the same cores is not counted.
double processorTime() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Times `row(eye, out)`, which fills one power's diameters; the time shown is that of one D_r, on one core.
template <class Real, class Row>
void timed(benchmark::State& state, const std::vector<long double>& exact, int digits, const char* unit, Row&& row) {
    std::vector<Real> out(exact.size());
    for (auto _ : state) {
        const double start = processorTime();
        for (std::size_t k = 0; k < Grid::kPowers; ++k)
            row(grid().eyes[k], out.data() + k * Grid::kDistances);
        benchmark::DoNotOptimize(out.data());
        benchmark::ClobberMemory();
        state.SetIterationTime((processorTime() - start) / static_cast<double>(out.size()));
    }
    state.counters["error"] = worstUlp(out, exact, digits);
    state.SetLabel(unit);
}

/// D_e |1 - r P_e + r (1 - w P) / (w + e - w e P)|, as printed.
template <class Real>
Real asPrinted(const OpticsCase& eye, double distance) {
    const Real w = Real(distance), P = Real(eye.power), e = Real(eye.lensToPupil), r = Real(eye.retina);
    const Real value = Real(1) - r * Real(eye.eyePower) + r * (Real(1) - w * P) / (w + e - w * e * P);
    return Real(eye.pupil) * std::abs(value);
}

template <class Real>
void printedForm(benchmark::State& state) {
    timed<double>(state, grid().exact, 53, "ulp", [](const OpticsCase& eye, double* out) {
        for (std::size_t i = 0; i < Grid::kDistances; ++i)
            out[i] = static_cast<double>(asPrinted<Real>(eye, grid().distances[i]));
    });
}

void fast64(benchmark::State& state) {
    timed<double>(state, grid().exact, 53, "ulp", [](const OpticsCase& eye, double* out) {
        blurDiameters(grid().distances, eye, std::span<double>(out, Grid::kDistances));
    });
}

void fast32(benchmark::State& state) {
    timed<float>(state, grid().exactOfFloats, 24, "ulp of float", [](const OpticsCase& eye, float* out) {
        blurDiameters(grid().floats, eye, std::span<float>(out, Grid::kDistances));
    });
}

void precise(benchmark::State& state) {
    timed<double>(state, grid().exact, 53, "ulp", [](OpticsCase eye, double* out) {
        for (std::size_t i = 0; i < Grid::kDistances; ++i) {
            eye.setDistance(grid().distances[i]);
            out[i] = blurDiameterPrecise(eye);
        }
    });
}

void allValues(benchmark::State& state, OpticsPath path) {
    timed<double>(state, grid().exact, 53, "ulp; all 17 values", [path](OpticsCase eye, double* out) {
        for (std::size_t i = 0; i < Grid::kDistances; ++i) {
            eye.setDistance(grid().distances[i]);
            out[i] = evaluate(eye, path)[Optic::Dr];
        }
    });
}
void preciseAll(benchmark::State& state) { allValues(state, OpticsPath::precise); }
void fast64All(benchmark::State& state) { allValues(state, OpticsPath::fast64); }

/// The form as printed with 256 bits.
void mpfr(benchmark::State& state) {
    stress::Mp above(256), below(256), sum(256);
    timed<double>(state, grid().exact, 53, "ulp", [&](const OpticsCase& eye, double* out) {
        for (std::size_t i = 0; i < Grid::kDistances; ++i) {
            mpfr_set_d(above, grid().distances[i], MPFR_RNDN);
            mpfr_mul_d(above, above, eye.power, MPFR_RNDN);
            mpfr_d_sub(above, 1.0, above, MPFR_RNDN);
            mpfr_mul_d(below, above, eye.lensToPupil, MPFR_RNDN);
            mpfr_add_d(below, below, grid().distances[i], MPFR_RNDN);
            mpfr_div(above, above, below, MPFR_RNDN);
            mpfr_mul_d(above, above, eye.retina, MPFR_RNDN);
            mpfr_set_d(sum, -eye.retina, MPFR_RNDN);
            mpfr_mul_d(sum, sum, eye.eyePower, MPFR_RNDN);
            mpfr_add_d(sum, sum, 1.0, MPFR_RNDN);
            mpfr_add(sum, sum, above, MPFR_RNDN);
            mpfr_abs(sum, sum, MPFR_RNDN);
            mpfr_mul_d(sum, sum, eye.pupil, MPFR_RNDN);
            out[i] = mpfr_get_d(sum, MPFR_RNDN);
        }
    });
}

BENCHMARK(printedForm<double>)->UseManualTime()->Iterations(200);
BENCHMARK(printedForm<long double>)->UseManualTime()->Iterations(200);
BENCHMARK(fast64)->UseManualTime()->Iterations(500);
BENCHMARK(fast32)->UseManualTime()->Iterations(1000);
BENCHMARK(precise)->UseManualTime()->Iterations(50);
BENCHMARK(preciseAll)->UseManualTime()->Iterations(5);
BENCHMARK(fast64All)->UseManualTime()->Iterations(20);
BENCHMARK(mpfr)->UseManualTime()->Iterations(5);

}  // namespace

BENCHMARK_MAIN();
