#include "app/plots/optics_charts.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "core/optics/eye.h"

namespace ilf::app {
namespace {

constexpr const char* kEye = "Reference eye: 60 D, 4 mm pupil, 20 mm from the lens, circle of confusion 1 arcmin, 10 D "
                             "of accommodation. Calculated.";

EyeOptics referenceEye() {
    Wearer wearer;
    wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    wearer.measuredAccommodation = 10.0_D;
    return eyeOptics(wearer);
}

/// `count` + 1 points from `low` to `high`.
Curve sampled(std::string label, Mark mark, int colour, double low, double high,
              const std::function<double(double)>& value) {
    constexpr int kCount = 200;
    Curve curve{std::move(label), mark, colour, {}};
    for (int i = 0; i <= kCount; ++i) {
        const double x = low + (high - low) * i / kCount;
        curve.points.push_back({x, value(x)});
    }
    return curve;
}

Chart farBorder() {
    Chart chart{"Far border: least lens power that blurs",
                kEye,
                {"Distance from the lens [mm]", 0.0, 2500.0},
                {"Lens power P_E [D]", 0.0, 5.0},
                {}};
    const auto add = [&](std::string label, Mark mark, int colour, EyeOptics eye) {
        chart.curves.push_back(sampled(std::move(label), mark, colour, 180.0, 2500.0, [eye](double mm) {
            return minimumBlurPower(eye, Metre::fromSi(1e-3 * mm))->si();
        }));
    };
    const EyeOptics eye = referenceEye();
    add("4 mm, 1 arcmin", Mark::line, 0, eye);
    EyeOptics small = eye, large = eye, field = eye;
    small.pupil = 2.0_mm;
    large.pupil = 6.0_mm;
    add("pupil 2 mm", Mark::dashed, 1, small);
    add("pupil 6 mm", Mark::dashed, 2, large);
    field.confusion = 20.0_um;
    add("20 um (depth of field)", Mark::line, 3, field);
    field.confusion = eye.retina / 650.0;
    add("25.6 um (Landolt)", Mark::line, 5, field);
    return chart;
}

Chart nearBorder() {
    Chart chart{"Blur range: borders of sharp vision",
                kEye,
                {"Lens power P_E [D]", 0.0, 5.0},
                {"Distance from the lens [mm]", 0.0, 1000.0},
                {}};
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const EyeOptics eye = referenceEye();
    chart.curves.push_back(sampled("far border", Mark::line, 1, 0.0, 5.0, [eye](double power) {
        const double vergence = power - farBorderOffset(eye).power.si();
        return vergence > 1.0 / 3.0 ? 1e3 / vergence : kNone;
    }));
    int colour = 0;
    for (const double amplitude : {10.0, 4.0, 1.0}) {
        EyeOptics aged = eye;
        aged.accommodation = Dioptre::fromSi(amplitude);
        const std::string label = "near border, A = " + std::to_string(static_cast<int>(amplitude)) + " D";
        chart.curves.push_back(
            sampled(label, amplitude == 10.0 ? Mark::line : Mark::dashed, colour, 0.0, 5.0, [aged](double power) {
                const double vergence = power - nearBorderOffset(aged).power.si();
                return vergence > 1.0 / 3.0 ? 1e3 / vergence : kNone;
            }));
        colour += 2;
    }
    chart.curves.push_back({"80 mm (paper)", Mark::dashed, 6, {{0.0, 80.0}, {5.0, 80.0}}});
    return chart;
}

constexpr double kDistances_mm[] = {250.0, 500.0, 750.0, 1300.0, 2500.0};

std::string inMillimetres(double mm) { return std::to_string(static_cast<int>(mm)) + " mm"; }

Chart blur() {
    Chart chart{"Blur circle of the relaxed eye",
                kEye,
                {"Lens power P_E [D]", 0.0, 5.0},
                {"Blur circle [arcmin]", 0.0, 70.0},
                {}};
    int colour = 0;
    for (const double mm : kDistances_mm) {
        const EyeOptics eye = referenceEye();
        chart.curves.push_back(sampled(inMillimetres(mm), Mark::line, colour++, 0.0, 5.0, [eye, mm](double power) {
            const double radians = blurDiameter(eye, Metre::fromSi(1e-3 * mm), Dioptre::fromSi(power)) / eye.retina;
            return radians * 10800.0 / std::numbers::pi;
        }));
    }
    return chart;
}

Chart scale() {
    Chart chart{"Apparent size against that at 0 D",
                kEye,
                {"Lens power P_E [D]", 0.0, 5.0},
                {"Scaling factor s", 1.0, 1.12},
                {}};
    int colour = 0;
    for (const double mm : kDistances_mm) {
        const EyeOptics eye = referenceEye();
        chart.curves.push_back(sampled(inMillimetres(mm), Mark::line, colour++, 0.0, 5.0, [eye, mm](double power) {
            return magnification(eye, Metre::fromSi(1e-3 * mm), 0.0_D, Dioptre::fromSi(power));
        }));
    }
    return chart;
}

}  // namespace

std::optional<Chart> opticsChart(const std::string& name) {
    if (name == "far-border") return farBorder();
    if (name == "near-border") return nearBorder();
    if (name == "blur") return blur();
    if (name == "scale") return scale();
    return std::nullopt;
}

}  // namespace ilf::app
