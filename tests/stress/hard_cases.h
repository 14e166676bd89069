// Seeded random cases of the optics, most of them built to cancel: near focus, poles, borders, the ends of the range.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "core/optics/kernel.h"

namespace ilf::stress {

class HardCases {
public:
    explicit HardCases(std::uint64_t seed) : random_(seed) {}

    static constexpr int kKinds = 16;

    /// The `index`-th case; kinds take turns.
    OpticsCase next(std::uint64_t index) {
        OpticsCase in = ordinary();
        double w = in.p;
        switch (index % kKinds) {
        case 0:
            break;
        case 1:  // the default eye
            in.eyePower = 60.0;
            in.retina = 1.0 / 60.0;
            in.power = uniform(0.0, 5.0);
            break;
        case 2:
            in.eyePower = 1.0 / in.retina;
            in.power = std::ldexp(uniform(-1.0, 1.0), -whole(1, 300));
            break;
        case 3:
            in.power = close(1.0 / w);
            break;  // image at infinity
        case 4: {   // in focus
            const double t = 1.0 - w * in.power;
            in.eyePower = close(1.0 / in.retina + t / (w + in.lensToPupil * t));
            break;
        }
        case 5:
            in.power = close(1.0 / in.lensToPupil + 1.0 / w);
            break;  // pole
        case 6:
        case 7: {  // borders at infinity
            const double g =
                (1.0 - in.retina * in.eyePower) * in.pupil + (index % kKinds == 6 ? 1.0 : -1.0) * in.confusion;
            in.power = close(g / (in.retina * in.pupil + in.lensToPupil * g));
            break;
        }
        case 8:
            w = std::pow(10.0, uniform(3.0, 18.0));
            break;
        case 9:
            w = std::pow(10.0, uniform(-9.0, -2.0));
            break;
        case 10:
            in.confusion = std::abs(close(in.pupil * std::abs(in.retina * in.eyePower - 1.0)));
            break;  // K = 0
        case 11: {  // far or near point at the lens: K infinite
            const double a = -in.retina / in.lensToPupil + (whole(0, 1) == 0 ? 1.0 : -1.0) * in.confusion / in.pupil;
            in.eyePower = close((1.0 - a) / in.retina);
            break;
        }
        case 12:
            in.eyePower = neighbour(1.0 / in.retina);
            in.power = whole(0, 3) == 0 ? neighbour(1.0 / in.lensToPupil) : in.power;
            break;
        case 13:  // short binary fractions: much is exactly zero
            w = whole(-8, 32) * 0.125;
            in.power = whole(-32, 32) * 0.25;
            in.lensToPupil = whole(0, 8) * 0x1p-5;
            in.retina = 0x1p-6;
            in.eyePower = whole(120, 140) * 0.5;
            in.pupil = whole(1, 4) * 0x1p-9;
            in.confusion = whole(0, 4) * 0x1p-18;
            in.height = whole(-2, 2) * 0x1p-4;
            break;
        case 14:
            w = -w;
            break;
        default: {  // one or two inputs at the end of their range
            for (int i = whole(1, 2); i > 0; --i)
                extreme(in, w);
            break;
        }
        }
        in.setDistance(w);
        return in;
    }

private:
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

    OpticsCase ordinary() {
        OpticsCase in;
        in.p = std::exp(uniform(std::log(0.05), std::log(20.0)));
        in.power = uniform(-10.0, 10.0);
        in.lensToPupil = uniform(0.005, 0.05);
        in.retina = uniform(0.015, 0.025);
        in.eyePower = uniform(45.0, 75.0);
        in.pupil = uniform(0.002, 0.008);
        in.confusion = std::exp(uniform(std::log(1e-6), std::log(3e-5)));
        in.height = std::exp(uniform(std::log(1e-4), std::log(0.2)));
        return in;
    }
    double neighbour(double x) {
        for (int i = whole(-3, 3), step = i < 0 ? -1 : 1; i != 0; i -= step)
            x = std::nextafter(x, step * HUGE_VAL);
        return x;
    }
    /// x itself, a neighbour, or x (1 +- 2^-k).
    double close(double x) {
        if (whole(0, 3) == 0) return neighbour(x);
        return x * (1.0 + std::ldexp(whole(0, 1) == 0 ? 1.0 : -1.0, -whole(1, 52)));
    }
    void extreme(OpticsCase& in, double& w) {
        constexpr std::array<double, 8> kLengths = {0.0, 0x1p-1074, 0x1p-1022, 1e-30, 1e-9, 1e9, 1e18, 1e30};
        const double length = kLengths[static_cast<std::size_t>(whole(0, 7))];
        switch (whole(0, 7)) {
        case 0:
            w = length;
            break;
        case 1:
            w = HUGE_VAL;
            break;
        case 2:
            in.power = whole(0, 1) == 0 ? length : -length;
            break;
        case 3:
            in.lensToPupil = length;
            break;
        case 4:
            in.confusion = length;
            break;
        case 5:
            in.height = whole(0, 1) == 0 ? 0.0 : 1e-200;
            break;
        case 6:
            in.pupil = whole(0, 1) == 0 ? 0x1p-1022 : 1e-9;
            break;
        default:
            in.eyePower = 0.0;
            break;
        }
    }

    std::mt19937_64 random_;
};

}  // namespace ilf::stress
