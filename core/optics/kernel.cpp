#include "core/optics/kernel.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "core/optics/dd.h"
#include "core/optics/dyadic.h"
#include "core/optics/forms.h"

// The whole of a function again for processors with fma, chosen when the program runs: std::fma is a call otherwise,
// and every result is the same bit for bit, fma being exact either way.
#if defined(__x86_64__) && defined(__GNUC__)
#define ILF_FMA_TARGET __attribute__((target("avx2,fma"), flatten))
#define ILF_HAS_FMA_TARGET 1
#else
#define ILF_FMA_TARGET
#define ILF_HAS_FMA_TARGET 0
#endif

namespace ilf {
namespace {

using forms::FastArithmetic;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool processorHasFma() {
#if ILF_HAS_FMA_TARGET
    static const bool has = __builtin_cpu_supports("fma") != 0 && __builtin_cpu_supports("avx2") != 0;
    return has;
#else
    return false;
#endif
}

struct TrackedArithmetic {
    using In = double;
    using Number = Tracked;
    template <class X, class Y>
    static Number product(const X& x, const Y& y) {
        return tracked::product(x, y);
    }
    template <class X, class Y, class Z>
    static Number mulAdd(const X& x, const Y& y, const Z& z) {
        return tracked::sum(tracked::product(x, y), z);
    }
    static Number negated(const Number& x) { return tracked::negated(x); }
};

struct ExactArithmetic {
    using In = Dyadic;
    using Number = Dyadic;
    static Number product(const Dyadic& x, const Dyadic& y) { return x * y; }
    static Number mulAdd(const Dyadic& x, const Dyadic& y, const Dyadic& z) { return x * y + z; }
    static Number negated(const Dyadic& x) { return -x; }
};

template <class Real>
struct Inputs {
    Real p, q, power, lensToPupil, retina, eyePower, pupil, confusion, height;
    explicit Inputs(const OpticsCase& in)
        : p(Real(in.p)), q(Real(in.q)), power(Real(in.power)), lensToPupil(Real(in.lensToPupil)),
          retina(Real(in.retina)), eyePower(Real(in.eyePower)), pupil(Real(in.pupil)), confusion(Real(in.confusion)),
          height(Real(in.height)) {}
};

bool allFinite(const OpticsCase& in) {
    return std::isfinite(in.p) && std::isfinite(in.q) && std::isfinite(in.power) && std::isfinite(in.lensToPupil) &&
           std::isfinite(in.retina) && std::isfinite(in.eyePower) && std::isfinite(in.pupil) &&
           std::isfinite(in.confusion) && std::isfinite(in.height) && !(in.p == 0.0 && in.q == 0.0);
}

/// p : q with q >= 0, and p > 0 at infinity: the same point, and N has the sign of w + e - w e P.
OpticsCase normalised(OpticsCase in) {
    if (in.q < 0.0 || (in.q == 0.0 && in.p < 0.0)) {
        in.p = -in.p;
        in.q = -in.q;
    }
    return in;
}

/// Above / below rounded once, if both are known well enough.
std::optional<double> rounded(const forms::Ratio<Tracked>& ratio) {
    if (!ratio.above.trusted() || !ratio.below.trusted() || ratio.below.value.hi == 0.0) return std::nullopt;
    if (ratio.above.value.hi == 0.0) return 0.0;
    // Near the ends of the range the low halves are lost.
    const auto wellInside = [](double x) { return std::abs(x) > 0x1p-900 && std::abs(x) < 0x1p900; };
    const Dd value = ratio.above.value / ratio.below.value;
    if (!wellInside(ratio.above.value.hi) || !wellInside(ratio.below.value.hi) || !wellInside(value.hi))
        return std::nullopt;
    return value.hi;
}

/// The exact terms, worked out when first needed.
class Exact {
public:
    explicit Exact(const OpticsCase& in) : in_(in) {}
    forms::Ratio<Dyadic> ratio(Optic which) { return forms::ratioOf<ExactArithmetic>(which, terms(), far(), *near_); }
    const forms::Terms<ExactArithmetic>& terms() {
        if (!terms_) terms_.emplace(in_);
        return *terms_;
    }
    const forms::Border<ExactArithmetic>& far() {
        if (!far_) far_.emplace(terms(), true);
        if (!near_) near_.emplace(terms(), false);
        return *far_;
    }

private:
    OpticsCase in_;
    std::optional<forms::Terms<ExactArithmetic>> terms_;
    std::optional<forms::Border<ExactArithmetic>> far_, near_;
};

/// d_Ei / w = 1 / (w P - 1) is -1 for a lens of no power however far the object; as 0 : 0 the projective form cannot
/// tell.
void imageWithoutPower(const OpticsCase& in, OpticsValues& out) {
    if (in.q == 0.0 && in.power == 0.0) out.values[static_cast<std::size_t>(Optic::x2)] = -in.height;
}

/// The first status that holds. `farReach` has the sign of Q = D_e r (1 + e F).
template <class Real>
OpticsStatus statusOf(const OpticsCase& in, const OpticsValues& out, Real nSign, Real farReach) {
    if (in.pupil == 0.0) return OpticsStatus::zeroPupil;
    if (nSign == Real(0)) return OpticsStatus::pole;
    const bool real = in.p >= 0.0;
    if (std::fma(-in.lensToPupil, in.power, 1.0) <= 0.0 || (real && nSign < Real(0))) return OpticsStatus::pastThePole;
    if (farReach <= Real(0)) return OpticsStatus::farPointBetween;
    if (!real) return OpticsStatus::negativeDistance;
    if (in.p == 0.0) return OpticsStatus::atLens;
    if (in.q == 0.0) return OpticsStatus::atInfinity;
    if (out[Optic::pMinFar] > in.maximumPower) return OpticsStatus::beyondTheLens;
    if (out[Optic::pMinFar] <= 0.0) return OpticsStatus::alreadyBlurred;
    if (out[Optic::xFar] <= 0.0) return OpticsStatus::noFarBorder;
    return OpticsStatus::ok;
}

/// atan2(above, below) from the two and from their rounded quotient: where the angle is its own tangent the quotient
/// is taken, which neither underflows nor rounds twice.
double angle(double above, double below, double ratio) {
    if (below > 0.0 && std::abs(ratio) < 0x1p-27) return ratio;
    return std::atan2(above, below);
}

/// Which of the two half turns a point on the axis (x_1 = 0) makes when N changes its sign is in the sign of the zero.
double signedZero(const OpticsCase& in, Optic which, double above) {
    if (above != 0.0 || which != Optic::duE) return above;
    return std::copysign(0.0, in.lensToPupil * in.p * in.power * in.height * in.q);
}

inline OpticsValues preciseValues(const OpticsCase& in, FallbackCounts* fallbacks) {
    using A = TrackedArithmetic;
    const forms::Terms<A> terms(in);
    const forms::Border<A> far(terms, true), near(terms, false);
    Exact exact(in);
    bool fell = false;
    const auto count = [&](Optic which) {
        fell = true;
        if (fallbacks != nullptr) ++fallbacks->byValue[static_cast<std::size_t>(which)];
    };
    OpticsValues out;
    for (std::size_t i = 0; i < kOptics; ++i) {
        const Optic which = static_cast<Optic>(i);
        const auto ratio = forms::ratioOf<A>(which, terms, far, near);
        if (const auto value = rounded(ratio)) {
            out.values[i] = *value;
            if (which == Optic::uE || which == Optic::duE) {
                out.values[i] = angle(signedZero(in, which, ratio.above.value.hi), ratio.below.value.hi, *value);
            }
        } else {
            count(which);
            const auto precisely = exact.ratio(which);
            out.values[i] = quotient(precisely.above, precisely.below);
            if (which == Optic::uE || which == Optic::duE) {
                out.values[i] = angle(signedZero(in, which, quotient(precisely.above, 1.0)),
                                      quotient(precisely.below, 1.0), out.values[i]);
            }
        }
        if (which == Optic::Dr) out.values[i] = std::abs(out.values[i]);
    }
    imageWithoutPower(in, out);
    const auto signOf = [](const Tracked& known, const auto& exactly) {
        return known.trusted() ? known.value.hi : static_cast<double>(exactly().sign());
    };
    const double nSign = signOf(terms.n, [&]() -> const Dyadic& { return exact.terms().n; });
    const double farReach = signOf(far.big, [&]() -> const Dyadic& { return exact.far().big; });
    out.status = statusOf(in, out, nSign, farReach);
    if (fallbacks != nullptr) {
        ++fallbacks->cases;
        if (fell) ++fallbacks->casesWithFallback;
    }
    return out;
}

template <class Real>
inline OpticsValues fastValues(const OpticsCase& in) {
    using A = FastArithmetic<Real>;
    const forms::Terms<A> terms{Inputs<Real>(in)};
    const forms::Border<A> far(terms, true), near(terms, false);
    OpticsValues out;
    const auto finite = [](Real x) { return std::isnan(x) ? kInfinity : static_cast<double>(x); };
    for (std::size_t i = 0; i < kOptics; ++i) {
        const Optic which = static_cast<Optic>(i);
        const auto ratio = forms::ratioOf<A>(which, terms, far, near);
        const Real value = which == Optic::uE || which == Optic::duE ? std::atan2(ratio.above, ratio.below)
                                                                     : ratio.above / ratio.below;
        out.values[i] = finite(which == Optic::Dr ? std::abs(value) : value);
    }
    // 1/w + K: without the common denominator's roundings.
    out.values[static_cast<std::size_t>(Optic::pMinFar)] = finite(terms.q / terms.p + far.g / far.big);
    out.values[static_cast<std::size_t>(Optic::pMinNear)] = finite(terms.q / terms.p + near.g / near.big);
    imageWithoutPower(in, out);
    out.status = statusOf(in, out, terms.n, far.big);
    return out;
}

inline double preciseBlur(const OpticsCase& in) {
    const forms::Terms<TrackedArithmetic> terms(in);
    const auto value = rounded(terms.signedBlur());
    if (value) return std::abs(*value);
    const forms::Terms<ExactArithmetic> exact(in);
    const auto ratio = exact.signedBlur();
    return std::abs(quotient(ratio.above, ratio.below));
}

template <class Real>
inline void fastMap(const Real* __restrict distances, std::size_t count, const OpticsCase& in, Real* __restrict out) {
    const Inputs<Real> k(in);
    const Real a = std::fma(-k.retina, k.eyePower, Real(1)), farthest = Real(1e12);
    const Real power = k.power, e = k.lensToPupil, r = k.retina, pupil = k.pupil;
    for (std::size_t i = 0; i < count; ++i) {
        const Real w = distances[i] < farthest ? distances[i] : farthest;
        const Real t = std::fma(-w, power, Real(1)), n = std::fma(e, t, w);
        out[i] = pupil * std::abs(std::fma(r, t / n, a));
    }
}

ILF_FMA_TARGET OpticsValues preciseValuesFma(const OpticsCase& in, FallbackCounts* f) { return preciseValues(in, f); }
ILF_FMA_TARGET OpticsValues fastValuesFma64(const OpticsCase& in) { return fastValues<double>(in); }
ILF_FMA_TARGET OpticsValues fastValuesFma32(const OpticsCase& in) { return fastValues<float>(in); }
ILF_FMA_TARGET double preciseBlurFma(const OpticsCase& in) { return preciseBlur(in); }
ILF_FMA_TARGET void fastMapFma(const float* distances, std::size_t count, const OpticsCase& in, float* out) {
    fastMap(distances, count, in, out);
}
ILF_FMA_TARGET void fastMapFma(const double* distances, std::size_t count, const OpticsCase& in, double* out) {
    fastMap(distances, count, in, out);
}

template <class Real>
void mapAny(std::span<const Real> distances, const OpticsCase& in, std::span<Real> diameters) {
    assert(distances.size() == diameters.size());
    assert(in.lensToPupil * in.power < 1.0);
    if (processorHasFma()) {
        fastMapFma(distances.data(), distances.size(), in, diameters.data());
    } else {
        fastMap(distances.data(), distances.size(), in, diameters.data());
    }
}

}  // namespace

void OpticsCase::setDistance(double metres) {
    p = std::isinf(metres) ? 1.0 : metres;
    q = std::isinf(metres) ? 0.0 : 1.0;
}

OpticsValues evaluate(const OpticsCase& given, OpticsPath path, FallbackCounts* fallbacks) {
    if (!allFinite(given)) {
        OpticsValues none;
        none.values.fill(kInfinity);
        none.status = OpticsStatus::notANumber;
        return none;
    }
    const OpticsCase in = normalised(given);
    const bool fma = processorHasFma();
    if (path == OpticsPath::precise) return fma ? preciseValuesFma(in, fallbacks) : preciseValues(in, fallbacks);
    if (path == OpticsPath::fast64) return fma ? fastValuesFma64(in) : fastValues<double>(in);
    return fma ? fastValuesFma32(in) : fastValues<float>(in);
}

double blurDiameterPrecise(const OpticsCase& in) {
    assert(allFinite(in));
    return processorHasFma() ? preciseBlurFma(in) : preciseBlur(in);
}

void blurDiameters(std::span<const float> distances, const OpticsCase& in, std::span<float> diameters) {
    mapAny(distances, in, diameters);
}
void blurDiameters(std::span<const double> distances, const OpticsCase& in, std::span<double> diameters) {
    mapAny(distances, in, diameters);
}

std::string_view word(Optic optic) {
    constexpr std::array<std::string_view, kOptics> kWords{
        "N",     "Dr",    "E",     "s",        "s_minus_1", "uE",     "duE",    "dEi",      "x2",
        "K_far", "X_far", "w_far", "Pmin_far", "K_near",    "X_near", "w_near", "Pmin_near"};
    return kWords[static_cast<std::size_t>(optic)];
}

std::string_view word(OpticsStatus status) {
    switch (status) {
    case OpticsStatus::notANumber:
        return "not-a-number";
    case OpticsStatus::zeroPupil:
        return "zero-pupil";
    case OpticsStatus::pole:
        return "pole";
    case OpticsStatus::pastThePole:
        return "past-the-pole";
    case OpticsStatus::farPointBetween:
        return "far-point-between";
    case OpticsStatus::negativeDistance:
        return "negative-distance";
    case OpticsStatus::atLens:
        return "at-lens";
    case OpticsStatus::atInfinity:
        return "at-infinity";
    case OpticsStatus::beyondTheLens:
        return "beyond-the-lens";
    case OpticsStatus::alreadyBlurred:
        return "already-blurred";
    case OpticsStatus::noFarBorder:
        return "no-far-border";
    case OpticsStatus::ok:
        break;
    }
    return "ok";
}

}  // namespace ilf
