// Exact numbers of the form integer times a power of two: what sums and products of doubles are. The kernel's fallback.
#pragma once

#include <cstdint>
#include <vector>

namespace ilf {

/// Sums and products are exact for all finite doubles, subnormal ones included. Slow (microseconds); rarely needed.
class Dyadic {
public:
    Dyadic() = default;
    /// Precondition: finite.
    Dyadic(double value);  // NOLINT(google-explicit-constructor): every finite double is one of these

    int sign() const { return magnitude_.empty() ? 0 : negative_ ? -1 : 1; }
    Dyadic operator-() const;
    friend Dyadic operator+(const Dyadic& a, const Dyadic& b);
    friend Dyadic operator*(const Dyadic& a, const Dyadic& b);

    /// a / b rounded once, to nearest. With b = 0: infinity with the sign of a (0 / 0 too: there is no value to give).
    friend double quotient(const Dyadic& a, const Dyadic& b);

private:
    using Limbs = std::vector<std::uint32_t>;  // least significant first, no leading zeros
    Limbs magnitude_;
    int exponent_ = 0;
    bool negative_ = false;
};

}  // namespace ilf
