// The projects last opened or saved, newest first, in the state folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace ilf::projects {

struct RecentProject {
    std::filesystem::path path;
    std::string name;      ///< the document's
    bool missing = false;  ///< not there now (a stick that is unplugged): kept in the list, but marked
    bool operator==(const RecentProject&) const = default;
};

inline constexpr std::size_t kMostRecent = 20;

/// A list that is damaged or not there is an empty one: it is not worth a question at the start.
std::vector<RecentProject> recentProjects();
/// Puts a project on top, once.
Result<void> rememberProject(const std::filesystem::path& path, const std::string& name);
Result<void> forgetProject(const std::filesystem::path& path);

}  // namespace ilf::projects
