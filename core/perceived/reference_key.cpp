// A name for a result by brute force: a hash of what the rays meet, not of what the documents say.
#include <bit>

#include "core/perceived/reference_integral.h"
#include "core/perceived/reference_points.h"

namespace ilf::reference {
namespace {

/// Of the method: counts up whenever the same scene gives other numbers.
constexpr std::uint64_t kVersion = 1;

class Hash {
public:
    void add(std::uint64_t word) {
        // Two sums that mix differently: 128 bits.
        a_ = (a_ ^ word) * 0x9e3779b97f4a7c15ULL;
        a_ ^= a_ >> 32U;
        b_ = (b_ + word) * 0xd1342543de82ef95ULL;
        b_ ^= b_ >> 29U;
    }
    void add(int value) { add(static_cast<std::uint64_t>(static_cast<std::int64_t>(value))); }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }
    void add(const std::vector<double>& values) {
        add(static_cast<std::uint64_t>(values.size()));
        for (const double value : values)
            add(value);
    }
    void add(Pair pair) {
        add(pair.x);
        add(pair.y);
    }
    std::string digits() const {
        std::string text;
        for (const std::uint64_t word : {mixed(a_), mixed(b_)}) {
            for (int shift = 60; shift >= 0; shift -= 4)
                text += "0123456789abcdef"[(word >> static_cast<unsigned>(shift)) & 15U];
        }
        return text;
    }

private:
    std::uint64_t a_ = kVersion, b_ = kVersion;
};

}  // namespace

std::string keyOf(const Setup& setup, const ReferenceRays& rays, std::span<const ViewPixel> pixels) {
    Hash hash;
    const Scene& scene = setup.scene;
    hash.add(setup.plain ? 1 : 0);
    hash.add(scene.frame.size.width);
    hash.add(scene.frame.size.height);
    hash.add(scene.plain);
    for (const Surface& surface : scene.surfaces) {
        hash.add(static_cast<int>(surface.kind));
        for (const double value : {surface.vergence.at, surface.vergence.dx, surface.vergence.dy, surface.tear})
            hash.add(value);
        hash.add(surface.map);
        hash.add(surface.share);
    }
    for (const Light& light : scene.lights) {
        hash.add(light.radiance);
        for (const view::Exposure& exposure : light.exposures) {
            hash.add(exposure.start.si());
            hash.add(exposure.duration.si());
            hash.add(exposure.weight);
        }
    }
    const Optics& optics = setup.optics;
    for (const double value : {optics.lensToPupil, optics.pupilRadius, optics.restPower, optics.surplus[0],
                               optics.surplus[1], optics.surplus[2], optics.turning, optics.rim.value_or(0.0),
                               optics.focalPixels, optics.frame.perPictureX, optics.frame.perPictureY}) {
        hash.add(value);
    }
    hash.add(optics.pupil);
    hash.add(optics.lens);
    hash.add(optics.axis);
    hash.add(setup.wave.rate.si());
    for (const auto& c : setup.wave.power.c) {
        hash.add(c.real());
        hash.add(c.imag());
    }
    hash.add(rays.samples);
    hash.add(static_cast<std::uint64_t>(rays.seed));
    hash.add(static_cast<std::uint64_t>(pixels.size()));
    for (const ViewPixel& pixel : pixels) {
        hash.add(pixel.x);
        hash.add(pixel.y);
    }
    return hash.digits();
}

}  // namespace ilf::reference
