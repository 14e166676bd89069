// optics_stress [SEED] [CASES]: the kernel against MPFR on seeded random and adversarial cases. Prints the worst error
// of every value with its case, and how often the exact fallback ran; ends with 1 when a bound is broken.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/stress/exact_optics.h"
#include "tests/stress/hard_cases.h"

namespace {

using namespace ilf;
using namespace ilf::stress;

struct Worst {
    double error = 0.0;
    std::uint64_t broken = 0;
    OpticsCase in;
    void take(double next, double bound, const OpticsCase& at) {
        if (next > bound) ++broken;
        if (next > error) {
            error = next;
            in = at;
        }
    }
};

/// Bounds in ulp. w and X: 1 away from the pole of the border, else as documented.
double bound(Optic optic, const OpticsCase& in, const OpticsValues& got) {
    const bool far = optic == Optic::xFar || optic == Optic::wFar,
               near = optic == Optic::xNear || optic == Optic::wNear;
    if (optic == Optic::uE) return 2.0;
    if (optic == Optic::duE) return 3.0;
    if (far || near) {
        const double x = got[far ? Optic::xFar : Optic::xNear];
        if (std::abs(x) < 0x1p-40 * std::abs(in.power)) return 8.0;
        if (optic == Optic::xFar || optic == Optic::xNear) return 4.0;
    }
    return 1.0;
}

void print(const char* title, const std::string& name, const Worst& worst, std::uint64_t fallbacks) {
    std::printf("%-8s %-10s %8.3f  %8llu  %10llu   w=%a P=%a e=%a r=%a Pe=%a De=%a Da=%a x1=%a\n", title, name.c_str(),
                worst.error, static_cast<unsigned long long>(worst.broken), static_cast<unsigned long long>(fallbacks),
                worst.in.q == 0.0 ? HUGE_VAL : worst.in.p, worst.in.power, worst.in.lensToPupil, worst.in.retina,
                worst.in.eyePower, worst.in.pupil, worst.in.confusion, worst.in.height);
}

}  // namespace

int main(int argc, char** argv) {
    const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
    const std::uint64_t cases = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 200'000;
    if (cases == 0) {
        std::fputs("optics_stress [SEED] [CASES]: CASES must be a whole number above 0.\n", stderr);
        return 2;
    }
    HardCases hard(seed);
    ExactOptics exact;
    FallbackCounts fallbacks;
    std::array<Worst, kOptics> precise, fast;
    Worst alone;
    std::uint64_t fastCases = 0, lost = 0;
    // The fast path's promises, w >= 0 and |e P| <= 0.5; D_r in u of its scale.
    constexpr std::array<std::pair<Optic, double>, 5> kFast = {
        {{Optic::Dr, 8.0}, {Optic::s, 4.0}, {Optic::sMinus1, 5.0}, {Optic::uE, 3.0}, {Optic::dEi, 2.0}}};
    for (std::uint64_t i = 0; i < cases; ++i) {
        const OpticsCase in = hard.next(i);
        exact.work(in);
        const OpticsValues got = evaluate(in, OpticsPath::precise, &fallbacks);
        for (std::size_t k = 0; k < kOptics; ++k) {
            const auto optic = static_cast<Optic>(k);
            if (std::isnan(got.values[k])) ++lost;
            precise[k].take(exact.error(optic, got.values[k]), bound(optic, in, got), in);
        }
        alone.take(exact.error(Optic::Dr, blurDiameterPrecise(in)), 1.0, in);
        // Ends of the range and virtual objects are the precise path's business.
        if (i % HardCases::kKinds == HardCases::kKinds - 1 || in.p < 0.0 || std::abs(in.lensToPupil * in.power) > 0.5)
            continue;
        ++fastCases;
        const OpticsValues quick = evaluate(in, OpticsPath::fast64);
        for (const auto& [optic, limit] : kFast) {
            if (!exact.finite(optic)) continue;
            const double error = optic == Optic::Dr
                                     ? std::abs(quick[optic] - exact.value(optic)) / (0x1p-53 * exact.blurScale())
                                     : exact.error(optic, quick[optic]);
            fast[static_cast<std::size_t>(optic)].take(error, limit, in);
        }
    }
    std::printf("seed %llu, %llu cases, %llu of them for the fast path, %llu NaN\n",
                static_cast<unsigned long long>(seed), static_cast<unsigned long long>(cases),
                static_cast<unsigned long long>(fastCases), static_cast<unsigned long long>(lost));
    std::printf("exact fallback in %llu cases (%.2f %%)\n",
                static_cast<unsigned long long>(fallbacks.casesWithFallback),
                100.0 * static_cast<double>(fallbacks.casesWithFallback) / static_cast<double>(fallbacks.cases));
    std::printf("path     value     worst ulp    broken   fallbacks   at\n");
    std::uint64_t broken = lost;
    for (std::size_t k = 0; k < kOptics; ++k) {
        print("precise", std::string(word(static_cast<Optic>(k))), precise[k], fallbacks.byValue[k]);
        broken += precise[k].broken;
    }
    print("precise", "Dr alone", alone, 0);
    broken += alone.broken;
    for (const auto& [optic, limit] : kFast) {
        const Worst& worst = fast[static_cast<std::size_t>(optic)];
        print("fast64", std::string(word(optic)) + (optic == Optic::Dr ? " (u)" : ""), worst, 0);
        broken += worst.broken;
    }
    std::printf(broken == 0 ? "all within their bounds\n" : "BOUNDS BROKEN %llu times\n",
                static_cast<unsigned long long>(broken));
    return broken == 0 ? 0 : 1;
}
