// Double-double numbers: unevaluated sums of two doubles, about 106 bits, each with a bound of its own error.
#pragma once

#include <cmath>
#include <limits>

#ifdef __FAST_MATH__
#error                                                                                                                 \
    "The optics need IEEE arithmetic: -ffast-math (or -Ofast) reorders the sums that carry the low halves. Remove it."
#endif
static_assert(std::numeric_limits<double>::is_iec559, "double must be IEEE binary64");

namespace ilf {

/// hi + lo with |lo| <= ulp(hi) / 2.
struct Dd {
    double hi = 0.0, lo = 0.0;
};

/// a + b exactly (Knuth).
inline Dd twoSum(double a, double b) {
    const double sum = a + b, part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
}
/// The same for |a| >= |b| or a = 0 (Dekker).
inline Dd quickTwoSum(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
}
/// a b exactly, unless the low half underflows (|a b| < 2^-968).
inline Dd twoProd(double a, double b) {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
}

inline Dd operator-(Dd a) { return {-a.hi, -a.lo}; }
/// Relative error at most 2 u^2 (Joldes, Muller, Popescu 2017, algorithm 4; u = 2^-53).
inline Dd operator+(Dd a, double b) {
    const Dd s = twoSum(a.hi, b);
    return quickTwoSum(s.hi, a.lo + s.lo);
}
/// 3 u^2 of the *result*, however much cancels (algorithm 6).
inline Dd operator+(Dd a, Dd b) {
    const Dd s = twoSum(a.hi, b.hi), t = twoSum(a.lo, b.lo);
    const Dd v = quickTwoSum(s.hi, s.lo + t.hi);
    return quickTwoSum(v.hi, t.lo + v.lo);
}
/// 2 u^2 (algorithm 9).
inline Dd operator*(Dd a, double b) {
    const Dd c = twoProd(a.hi, b);
    return quickTwoSum(c.hi, std::fma(a.lo, b, c.lo));
}
/// 5 u^2 (algorithm 12).
inline Dd operator*(Dd a, Dd b) {
    const Dd c = twoProd(a.hi, b.hi);
    return quickTwoSum(c.hi, c.lo + std::fma(a.lo, b.hi, std::fma(a.hi, b.lo, a.lo * b.lo)));
}
/// Below 20 u^2, by one division: the reciprocal is good to 1.5 u, the first quotient to 3 u, and the remainder is
/// exact to 6 u^2. Precondition: 2^-1000 < |b| < 2^1000.
inline Dd operator/(Dd a, Dd b) {
    const double inverse = 1.0 / b.hi, first = a.hi * inverse;
    const Dd product = twoProd(first, b.hi);
    // a.hi - product.hi is exact: the two lie within 4 u of each other.
    const double rest = ((a.hi - product.hi) - product.lo) + std::fma(-first, b.lo, a.lo);
    return quickTwoSum(first, rest * inverse);
}

/// A double-double and how far it may lie from the exact value. The bound is what decides whether the exact fallback
/// has to run; it covers rounding and underflow (infinities and NaN make it fail every test, as they should).
struct Tracked {
    Dd value;
    double error = 0.0;

    /// 2^-101: more than any operation above can lose, bound's own rounding included.
    static constexpr double kStep = 0x1p-101;
    /// More than what underflowing products lose.
    static constexpr double kUnderflow = 0x1p-1020;
    /// Within 2^-58 of itself: rounding it once is within 0.52 ulp of the exact value.
    bool trusted() const { return error <= 0x1p-58 * std::abs(value.hi); }
};

namespace tracked {

inline double lost(double result, double a, double b) {
    return std::fma(Tracked::kStep, std::abs(result), a == 0.0 || b == 0.0 ? 0.0 : Tracked::kUnderflow);
}
/// Exact but for underflow.
inline Tracked product(double a, double b) { return {twoProd(a, b), a == 0.0 || b == 0.0 ? 0.0 : Tracked::kUnderflow}; }
inline Tracked product(const Tracked& a, double b) {
    const Dd v = a.value * b;
    return {v, std::fma(a.error, std::abs(b), lost(v.hi, a.value.hi, b))};
}
inline Tracked product(const Tracked& a, const Tracked& b) {
    const Dd v = a.value * b.value;
    const double fromA = a.error * (std::abs(b.value.hi) + b.error), fromB = b.error * std::abs(a.value.hi);
    return {v, 1.0001 * (fromA + fromB) + lost(v.hi, a.value.hi, b.value.hi)};
}
inline Tracked sum(const Tracked& a, double b) {
    const Dd v = a.value + b;
    return {v, std::fma(Tracked::kStep, std::abs(v.hi), a.error)};
}
inline Tracked sum(const Tracked& a, const Tracked& b) {
    const Dd v = a.value + b.value;
    return {v, std::fma(Tracked::kStep, std::abs(v.hi), a.error + b.error)};
}
inline Tracked negated(const Tracked& a) { return {-a.value, a.error}; }

}  // namespace tracked
}  // namespace ilf
