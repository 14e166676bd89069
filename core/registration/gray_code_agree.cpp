#include "core/registration/gray_code_agree.h"

// Highway compiles this file once for each kind of processor; the rest of the program includes none of it.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/registration/gray_code_agree.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#pragma GCC diagnostic pop

HWY_BEFORE_NAMESPACE();
namespace ilf::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The counts of as many pixels as a vector holds stay in registers while all their neighbours pass by.
void countAgreeingHere(const Departures& of, int width, std::int16_t gateX, std::int16_t gateY, Agreement& out) {
    const hn::ScalableTag<std::int16_t> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto withinX = hn::Set(d, gateX), withinY = hn::Set(d, gateY);
    const auto nowhere = hn::Set(d, of.nowhere), zero = hn::Zero(d);
    for (int i = 0; i < width; i += lanes) {
        const auto x = hn::LoadU(d, of.x + i), y = hn::LoadU(d, of.y + i);
        auto agree = zero, known = zero, sumX = zero, sumY = zero;
        for (int v = -kAgreeReach; v <= kAgreeReach; ++v) {
            const std::ptrdiff_t row = v * of.stride + i - kAgreeReach;
            for (int u = 0; u <= 2 * kAgreeReach; ++u) {
                const auto thereX = hn::LoadU(d, of.x + row + u);
                const auto dx = hn::Sub(thereX, x), dy = hn::Sub(hn::LoadU(d, of.y + row + u), y);
                // Lanes of a mask are -1 or 0.
                const auto in = hn::And(hn::VecFromMask(d, hn::Lt(hn::Abs(dx), withinX)),
                                        hn::VecFromMask(d, hn::Lt(hn::Abs(dy), withinY)));
                agree = hn::Sub(agree, in);
                sumX = hn::Add(sumX, hn::And(dx, in));
                sumY = hn::Add(sumY, hn::And(dy, in));
                known = hn::Sub(known, hn::VecFromMask(d, hn::Lt(thereX, nowhere)));
            }
        }
        hn::StoreU(agree, d, out.agree.data() + i);
        hn::StoreU(known, d, out.known.data() + i);
        hn::StoreU(sumX, d, out.sumX.data() + i);
        hn::StoreU(sumY, d, out.sumY.data() + i);
    }
}

}  // namespace ilf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ilf {

HWY_EXPORT(countAgreeingHere);

void countAgreeing(const Departures& of, int width, std::int16_t gateX, std::int16_t gateY, Agreement& out) {
    HWY_DYNAMIC_DISPATCH(countAgreeingHere)(of, width, gateX, gateY, out);
}

}  // namespace ilf
#endif
