// One region as an eye meets it, with everything about it that may be wrong: what predictions are made of.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/perceived/prediction.h"

namespace ilf::prediction {

/// All that may be wrong, at one value of each. `power` and `attendedPower` are in parts of their errors, -1 to 1.
struct World {
    Metre distance, attended;
    Metre pupil;
    double power = 0.0, attendedPower = 0.0;
    Metre registration;
};

/// What the eye does about the region.
enum class Eyes {
    aside,    ///< holds what it attends sharp, or is relaxed where there is nothing
    relaxed,  ///< looks at it and lets go: the least blur of what lies beyond the far border
    on,       ///< looks at it through the power it is sharp at, or the lens's rest, as far as it can accommodate
};

class Subject {
public:
    Subject(const Plan& plan, const RegionPlan& region, const Document& document, const PredictionErrors& errors);

    const World& assumed() const { return assumed_; }
    Metre tolerance() const { return tolerance_; }
    /// Of what the eye attends; nothing where it attends nothing.
    std::optional<Metre> attendedTolerance() const;
    bool camera() const { return scratch_.input.camera; }

    /// |E| of its most defocused light, dioptres.
    double defocusOf(const World& world, Eyes eyes) const;
    struct Contrast {
        double ambient = 0.0, dark = 0.0;
    };
    Contrast contrast(const World& world, Eyes eyes);
    /// Share of its light within the acceptable defocus.
    double sharpShare(const World& world, Eyes eyes) const;
    bool seams() const { return seamPart_ > 0.0; }
    Metre registration() const { return registration_; }
    double seam(const World& world) const;

private:
    /// One part of a region's light.
    struct Light {
        Dioptre power, rmsError;
        double share = 1.0;
    };
    static Light lightAt(const Plan& plan, const RegionPlan& region);
    void findLight(const Plan& plan, const RegionPlan& region);
    void findPlace(const Plan& plan, const RegionPlan& region, const Document& document);
    void findSeam(const Plan& plan, const RegionPlan& region, const Document& document);
    EyeOptics eyeFor(const World& world, Eyes eyes) const;
    Dioptre wrong(const Light& light) const;
    Dioptre powerOf(const Light& light, const World& world) const { return light.power + world.power * wrong(light); }

    Plan scratch_;  ///< what contrastLeft is asked with; without regions, since `eyeFor` holds what the eye attends
    RegionPlan region_;
    EyeOptics eye_;
    PredictionErrors errors_;
    std::vector<Light> lights_;
    std::optional<Light> attendedLight_;
    World assumed_;
    Metre tolerance_, attendedTolerance_, registration_;
    Dioptre through_, rest_, realEye_;

    Seam blending_;
    Dioptre displaced_, displacedWrong_;  ///< the power whose light meets that at rest
    double seamPart_ = 0.0;               ///< share of the light there that is displaced; 0: no seam
    Metre axesApart_, reach_;             ///< between the lens axes; from their middle to the region's farthest corner
};

}  // namespace ilf::prediction
