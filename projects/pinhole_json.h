// Pinholes and poses, to JSON and back: for projects, rigs and calibrations.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/registration/pinhole.h"
#include "projects/json.h"

namespace ilf::projects {

/// `unit` ends the keys of what is in pixels: "_px" in calibrations; in projects the object's own name says it.
Json written(const Pinhole& pinhole, const std::string& unit, Json before);
Pinhole pinholeFrom(JsonReader reader, const std::string& unit);

template <class To, class From>
Json written(const Pose<To, From>& pose, Json before) {
    before.set("rotation", std::vector<double>(pose.rotation.begin(), pose.rotation.end()));
    before.set("translation_m", std::vector<double>(pose.translation.begin(), pose.translation.end()));
    return before;
}

template <class To, class From>
Pose<To, From> poseFrom(JsonReader& reader) {
    Pose<To, From> pose;
    std::ranges::copy(reader.numbers("rotation", pose.rotation.size()), pose.rotation.begin());
    std::ranges::copy(reader.numbers("translation_m", pose.translation.size()), pose.translation.begin());
    return pose;
}

}  // namespace ilf::projects
