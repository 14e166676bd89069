#include "core/optics/dyadic.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace ilf {
namespace {

using Limbs = std::vector<std::uint32_t>;
constexpr int kBits = 32;

void trim(Limbs& a) {
    while (!a.empty() && a.back() == 0)
        a.pop_back();
}

int bitLength(const Limbs& a) {
    return a.empty() ? 0 : static_cast<int>(a.size()) * kBits - std::countl_zero(a.back());
}

Limbs shifted(const Limbs& a, int bits) {
    Limbs out(static_cast<std::size_t>(bits / kBits), 0U);
    const int rest = bits % kBits;
    std::uint64_t carry = 0;
    for (const std::uint32_t limb : a) {
        carry |= static_cast<std::uint64_t>(limb) << rest;
        out.push_back(static_cast<std::uint32_t>(carry));
        carry >>= kBits;
    }
    out.push_back(static_cast<std::uint32_t>(carry));
    trim(out);
    return out;
}

bool less(const Limbs& a, const Limbs& b) {
    if (a.size() != b.size()) return a.size() < b.size();
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

Limbs added(const Limbs& a, const Limbs& b) {
    const Limbs &longer = a.size() < b.size() ? b : a, &shorter = a.size() < b.size() ? a : b;
    Limbs out;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < longer.size(); ++i) {
        carry += static_cast<std::uint64_t>(longer[i]) + (i < shorter.size() ? shorter[i] : 0U);
        out.push_back(static_cast<std::uint32_t>(carry));
        carry >>= kBits;
    }
    out.push_back(static_cast<std::uint32_t>(carry));
    trim(out);
    return out;
}

/// a -= b for a >= b.
void subtract(Limbs& a, const Limbs& b) {
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const std::uint64_t taken = (i < b.size() ? b[i] : 0U) + borrow;
        borrow = a[i] < taken ? 1U : 0U;
        a[i] = static_cast<std::uint32_t>(a[i] - taken);
    }
    trim(a);
}

}  // namespace

Dyadic::Dyadic(double value) {
    assert(std::isfinite(value));
    if (value == 0.0) return;
    int exponent = 0;
    const auto bits = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(value), &exponent), 53));
    magnitude_ = {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> kBits)};
    trim(magnitude_);
    exponent_ = exponent - 53;
    negative_ = value < 0.0;
}

Dyadic Dyadic::operator-() const {
    Dyadic out = *this;
    out.negative_ = !negative_;
    return out;
}

Dyadic operator+(const Dyadic& a, const Dyadic& b) {
    if (a.sign() == 0) return b;
    if (b.sign() == 0) return a;
    Dyadic out;
    out.exponent_ = std::min(a.exponent_, b.exponent_);
    Dyadic::Limbs x = shifted(a.magnitude_, a.exponent_ - out.exponent_);
    Dyadic::Limbs y = shifted(b.magnitude_, b.exponent_ - out.exponent_);
    if (a.negative_ == b.negative_) {
        out.magnitude_ = added(x, y);
        out.negative_ = a.negative_;
        return out;
    }
    const bool swap = less(x, y);
    if (swap) std::swap(x, y);
    subtract(x, y);
    out.magnitude_ = std::move(x);
    out.negative_ = swap ? b.negative_ : a.negative_;
    return out;
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    Dyadic out;
    if (a.sign() == 0 || b.sign() == 0) return out;
    out.magnitude_.assign(a.magnitude_.size() + b.magnitude_.size(), 0U);
    for (std::size_t i = 0; i < a.magnitude_.size(); ++i) {
        std::uint64_t carry = 0;
        for (std::size_t j = 0; j < b.magnitude_.size(); ++j) {
            carry += out.magnitude_[i + j] + static_cast<std::uint64_t>(a.magnitude_[i]) * b.magnitude_[j];
            out.magnitude_[i + j] = static_cast<std::uint32_t>(carry);
            carry >>= kBits;
        }
        out.magnitude_[i + b.magnitude_.size()] = static_cast<std::uint32_t>(carry);
    }
    trim(out.magnitude_);
    out.exponent_ = a.exponent_ + b.exponent_;
    out.negative_ = a.negative_ != b.negative_;
    return out;
}

double quotient(const Dyadic& a, const Dyadic& b) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (b.sign() == 0) return a.sign() < 0 ? -kInfinity : kInfinity;
    if (a.sign() == 0) return 0.0;
    // Scale so that 1/2 < rest / divisor < 2, then take 64 bits of the quotient one by one; the rest is sticky.
    const int shift = bitLength(b.magnitude_) - bitLength(a.magnitude_);
    Limbs rest = shifted(a.magnitude_, std::max(0, shift));
    const Limbs divisor = shifted(b.magnitude_, std::max(0, -shift));
    int exponent = a.exponent_ - b.exponent_ - shift;
    if (less(rest, divisor)) {
        rest = shifted(rest, 1);
        --exponent;
    }
    std::uint64_t bits = 0;
    for (int i = 0; i < 64; ++i) {
        bits <<= 1U;
        if (!less(rest, divisor)) {
            subtract(rest, divisor);
            bits |= 1U;
        }
        rest = shifted(rest, 1);
    }
    if (!rest.empty()) bits |= 1U;
    // A subnormal result has fewer bits than 53: they are cut here, so that it is rounded once and not twice.
    const int below = -1022 - exponent;
    if (below > 0) {
        if (below > 62) return a.negative_ != b.negative_ ? -0.0 : 0.0;
        const std::uint64_t sticky = (bits & ((std::uint64_t{1} << static_cast<unsigned>(below)) - 1U)) != 0 ? 1U : 0U;
        bits = (bits >> static_cast<unsigned>(below)) | sticky;
        exponent += below;
        // Bits stand at weight 2^(exponent - 63); a subnormal keeps those of weight 2^-1074 and above, 11 are below.
        const std::uint64_t kept = bits >> 11U, tail = bits & 0x7ffU;
        const bool up = tail > 0x400U || (tail == 0x400U && (kept & 1U) != 0);
        const double value = std::ldexp(static_cast<double>(kept + (up ? 1U : 0U)), exponent - 63 + 11);
        return a.negative_ != b.negative_ ? -value : value;
    }
    const double value = std::ldexp(static_cast<double>(bits), exponent - 63);
    return a.negative_ != b.negative_ ? -value : value;
}

}  // namespace ilf
