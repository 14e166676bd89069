// The optics of one case, evaluated two ways behind one interface: to the last bit, or fast.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace ilf {

/// What is asked: an object point, the lens, the eye. SI units and dioptres; symbols of the paper in brackets.
struct OpticsCase {
    double p = 1.0, q = 1.0;     ///< object distance p / q [d_oE]: (w, 1), or (1, 0) for infinity, or (1, vergence)
    double power = 0.0;          ///< of the lens [P_E]
    double lensToPupil = 0.0;    ///< [d_Ee]
    double retina = 0.0;         ///< pupil to retina, reduced [d_er]
    double eyePower = 0.0;       ///< [P_e]: P_e^f for far borders, P_e^n for near ones
    double pupil = 0.0;          ///< [D_e]
    double confusion = 0.0;      ///< acceptable circle of confusion [D_r^a]
    double height = 0.0;         ///< of the object point [x_1]
    double maximumPower = 10.0;  ///< of the lens: a P_min above it is `beyondTheLens`

    /// Sets the distance in metres; infinite is a distance like others.
    void setDistance(double metres);
};

/// The values, in the order and under the names of the reference's golden files.
enum class Optic : std::uint8_t {
    N,
    Dr,
    E,
    s,
    sMinus1,
    uE,
    duE,
    dEi,
    x2,
    kFar,
    xFar,
    wFar,
    pMinFar,
    kNear,
    xNear,
    wNear,
    pMinNear,
    count
};
inline constexpr std::size_t kOptics = static_cast<std::size_t>(Optic::count);
std::string_view word(Optic optic);

/// What kind of case it is; the first that holds, in this order.
enum class OpticsStatus : std::uint8_t {
    notANumber,        ///< an input is NaN, or infinite other than the distance: no values
    zeroPupil,         ///< D_e = 0: nothing is ever blurred
    pole,              ///< N = 0: rays arrive parallel to the pupil's edge; blur and scale have no finite value
    pastThePole,       ///< e P >= 1, or N of the wrong sign: outside the domain, formula's values only
    farPointBetween,   ///< 1 + e F <= 0: the eye's far point lies between lens and eye, everything is blurred
    negativeDistance,  ///< a virtual object
    atLens,            ///< w = 0: no power blurs it
    atInfinity,
    beyondTheLens,   ///< P_min exceeds the lens's largest power
    alreadyBlurred,  ///< P_min <= 0: blurred with the lens at rest (myope)
    noFarBorder,     ///< P <= K_f: sharp to infinity and beyond; w_far is negative or infinite
    ok,
};
std::string_view word(OpticsStatus status);

struct OpticsValues {
    /// The formula's finite value where one exists; infinite where none does. Never NaN.
    std::array<double, kOptics> values{};
    OpticsStatus status = OpticsStatus::ok;
    double operator[](Optic optic) const { return values[static_cast<std::size_t>(optic)]; }
};

/// How often double-double was not enough, by value (the angles count with N and with their own arguments).
struct FallbackCounts {
    std::uint64_t cases = 0, casesWithFallback = 0;
    std::array<std::uint64_t, kOptics> byValue{};
};

enum class OpticsPath : std::uint8_t { precise, fast64, fast32 };

/// All values. precise: double-double, one rounding, and exact integers where its own error bound does not suffice:
/// every value but the angles within 0.52 ulp, u_E 2, angle difference 3. fast64 and fast32: fma only; for distances >=
/// 0 and |e P| <= 0.5: |error of D_r| <= 8 u D_e max(|1 - r P_e|, |r t / N|), s 4 ulp, s - 1 5 ulp, u_E 3 ulp, d_Ei 2
/// ulp.
OpticsValues evaluate(const OpticsCase& in, OpticsPath path, FallbackCounts* fallbacks = nullptr);

/// D_r alone, metres; infinite at the pole. Precondition: finite inputs.
double blurDiameterPrecise(const OpticsCase& in);

/// D_r in metres for a map of distances in metres (one a pixel, or a sample), fma only, four to sixteen at a time.
/// Distances of 10^12 m and more, infinity and NaN count as infinity. `in.p`, `in.q` are not used. Preconditions:
/// distances >= 0, e P < 1, and both spans equally long.
void blurDiameters(std::span<const float> distances, const OpticsCase& in, std::span<float> diameters);
void blurDiameters(std::span<const double> distances, const OpticsCase& in, std::span<double> diameters);

}  // namespace ilf
