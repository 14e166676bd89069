#include "core/perceived/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/perceived/reference_integral.h"

namespace ilf {
namespace {

/// Whether anything is blurred for anybody: a still lens that blurs nothing leaves the eye free to focus where it
/// looks.
bool blurs(const Plan& plan, const ViewRequest& request) {
    return plan.sweeps() || request.attending || plan.input.camera ||
           std::ranges::any_of(plan.regions, [](const RegionPlan& region) {
               return region.look == Look::blur && region.alreadyBlurred;
           });
}

/// Of a mean square error; peak 1.
double decibels(double meanSquare) {
    return meanSquare > 0.0 ? -10.0 * std::log10(meanSquare) : std::numeric_limits<double>::infinity();
}

Result<void> checkedRays(const ReferenceRays& rays) {
    if (rays.samples >= 2) return {};
    return fail(Fault::outOfRange, "The reference needs at least two rays for each pixel: its noise is the difference "
                                   "between one half of them and the other.");
}

}  // namespace

Result<Reference> Reference::of(const Document& document, const Plan& plan, const Program& program,
                                const ViewRequest& request) {
    if (!document.scene.picture)
        return fail(Fault::notFound, "There is no picture to look at. Open one, or grab a frame.");
    if (!(request.scale > 0.0 && request.scale <= 1.0))
        return fail(Fault::outOfRange, "A view's scale must be more than 0 and at most 1.");
    if (const auto good = checked(program); !good) return tl::unexpected(good.error());
    if (program.imageOfSlot.size() != plan.slots.size()) {
        return fail(Fault::outOfRange, "The program and the plan have different numbers of slots. Compile again.");
    }
    auto setup = std::make_shared<reference::Setup>();
    setup->scene = reference::scene(document, plan, program, request.scale);
    auto optics = reference::optics(document, plan, request, setup->scene.frame);
    if (!optics) return tl::unexpected(optics.error());
    setup->optics = *optics;
    setup->wave = plan.waveform;
    setup->plain = !blurs(plan, request);
    return Reference(std::move(setup));
}

Size Reference::size() const { return setup_->scene.frame.size; }

Result<ReferencePicture> Reference::picture(const ReferenceRays& rays) const {
    if (const auto good = checkedRays(rays); !good) return tl::unexpected(good.error());
    const reference::Scene& scene = setup_->scene;
    const Size size = scene.frame.size;
    std::vector<float> values(scene.plain.begin(), scene.plain.end());
    if (setup_->plain) return ReferencePicture{Radiance(size, 3, std::move(values)), decibels(0.0)};

    const reference::Integral integral(*setup_, rays);
    std::vector<double> errors(static_cast<std::size_t>(size.height));
    parallelFor(size.height, [&](int y) {
        for (int x = 0; x < size.width; ++x) {
            const reference::Halves halves = integral.at({x, y});
            const reference::Colour mean = halves.mean();
            for (std::size_t c = 0; c < 3; ++c)
                values[3 * scene.frame.index(x, y) + c] = static_cast<float>(mean[c]);
            errors[static_cast<std::size_t>(y)] += halves.squaredError();
        }
    });
    double sum = 0.0;
    for (const double row : errors)
        sum += row;
    const auto count = static_cast<double>(values.size());
    return ReferencePicture{Radiance(size, 3, std::move(values)), decibels(sum / count)};
}

Result<ReferencePixels> Reference::pixels(std::span<const ViewPixel> pixels, const ReferenceRays& rays) const {
    if (const auto good = checkedRays(rays); !good) return tl::unexpected(good.error());
    const reference::Scene& scene = setup_->scene;
    for (const ViewPixel& pixel : pixels) {
        if (scene.frame.holds(pixel.x, pixel.y)) continue;
        return fail(Fault::outOfRange, "There is no pixel " + std::to_string(pixel.x) + ", " + std::to_string(pixel.y) +
                                           " in a view of " + std::to_string(size().width) + " x " +
                                           std::to_string(size().height) + ".");
    }
    ReferencePixels seen;
    seen.radiance.resize(pixels.size());
    if (setup_->plain) {
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            for (std::size_t c = 0; c < 3; ++c)
                seen.radiance[i][c] = scene.plain[3 * scene.frame.index(pixels[i].x, pixels[i].y) + c];
        }
        seen.noiseFloor_dB = decibels(0.0);
        return seen;
    }
    const reference::Integral integral(*setup_, rays);
    std::vector<double> errors(pixels.size());
    parallelFor(static_cast<int>(pixels.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const reference::Halves halves = integral.at(pixels[at]);
        seen.radiance[at] = halves.mean();
        errors[at] = halves.squaredError();
    });
    double sum = 0.0;
    for (const double one : errors)
        sum += one;
    seen.noiseFloor_dB = decibels(pixels.empty() ? 0.0 : sum / (3.0 * static_cast<double>(pixels.size())));
    return seen;
}

std::string Reference::key(const ReferenceRays& rays, std::span<const ViewPixel> pixels) const {
    return reference::keyOf(*setup_, rays, pixels);
}

Result<Radiance> perceivedReference(const Document& document, const Plan& plan, const Program& program,
                                    const ViewRequest& request, int samples, unsigned seed) {
    const auto reference = Reference::of(document, plan, program, request);
    if (!reference) return tl::unexpected(reference.error());
    auto picture = reference->picture({samples, seed});
    if (!picture) return tl::unexpected(picture.error());
    return std::move(picture->radiance);
}

}  // namespace ilf
