// Physical quantities whose units the compiler checks: metres, dioptres, seconds, hertz, volts, amperes.
#pragma once

#include <cmath>
#include <compare>

namespace ilf {

/// A number with a dimension: metre^L second^T ampere^A volt^V, held in SI units.
/// The algebra of optics is the algebra of types: `1.0 / 0.5_m` is a Dioptre, `4.0_mm * 2.0_D` a number (radians).
template <int L, int T, int A = 0, int V = 0>
class Quantity {
public:
    constexpr Quantity() = default;
    static constexpr Quantity fromSi(double si) { return Quantity(si); }

    constexpr double si() const { return si_; }
    /// How many `unit`s this is: `d.in(1.0_mm)`.
    constexpr double in(Quantity unit) const { return si_ / unit.si_; }

    constexpr auto operator<=>(const Quantity&) const = default;
    constexpr Quantity operator-() const { return Quantity(-si_); }
    constexpr Quantity& operator+=(Quantity o) { return si_ += o.si_, *this; }
    constexpr Quantity& operator-=(Quantity o) { return si_ -= o.si_, *this; }
    friend constexpr Quantity operator+(Quantity a, Quantity b) { return Quantity(a.si_ + b.si_); }
    friend constexpr Quantity operator-(Quantity a, Quantity b) { return Quantity(a.si_ - b.si_); }
    friend constexpr Quantity operator*(double k, Quantity q) { return Quantity(k * q.si_); }
    friend constexpr Quantity operator*(Quantity q, double k) { return Quantity(q.si_ * k); }
    friend constexpr Quantity operator/(Quantity q, double k) { return Quantity(q.si_ / k); }
    friend constexpr Quantity<-L, -T, -A, -V> operator/(double k, Quantity q) {
        return Quantity<-L, -T, -A, -V>::fromSi(k / q.si_);
    }
    friend constexpr Quantity abs(Quantity q) { return Quantity(q.si_ < 0.0 ? -q.si_ : q.si_); }
    friend bool isFinite(Quantity q) { return std::isfinite(q.si_); }

private:
    constexpr explicit Quantity(double si) : si_(si) {}
    double si_ = 0.0;
};

/// Products and quotients whose dimensions cancel are plain numbers.
template <int L1, int T1, int A1, int V1, int L2, int T2, int A2, int V2>
constexpr auto operator*(Quantity<L1, T1, A1, V1> a, Quantity<L2, T2, A2, V2> b) {
    if constexpr (L1 + L2 == 0 && T1 + T2 == 0 && A1 + A2 == 0 && V1 + V2 == 0) {
        return a.si() * b.si();
    } else {
        return Quantity<L1 + L2, T1 + T2, A1 + A2, V1 + V2>::fromSi(a.si() * b.si());
    }
}
template <int L1, int T1, int A1, int V1, int L2, int T2, int A2, int V2>
constexpr auto operator/(Quantity<L1, T1, A1, V1> a, Quantity<L2, T2, A2, V2> b) {
    if constexpr (L1 == L2 && T1 == T2 && A1 == A2 && V1 == V2) {
        return a.si() / b.si();
    } else {
        return Quantity<L1 - L2, T1 - T2, A1 - A2, V1 - V2>::fromSi(a.si() / b.si());
    }
}

using Metre = Quantity<1, 0>;
using Dioptre = Quantity<-1, 0>;
using Second = Quantity<0, 1>;
using Hertz = Quantity<0, -1>;
using Ampere = Quantity<0, 0, 1>;
using Volt = Quantity<0, 0, 0, 1>;

inline namespace literals {
constexpr Metre operator""_m(long double v) { return Metre::fromSi(static_cast<double>(v)); }
constexpr Metre operator""_mm(long double v) { return Metre::fromSi(static_cast<double>(v / 1e3L)); }
constexpr Metre operator""_um(long double v) { return Metre::fromSi(static_cast<double>(v / 1e6L)); }
constexpr Dioptre operator""_D(long double v) { return Dioptre::fromSi(static_cast<double>(v)); }
constexpr Second operator""_s(long double v) { return Second::fromSi(static_cast<double>(v)); }
constexpr Second operator""_ms(long double v) { return Second::fromSi(static_cast<double>(v / 1e3L)); }
constexpr Second operator""_us(long double v) { return Second::fromSi(static_cast<double>(v / 1e6L)); }
constexpr Hertz operator""_Hz(long double v) { return Hertz::fromSi(static_cast<double>(v)); }
}  // namespace literals

}  // namespace ilf
