// The paper's closed forms with 512 bits (MPFR): what the kernel is measured against. Shares no formula code with it.
#pragma once

#include <mpfr.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/optics/kernel.h"

namespace ilf::stress {

inline constexpr mpfr_prec_t kPrecision = 512, kAnglePrecision = 96;

/// An MPFR number that frees itself.
class Mp {
public:
    explicit Mp(mpfr_prec_t bits = kPrecision) { mpfr_init2(v_, bits); }
    ~Mp() { mpfr_clear(v_); }
    Mp(const Mp&) = delete;
    Mp& operator=(const Mp&) = delete;
    operator mpfr_ptr() { return v_; }
    operator mpfr_srcptr() const { return v_; }

private:
    mpfr_t v_;
};

/// One exact value: finite, or none (infinite), or vanished: cancelled to below 2^-400 of its terms.
class ExactOptics {
public:
    void work(const OpticsCase& in);

    /// The kernel's error in ulp of the exact value. 0 for both infinite; a vanished value admits 2^-100 of its scale.
    double error(Optic optic, double got) const {
        const auto i = static_cast<std::size_t>(optic);
        const bool overflows = infinite_[i] || std::isinf(mpfr_get_d(values_[i], MPFR_RNDN));
        if (overflows || std::isinf(got)) return overflows && std::isinf(got) ? 0.0 : kInfinity;
        if (vanished_[i]) return std::abs(got) <= 0x1p-100 * scale_[i] ? 0.0 : kInfinity;
        if (mpfr_zero_p(values_[i])) return got == 0.0 ? 0.0 : kInfinity;
        mpfr_set_d(difference_, got, MPFR_RNDN);
        mpfr_sub(difference_, difference_, values_[i], MPFR_RNDN);
        const long exponent = std::max<long>(mpfr_get_exp(values_[i]) - 53, -1074);
        mpfr_mul_2si(difference_, difference_, -exponent, MPFR_RNDN);
        return std::abs(mpfr_get_d(difference_, MPFR_RNDN));
    }
    double value(Optic optic) const { return mpfr_get_d(values_[static_cast<std::size_t>(optic)], MPFR_RNDN); }
    long double longValue(Optic optic) const {
        return mpfr_get_ld(values_[static_cast<std::size_t>(optic)], MPFR_RNDN);
    }
    bool finite(Optic optic) const {
        return !infinite_[static_cast<std::size_t>(optic)] && !vanished_[static_cast<std::size_t>(optic)];
    }
    /// D_e max(|1 - r P_e|, |r t / N|).
    double blurScale() const { return blurScale_; }

private:
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Mp& at(Optic optic) { return values_[static_cast<std::size_t>(optic)]; }
    void none(Optic optic) { infinite_[static_cast<std::size_t>(optic)] = true; }
    void divide(Optic optic, const Mp& above, const Mp& below) {
        if (mpfr_zero_p(static_cast<mpfr_srcptr>(below))) return none(optic);
        mpfr_div(at(optic), above, below, MPFR_RNDN);
    }
    /// Marks a sum of terms as large as `scale` that cancelled entirely.
    bool vanishes(Optic optic, double scale) {
        const auto i = static_cast<std::size_t>(optic);
        scale_[i] = scale;
        mpfr_set_d(difference_, scale, MPFR_RNDN);
        mpfr_mul_2si(difference_, difference_, -400, MPFR_RNDN);
        return vanished_[i] = mpfr_cmpabs(values_[i], difference_) < 0;
    }
    void border(const OpticsCase& in, bool far);

