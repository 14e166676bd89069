#include "core/perceived/prediction.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/perceived/prediction_subject.h"
#include "core/plan/notes.h"

namespace ilf {
namespace {

using prediction::Eyes;
using prediction::Subject;
using prediction::World;

/// Between the assumed value and the end of its range this many points are looked at.
constexpr int kPoints = 4;
constexpr Metre kNearest = 1.0_mm;

double squared(double v) { return v * v; }

/// The figures of one region in one world.
struct Figures {
    enum Name { blur, defocus, snellen, contrast, contrastLooked, snellenLooked, ambientLeak, seam, count };
    std::array<double, count> of{};
};

Figures figures(Subject& subject, const World& world, Look look) {
    const bool blurred = look == Look::blur;
    const Eyes eyes = blurred ? Eyes::aside : Eyes::on;
    Figures f;
    const double defocus = subject.defocusOf(world, eyes), disc = world.pupil.si() * defocus;
    const Subject::Contrast left = subject.contrast(world, eyes);
    f.of[Figures::blur] = disc / kArcmin;
    f.of[Figures::defocus] = defocus;
    f.of[Figures::snellen] = f.of[Figures::snellenLooked] = snellenOf(disc);
    f.of[Figures::contrast] = f.of[Figures::contrastLooked] = left.ambient;
    f.of[Figures::ambientLeak] = left.ambient - left.dark;
    if (blurred) {
        f.of[Figures::contrastLooked] =
            std::max(subject.contrast(world, Eyes::relaxed).ambient, subject.contrast(world, Eyes::on).ambient);
        f.of[Figures::snellenLooked] = snellenOf(
            world.pupil.si() * std::min(subject.defocusOf(world, Eyes::relaxed), subject.defocusOf(world, Eyes::on)));
    }
    if (subject.seams()) f.of[Figures::seam] = subject.seam(world);
    return f;
}

using Step = std::function<void(World&, double)>;

/// What moving one thing to both ends of its range does to each figure, at most.
Figures farthest(Subject& subject, Look look, const Figures& nominal, const Step& step) {
    Figures most;
    for (int i = -kPoints; i <= kPoints; ++i) {
        if (i == 0) continue;
        World world = subject.assumed();
        step(world, static_cast<double>(i) / kPoints);
        const Figures f = figures(subject, world, look);
        for (std::size_t k = 0; k < most.of.size(); ++k)
            most.of[k] = std::max(most.of[k], std::abs(f.of[k] - nominal.of[k]));
    }
    return most;
}

}  // namespace

const char* word(ErrorSource source) {
    switch (source) {
    case ErrorSource::distance:
        return "distance";
    case ErrorSource::pupil:
        return "pupil";
    case ErrorSource::registration:
        return "registration";
    case ErrorSource::model:
        break;
    }
    return "model";
}

double Predicted::error() const {
    return std::sqrt(std::accumulate(from.begin(), from.end(), 0.0, [](double s, double v) { return s + squared(v); }));
}

double Predicted::share(ErrorSource source) const {
    const double all = squared(error());
    return all > 0.0 ? squared(part(source)) / all : 0.0;
}

Dioptre realEyeError(Metre pupil) {
    struct Row {
        double millimetres, dioptres;
    };
    constexpr std::array<Row, 6> kRows{
        {{2.0, 0.021}, {3.0, 0.048}, {4.0, 0.085}, {5.0, 0.132}, {6.0, 0.231}, {8.0, 0.534}}};
    const double mm = std::clamp(pupil.in(1.0_mm), kRows.front().millimetres, kRows.back().millimetres);
    std::size_t i = 1;
    while (i + 1 < kRows.size() && kRows[i].millimetres < mm)
        ++i;
    const Row &a = kRows[i - 1], &b = kRows[i];
    return Dioptre::fromSi(std::lerp(a.dioptres, b.dioptres, (mm - a.millimetres) / (b.millimetres - a.millimetres)));
}

Legibility legibility(const RegionPrediction& seen) {
    if (seen.camera) return Legibility::visibleToCamera;
    const double aside = seen.contrast.value + seen.contrast.error();
    if (aside > kReadsPrint) return Legibility::readable;
    if (aside > kHidesPrint) return Legibility::doubtful;
    return seen.contrastLooked.value + seen.contrastLooked.error() > kHidesPrint ? Legibility::hiddenAside
                                                                                 : Legibility::hidden;
}

double snellenOf(double blur) { return 20.0 * std::hypot(1.0, 650.0 * blur); }

RegionPrediction predicted(const Plan& plan, const RegionPlan& region, const Document& document,
                           const PredictionErrors& errors) {
    Subject subject(plan, region, document, errors);
    const Figures nominal = figures(subject, subject.assumed(), region.look);
    std::array<Predicted, Figures::count> all;
    for (std::size_t k = 0; k < all.size(); ++k)
        all[k].value = nominal.of[k];
    const auto add = [&](ErrorSource source, const Step& step) {
        const Figures most = farthest(subject, region.look, nominal, step);
        for (std::size_t k = 0; k < all.size(); ++k) {
            double& part = all[k].from[static_cast<std::size_t>(source)];
            part = std::hypot(part, most.of[k]);
        }
    };
    if (subject.tolerance() > 0.0_m) {
        add(ErrorSource::distance,
            [&](World& w, double t) { w.distance = std::max(kNearest, w.distance + t * subject.tolerance()); });
    }
    const auto attended = subject.attendedTolerance();
    if (region.look == Look::blur && attended) {
        if (*attended > 0.0_m) {
            add(ErrorSource::distance,
                [&](World& w, double t) { w.attended = std::max(kNearest, w.attended + t * *attended); });
        }
        add(ErrorSource::model, [](World& w, double t) { w.attendedPower = t; });
    }
    add(ErrorSource::model, [](World& w, double t) { w.power = t; });
    if (!subject.camera() && errors.pupil > 0.0_m) {
        add(ErrorSource::pupil,
            [&](World& w, double t) { w.pupil = std::max(0.1 * w.pupil, w.pupil + t * errors.pupil); });
    }
    if (subject.seams()) {
        World shifted = subject.assumed();
        shifted.registration = subject.registration();
        all[Figures::seam].from[static_cast<std::size_t>(ErrorSource::registration)] =
            std::abs(subject.seam(shifted) - nominal.of[Figures::seam]);
    }

    RegionPrediction p;
    p.id = region.id;
    p.look = region.look;
    p.distance = subject.assumed().distance;
    p.camera = subject.camera();
    p.blur_arcmin = all[Figures::blur];
    p.defocus_D = all[Figures::defocus];
    p.snellen = all[Figures::snellen];
    p.contrast = all[Figures::contrast];
    p.contrastLooked = all[Figures::contrastLooked];
    p.snellenLooked = all[Figures::snellenLooked];
    p.ambientLeak = all[Figures::ambientLeak];
    p.seam = all[Figures::seam];
    p.registration = subject.registration();
    p.seams = subject.seams();
    p.light = plan.light;
    p.sharpShare = subject.sharpShare(subject.assumed(), region.look == Look::blur ? Eyes::aside : Eyes::on);
    p.print = legibility(p);
    return p;
}

}  // namespace ilf
