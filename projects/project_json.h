// A document without its pixels to project.json and back.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/document/document.h"
#include "projects/json.h"

namespace ilf::projects {

inline constexpr int kProjectVersion = 2;  ///< 2: measured depth, the viewer's pose, what regions follow

/// Names of the files that hold what project.json does not; empty: there is none.
struct ProjectNames {
    std::string picture, depth, measured, wearer, rig;
    std::vector<std::string> masks;  ///< one for each region
};

/// `before` is what project.json held: keys that this version does not know are kept at every level.
Json written(const Document& document, const ProjectNames& names, Json before);

/// What project.json says. The document has no picture, depth or masks yet, and the default wearer and rig.
struct ProjectText {
    Document document;
    ProjectNames names;
    Metre depthStep;         ///< 0: the file is in metres
    MeasuredDepth measured;  ///< all but its pixels
};
Result<ProjectText> projectFrom(const Json& json, const std::string& file);

/// Names of all files a project.json speaks of, itself included; other files in its folder are somebody else's.
std::set<std::string> filesNamedIn(const Json& json);

}  // namespace ilf::projects
