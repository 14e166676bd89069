#include "core/perceived/prediction_subject.h"

#include <algorithm>
#include <cmath>

#include "core/perceived/seam_errors.h"
#include "core/plan/notes.h"

namespace ilf::prediction {
namespace {

/// Powers nearer than this show the same picture.
constexpr Dioptre kSamePower = 1e-3_D;

/// What the region was given, or, where a plane or a depth map is less certain than that, two standard deviations.
Metre toleranceOf(const Document& document, const RegionPlan& planned) {
    const Metre uncertain = 2.0 * planned.sigma;
    const Region* region = findRegion(document, planned.id);
    if (region == nullptr) return uncertain;
    if (const auto* constant = std::get_if<ConstantDistance>(&region->distance)) return constant->tolerance;
    if (const auto* map = std::get_if<FromDepthMap>(&region->distance)) return std::max(map->tolerance, uncertain);
    return uncertain;
}

/// Nearest and farthest point without the tolerance that the plan has added.
std::array<Metre, 2> ends(const RegionPlan& region, Metre tolerance) {
    const Metre within = std::min(tolerance, 0.5 * (region.farthest - region.nearest));
    return {region.nearest + within, region.farthest - within};
}

}  // namespace

Subject::Light Subject::lightAt(const Plan& plan, const RegionPlan& region) {
    return {region.levelPower, region.level ? plan.levels[static_cast<std::size_t>(*region.level)].rmsError : 0.0_D,
            1.0};
}

Subject::Subject(const Plan& plan, const RegionPlan& region, const Document& document, const PredictionErrors& errors)
    : scratch_(plan), region_(region), eye_(plan.input.eye), errors_(errors) {
    scratch_.regions.clear();  // the eye's state is in its ametropia: contrastLeft is to find nothing to attend
    findLight(plan, region);
    findPlace(plan, region, document);
    findSeam(plan, region, document);
    registration_ = errors.registration.value_or(
        knownRegistration(document, assumed_.distance).value_or(SeamErrors{}.registration));
}

void Subject::findLight(const Plan& plan, const RegionPlan& region) {
    realEye_ = camera() ? 0.0_D : realEyeError(eye_.pupil);
    rest_ = plan.focusPower;
    through_ = region.look == Look::focus ? region.levelPower : rest_;
    if (region.look != Look::neutral || plan.levels.empty()) {
        lights_.push_back(lightAt(plan, region));
        return;
    }
    double all = 0.0;
    for (const Level& level : plan.levels)
        all += level.exposure;
    for (const Level& level : plan.levels)
        lights_.push_back({level.power, level.rmsError, all > 0.0 ? level.exposure / all : 1.0});
}

void Subject::findPlace(const Plan& plan, const RegionPlan& region, const Document& document) {
    assumed_.pupil = eye_.pupil;
    tolerance_ = errors_.distance.value_or(toleranceOf(document, region));
    const auto [near, far] = ends(region, toleranceOf(document, region));
    assumed_.distance = near;
    if (const RegionPlan* attended = attendedRegion(plan)) {
        attendedTolerance_ = errors_.distance.value_or(toleranceOf(document, *attended));
        attendedLight_ = lightAt(plan, *attended);
        assumed_.attended = ends(*attended, toleranceOf(document, *attended))[0];
    }
    if (region.look == Look::blur) return;
    World other = assumed_;
    other.distance = far;
    if (defocusOf(other, Eyes::on) > defocusOf(assumed_, Eyes::on)) assumed_ = other;
}

void Subject::findSeam(const Plan& plan, const RegionPlan& region, const Document& document) {
    blending_ = document.seam;
    const bool none = blending_.blending == Blending::none;
    if (!plan.sweeps() || (blending_.blending != Blending::closedForm && !none)) return;
    // Its own light where that is displaced; else the light it meets that is displaced most.
    const Light* most = nullptr;
    std::vector<Light> met;
    for (const RegionPlan& other : plan.regions)
        if (other.level) met.push_back(lightAt(plan, other));
    for (const Light& light : met)
        if (most == nullptr || abs(light.power - rest_) > abs(most->power - rest_)) most = &light;
    if (region.level && abs(region.levelPower - rest_) > kSamePower) most = nullptr;
    const Light displaced = most != nullptr ? *most : lightAt(plan, region);
    displaced_ = displaced.power;
    displacedWrong_ = errors_.power.value_or(displaced.rmsError);  // real eyes magnify no differently
    if (abs(displaced_ - rest_) <= kSamePower) return;
    seamPart_ = 1.0;
    if (region.look == Look::neutral) {
        const double sharp = sharpShare(assumed_, Eyes::on);
        seamPart_ = std::max(sharp, 1.0 - sharp);
    }
    axesApart_ = abs(document.wearer.eyeSpacing());
    const Region* painted = findRegion(document, region.id);
    const double perMetre = document.scene.picture ? pixelsPerMetre(document, assumed_.distance) : 0.0;
    if (painted == nullptr || painted->mask.empty() || perMetre <= 0.0) return;
    const auto box = painted->mask.coveredPixels().clipped(document.scene.size());
    const Point<CameraFrame> a = opticalCentre(document, Eye::left, assumed_.distance),
                             b = opticalCentre(document, Eye::right, assumed_.distance);
    const double x = 0.5 * (a.x + b.x), y = 0.5 * (a.y + b.y);
    reach_ = Metre::fromSi(std::hypot(std::max(std::abs(box.x0 - x), std::abs(box.x1 - x)),
                                      std::max(std::abs(box.y0 - y), std::abs(box.y1 - y))) /
                           perMetre);
}

/// Its accommodation is taken off its ametropia: a relaxed eye of that refraction sees the same.
EyeOptics Subject::eyeFor(const World& world, Eyes eyes) const {
    EyeOptics eye = eye_;
    eye.pupil = world.pupil;
    Dioptre asked;
    if (eyes == Eyes::on) asked = -defocus(eye_, world.distance, through_);
    if (eyes == Eyes::aside && attendedLight_) {
        const Dioptre off = errors_.power.value_or(attendedLight_->rmsError);
        asked = -defocus(eye_, world.attended, attendedLight_->power + world.attendedPower * off);
    }
    eye.ametropia -= std::clamp(asked, 0.0_D, eye_.accommodation);
    return eye;
}

double Subject::defocusOf(const World& world, Eyes eyes) const {
    const EyeOptics eye = eyeFor(world, eyes);
    double most = 0.0;
    for (const Light& light : lights_)
        most = std::max(most, abs(defocus(eye, world.distance, powerOf(light, world))).si());
    return most;
}

double Subject::sharpShare(const World& world, Eyes eyes) const {
    const EyeOptics eye = eyeFor(world, eyes);
    double share = 0.0;
    for (const Light& light : lights_) {
        if (abs(defocus(eye, world.distance, light.power)) <= acceptableDefocus(eye)) share += light.share;
    }
    return std::min(1.0, share);
}

Subject::Contrast Subject::contrast(const World& world, Eyes eyes) {
    scratch_.input.eye = eyeFor(world, eyes);
    region_.nearest = world.distance;
    Contrast sum;
    for (const Light& light : lights_) {
        region_.levelPower = powerOf(light, world);
        const ContrastLeft left = contrastLeft(scratch_, region_);
        sum.ambient += light.share * left.ambient;
        sum.dark += light.share * left.dark;
    }
    return sum;
}

double Subject::seam(const World& world) const {
    const bool blended = blending_.blending == Blending::closedForm;
    const auto radius = [&](const World& w, Dioptre power) {
        EyeOptics eye = eye_;
        eye.pupil = w.pupil;
        return blurRadiusOnSurface(eye, w.distance, rest_, power);
    };
    const Dioptre power = displaced_ + world.power * displacedWrong_;
    const double meant = blended ? magnification(eye_, assumed_.distance, rest_, displaced_) : 1.0,
                 s = magnification(eye_, world.distance, rest_, power);
    const Metre shift = 0.5 * std::abs(s - 1.0) * axesApart_ + std::abs(s - meant) * reach_ + abs(world.registration);
    return seamPart_ * seamOf(blended ? blending_.feather : 0.0_m, blended ? radius(assumed_, displaced_) : 0.0_m,
                              radius(world, power), shift);
}

std::optional<Metre> Subject::attendedTolerance() const {
    return attendedLight_ ? std::optional(attendedTolerance_) : std::nullopt;
}

Dioptre Subject::wrong(const Light& light) const {
    return errors_.power.value_or(Dioptre::fromSi(std::hypot(light.rmsError.si(), realEye_.si())));
}

}  // namespace ilf::prediction