    std::array<Mp, kOptics> values_;
    std::array<bool, kOptics> infinite_{}, vanished_{};
    std::array<double, kOptics> scale_{};
    double blurScale_ = 0.0;
    Mp w_, n_, t_, a_, blur_, sum_, g_, big_, x_, y_;
    Mp angleX_{kAnglePrecision}, angleY_{kAnglePrecision};
    mutable Mp difference_;
};

inline void ExactOptics::work(const OpticsCase& in) {
    constexpr auto kRound = MPFR_RNDN;
    infinite_.fill(false);
    vanished_.fill(false);
    const bool far = in.q == 0.0;
    mpfr_set_d(w_, in.p, kRound);
    // Infinity: 2^3000 m is the same to 512 bits.
    if (far) mpfr_set_ui_2exp(w_, 1, 3000, kRound);
    mpfr_mul_d(t_, w_, in.power, kRound);
    mpfr_d_sub(t_, 1.0, t_, kRound);
    mpfr_mul_d(n_, t_, in.lensToPupil, kRound);
    mpfr_add(n_, n_, w_, kRound);
    mpfr_set_d(a_, -in.retina, kRound);
    mpfr_mul_d(a_, a_, in.eyePower, kRound);
    mpfr_add_d(a_, a_, 1.0, kRound);
    mpfr_set(at(Optic::N), n_, kRound);
    if (far) none(Optic::N);
    // s, s - 1, u_E
    mpfr_add_d(sum_, w_, in.lensToPupil, kRound);
    divide(Optic::s, sum_, n_);
    mpfr_mul_d(x_, w_, in.lensToPupil, kRound);
    mpfr_mul_d(x_, x_, in.power, kRound);
    divide(Optic::sMinus1, x_, n_);
    mpfr_set(angleX_, n_, kRound);
    mpfr_set_d(angleY_, in.height, kRound);
    if (far) mpfr_set_d(angleY_, 0.0, kRound);
    mpfr_atan2(angleY_, angleY_, angleX_, kRound);
    mpfr_set(at(Optic::uE), angleY_, kRound);
    // u_E(P) - u_E(0)
    mpfr_mul_d(y_, x_, far ? 0.0 : in.height, kRound);
    mpfr_mul(x_, n_, sum_, kRound);
    mpfr_set_d(sum_, far ? 0.0 : in.height, kRound);
    mpfr_sqr(sum_, sum_, kRound);
    mpfr_add(x_, x_, sum_, kRound);
    mpfr_set(angleX_, x_, kRound);
    mpfr_set(angleY_, y_, kRound);
    mpfr_atan2(angleY_, angleY_, angleX_, kRound);
    mpfr_set(at(Optic::duE), angleY_, kRound);
    // d_Ei = -w / t, x_2 = -x_1 / t
    mpfr_neg(x_, w_, kRound);
    divide(Optic::dEi, x_, t_);
    mpfr_set_d(x_, -in.height, kRound);
    divide(Optic::x2, x_, t_);
    // D_r, E
    if (mpfr_zero_p(static_cast<mpfr_srcptr>(n_))) {
        none(Optic::Dr);
        none(Optic::E);
    } else {
        mpfr_div(blur_, t_, n_, kRound);
        mpfr_mul_d(blur_, blur_, in.retina, kRound);
        const double scale = std::max(std::abs(mpfr_get_d(blur_, kRound)), std::abs(mpfr_get_d(a_, kRound)));
        blurScale_ = in.pupil * scale;
        mpfr_add(blur_, blur_, a_, kRound);
        mpfr_abs(at(Optic::Dr), blur_, kRound);
        mpfr_mul_d(at(Optic::Dr), at(Optic::Dr), in.pupil, kRound);
        vanishes(Optic::Dr, blurScale_);
        mpfr_div_d(at(Optic::E), blur_, -in.retina, kRound);
        vanishes(Optic::E, scale / in.retina);
    }
    border(in, true);
    border(in, false);
}

inline void ExactOptics::border(const OpticsCase& in, bool far) {
    constexpr auto kRound = MPFR_RNDN;
    const Optic k = far ? Optic::kFar : Optic::kNear, x = far ? Optic::xFar : Optic::xNear,
                w = far ? Optic::wFar : Optic::wNear, least = far ? Optic::pMinFar : Optic::pMinNear;
    mpfr_mul_d(g_, a_, in.pupil, kRound);
    mpfr_add_d(g_, g_, far ? in.confusion : -in.confusion, kRound);
    mpfr_mul_d(big_, g_, in.lensToPupil, kRound);
    mpfr_set_d(x_, in.retina, kRound);
    mpfr_mul_d(x_, x_, in.pupil, kRound);
    mpfr_add(big_, big_, x_, kRound);
    divide(k, g_, big_);
    const bool noBorder = mpfr_zero_p(static_cast<mpfr_srcptr>(big_)) != 0;
    if (noBorder) {
        none(x);
        none(least);
        mpfr_set_zero(at(w), 1);
        if (mpfr_zero_p(static_cast<mpfr_srcptr>(g_))) none(w);
        return;
    }
    const double power = std::abs(mpfr_get_d(at(k), kRound));
    mpfr_d_sub(at(x), in.power, at(k), kRound);
    // All terms zero: zero, not cancelled.
    if (vanishes(x, std::max(std::abs(in.power), power))) {
        none(w);
    } else if (mpfr_zero_p(static_cast<mpfr_srcptr>(at(x)))) {
        none(w);
    } else {
        mpfr_ui_div(at(w), 1, at(x), kRound);
    }
    if (mpfr_zero_p(static_cast<mpfr_srcptr>(w_))) return none(least);
    mpfr_ui_div(at(least), 1, w_, kRound);
    const double vergence = in.q == 0.0 ? 0.0 : std::abs(mpfr_get_d(at(least), kRound));
    mpfr_add(at(least), at(least), at(k), kRound);
    // At infinity 1/w is 0 and not 2^-3000.
    if (in.q == 0.0) mpfr_set(at(least), at(k), kRound);
    vanishes(least, std::max(vergence, power));
}

}  // namespace ilf::stress
