// The closed forms of the optics as quotients of polynomials, once, for every arithmetic that evaluates them.
#pragma once

#include <cmath>

#include "core/optics/kernel.h"

namespace ilf::forms {

/// fma in the type itself: the fast path's.
template <class Real>
struct FastArithmetic {
    using In = Real;
    using Number = Real;
    static Real product(Real x, Real y) { return x * y; }
    static Real mulAdd(Real x, Real y, Real z) { return std::fma(x, y, z); }
    static Real negated(Real x) { return -x; }
};

/// t = q - p P: the vergence behind the lens, of the other sign and times p.
template <class A>
typename A::Number vergenceTerm(const typename A::In& p, const typename A::In& q, const typename A::In& power) {
    return A::mulAdd(-p, power, q);
}

/// N = p + e t.
template <class A>
typename A::Number pupilTerm(const typename A::In& p, const typename A::Number& t, const typename A::In& e) {
    return A::mulAdd(t, e, p);
}

template <class Number>
struct Ratio {
    Number above, below;
};

/// The common terms, for an object at the projective distance p : q (infinity is 1 : 0):
///   t = q - p P,  N = p + e t,  a = 1 - r P_e,  I = (a N + r t) / N
/// `Arithmetic` gives In (an input), Number, and product, mulAdd(x, y, z) = x y + z, negated over them.
template <class Arithmetic>
struct Terms {
    using In = typename Arithmetic::In;
    using Number = typename Arithmetic::Number;
    using A = Arithmetic;

    In p, q, power, e, r, eyePower, pupil, confusion, x1;
    Number t, n, a, i;

    template <class Input>
    explicit Terms(const Input& in)
        : p(in.p), q(in.q), power(in.power), e(in.lensToPupil), r(in.retina), eyePower(in.eyePower), pupil(in.pupil),
          confusion(in.confusion), x1(in.height), t(vergenceTerm<A>(p, q, power)), n(pupilTerm<A>(p, t, e)),
          a(A::mulAdd(-r, eyePower, In(1.0))), i(A::mulAdd(a, n, A::product(t, r))) {}

    /// D_r is its absolute value; negative in front of the retina.
    Ratio<Number> signedBlur() const { return {A::product(i, pupil), n}; }
};

/// One border: g = a D_e +- D_a (far: +), Q = r D_e + e g, K = g / Q, X = (P Q - g) / Q, P_min = (p g + q Q) / (p Q).
template <class Arithmetic>
struct Border {
    using A = Arithmetic;
    using Number = typename Arithmetic::Number;
    Number g, big, difference;

    Border(const Terms<A>& k, bool far)
        : g(A::mulAdd(k.a, k.pupil, far ? k.confusion : -k.confusion)),
          big(A::mulAdd(g, k.e, A::product(k.r, k.pupil))), difference(A::mulAdd(big, k.power, A::negated(g))) {}

    Ratio<Number> minimumPower(const Terms<A>& k) const {
        return {A::mulAdd(g, k.p, A::product(big, k.q)), A::product(big, k.p)};
    }
};

/// Every value but the two angles and D_r's sign, as above / below.
template <class A>
Ratio<typename A::Number> ratioOf(Optic which, const Terms<A>& k, const Border<A>& far, const Border<A>& near) {
    using In = typename A::In;
    const auto number = [](const In& x) { return A::product(x, In(1.0)); };
    switch (which) {
    case Optic::N:
        return {k.n, number(k.q)};
    case Optic::Dr:
        return k.signedBlur();
    case Optic::E:
        return {A::negated(k.i), A::product(k.n, k.r)};
    case Optic::s:
        return {A::mulAdd(k.e, k.q, k.p), k.n};
    case Optic::sMinus1:
        return {A::product(A::product(k.e, k.p), k.power), k.n};
    case Optic::dEi:
        return {number(-k.p), k.t};
    case Optic::x2:
        return {A::product(-k.x1, k.q), k.t};
    case Optic::kFar:
        return {far.g, far.big};
    case Optic::xFar:
        return {far.difference, far.big};
    case Optic::wFar:
        return {far.big, far.difference};
    case Optic::pMinFar:
        return far.minimumPower(k);
    case Optic::kNear:
        return {near.g, near.big};
    case Optic::xNear:
        return {near.difference, near.big};
    case Optic::wNear:
        return {near.big, near.difference};
    case Optic::pMinNear:
        return near.minimumPower(k);
    // u_E(P) - u_E(0) = atan2(x_1 e p P q, N (p + e q) + x_1^2 q^2)
    case Optic::duE: {
        const auto xq = A::product(k.x1, k.q);
        return {A::product(A::product(A::product(A::product(k.e, k.p), k.power), k.x1), k.q),
                A::mulAdd(k.n, A::mulAdd(k.e, k.q, k.p), A::product(xq, xq))};
    }
    // u_E = atan2(x_1 q, N)
    case Optic::uE:
    case Optic::count:
        break;
    }
    return {A::product(k.x1, k.q), k.n};
}

}  // namespace ilf::forms
