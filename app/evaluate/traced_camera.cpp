#include "app/evaluate/traced_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/optics/ray_matrix.h"

namespace ilf::app {
namespace {

struct Spot {
    double x, y;
};

/// The `i`-th point of a low-discrepancy sequence (R4) in the unit hypercube, as two points of the unit square.
struct Sample {
    Spot first, second;
};
Sample sample(int i) {
    constexpr double kRoot = 1.16730397826141868425;  // of x^5 = x + 1
    const double n = i + 1.0;
    double step = 1.0;
    const auto next = [&] {
        step /= kRoot;
        const double value = 0.5 + n * step;
        return value - std::floor(value);
    };
    Sample made{};
    made.first.x = next();
    made.first.y = next();
    made.second.x = next();
    made.second.y = next();
    return made;
}

/// Evenly over the unit disc.
Spot onDisc(Spot square) {
    const double radius = std::sqrt(square.x), angle = 2.0 * std::numbers::pi * square.y;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Height = object * the object point's height + via * the height at which the ray passes a plane on the way.
struct Landing {
    double object, via;
    double operator()(double x, double at) const { return object * x + via * at; }
};

/// From an object point and a point of the tunable lens to the pupil and the sensor.
struct Paths {
    Landing pupil, sensor;
};
Paths throughLens(const TracedCamera& camera, double distance, double power) {
    const RayMatrix toPupil = travel(camera.lensToPupil.si()) * thinLens(power);
    const RayMatrix toSensor = travel(camera.sensor.si()) * thinLens(camera.ownPower.si()) * toPupil;
    const Ray fromObject{0.0, -1.0 / distance}, viaLens{1.0, 1.0 / distance};
    return {{(toPupil * fromObject).height, (toPupil * viaLens).height},
            {(toSensor * fromObject).height, (toSensor * viaLens).height}};
}

/// From an object point and a point of the pupil to the sensor.
Landing throughPupil(const TracedCamera& camera, double distance, double power) {
    const RayMatrix toPupil = objectToPupil(distance, power, camera.lensToPupil.si());
    const RayMatrix toSensor =
        objectToRetina(distance, power, camera.lensToPupil.si(), camera.ownPower.si(), camera.sensor.si());
    const Ray fromObject{1.0, -toPupil.a / toPupil.b}, viaPupil{0.0, 1.0 / toPupil.b};
    return {(toSensor * fromObject).height, (toSensor * viaPupil).height};
}

/// Light that falls between pixel centres is shared by the four around it.
class Sensor {
public:
    explicit Sensor(Size size) : size_(size), light_(static_cast<std::size_t>(size.width * size.height)) {}
    void receive(double x, double y) {
        const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
        const int i = static_cast<int>(left), j = static_cast<int>(top);
        if (i < 0 || j < 0 || i + 1 >= size_.width || j + 1 >= size_.height) return;
        const auto fx = static_cast<float>(x - 0.5 - left), fy = static_cast<float>(y - 0.5 - top);
        float* at = light_.data() + j * size_.width + i;
        at[0] += (1.0F - fx) * (1.0F - fy);
        at[1] += fx * (1.0F - fy);
        at[size_.width] += (1.0F - fx) * fy;
        at[size_.width + 1] += fx * fy;
    }
    Image<float> picture() && { return {size_, 1, std::move(light_)}; }

private:
    Size size_;
    std::vector<float> light_;
};

}  // namespace

TracedCamera focusedCamera(Metre focalLength, double fNumber, Metre pixelPitch, Metre distance, Metre lensToPupil,
                           Metre lensAperture) {
    const Dioptre own = 1.0 / focalLength;
    const RayMatrix toLens = thinLens(own.si()) * objectToPupil(distance.si(), 0.0, lensToPupil.si());
    return {lensToPupil, lensAperture, focalLength / fNumber, own, Metre::fromSi(imageDistance(toLens)), pixelPitch};
}

TracedCamera accommodatedEye(Metre pupil, Metre lensToPupil, Dioptre amplitude, Metre pitch, Metre distance,
                             Dioptre lens) {
    constexpr Dioptre kRelaxed = 60.0_D;
    const Metre retina = 1.0 / kRelaxed;
    // Sharp: no ray's height on the retina depends on its slope at the object, b = 0; b is linear in the eye's power.
    const auto slopeTerm = [&](double own) {
        return objectToRetina(distance.si(), lens.si(), lensToPupil.si(), own, retina.si()).b;
    };
    const double none = slopeTerm(0.0), sharp = none / (none - slopeTerm(1.0));
    const Dioptre own = Dioptre::fromSi(std::clamp(sharp, kRelaxed.si(), (kRelaxed + amplitude).si()));
    return {lensToPupil, 16.0_mm, pupil, own, retina, pitch};
}

std::vector<double> heldPower(Dioptre power) { return {power.si()}; }

std::vector<double> sweptPowers(const Harmonics& power, double middle, double length, int samples) {
    std::vector<double> powers;
    for (int i = 0; i < samples; ++i)
        powers.push_back(power.at(middle + length * ((i + 0.5) / samples - 0.5)));
    return powers;
}

Image<float> picturedDots(const TracedCamera& camera, const DotChart& chart, std::span<const double> powers,
                          Size sensor, int rays) {
    Sensor collected(sensor);
    const double rim = 0.5 * camera.lensAperture.si(), iris = 0.5 * camera.pupil.si(), pitch = camera.pixelPitch.si();
    const int each = std::max(1, rays / static_cast<int>(powers.size()));
    for (std::size_t k = 0; k < powers.size(); ++k) {
        const Paths path = throughLens(camera, chart.distance.si(), powers[k]);
        for (int i = 0; i < each; ++i) {
            // Every moment goes on where the one before left off, so that its rays fall between the others'.
            const int ray = static_cast<int>(k) * each + i;
            const Sample drawn = sample(ray);
            const Spot lens = onDisc(drawn.first), within = onDisc(drawn.second);
            const double ax = rim * lens.x, ay = rim * lens.y;
            for (int dot = 0; dot < 9; ++dot) {
                const double x = chart.spacing.si() * (dot % 3 - 1) + chart.dotRadius.si() * within.x;
                const double y = chart.spacing.si() * (dot / 3 - 1) + chart.dotRadius.si() * within.y;
                const double px = path.pupil(x, ax), py = path.pupil(y, ay);
                if (px * px + py * py > iris * iris) continue;
                collected.receive(0.5 * sensor.width + path.sensor(x, ax) / pitch,
                                  0.5 * sensor.height + path.sensor(y, ay) / pitch);
            }
        }
    }
    return std::move(collected).picture();
}

Image<float> picturedRing(const TracedCamera& camera, const LandoltRing& ring, std::span<const double> powers,
                          Size sensor, int rays) {
    const double angle = 2.0 * std::numbers::pi * ring.direction / kRingDirections;
    const double cosine = std::cos(angle), sine = std::sin(angle), gap = ring.gap.si();
    const auto white = [&](double x, double y) {
        const double square = (x * x + y * y) / (gap * gap);
        const double along = x * cosine + y * sine, across = y * cosine - x * sine;
        const bool ink = square > 2.25 && square < 6.25 && !(along > 0.0 && std::abs(across) < 0.5 * gap);
        return !ink;
    };
    std::vector<Landing> landings;
    for (const double power : powers)
        landings.push_back(throughPupil(camera, ring.distance.si(), power));
    const double iris = 0.5 * camera.pupil.si(), pitch = camera.pixelPitch.si();
    // Where a ray of the pixel lies in the pixel and, moved aside by the pupil point it passes, on the ring.
    struct Offset {
        double inX, inY, size, asideX, asideY;
    };
    std::vector<Offset> offsets;
    for (int i = 0; i < rays; ++i) {
        const Sample drawn = sample(i);
        const Spot pupil = onDisc(drawn.first);
        // The image is upside down on the retina and upright in the picture: divided by the scale's size.
        const Landing& landing = landings[static_cast<std::size_t>(i) % landings.size()];
        const double aside = iris * landing.via / landing.object;
        offsets.push_back(
            {drawn.second.x, drawn.second.y, pitch / std::abs(landing.object), aside * pupil.x, aside * pupil.y});
    }
    std::vector<float> pixels;
    for (int row = 0; row < sensor.height; ++row) {
        for (int column = 0; column < sensor.width; ++column) {
            int bright = 0;
            for (const Offset& o : offsets) {
                const double right = (column + o.inX - 0.5 * sensor.width) * o.size;
                const double up = (0.5 * sensor.height - row - o.inY) * o.size;
                bright += white(right - o.asideX, up - o.asideY) ? 1 : 0;
            }
            pixels.push_back(static_cast<float>(bright) / static_cast<float>(rays));
        }
    }
    return {sensor, 1, std::move(pixels)};
}

}  // namespace ilf::app
