#include "projects/recent.h"

#include <algorithm>

#include "projects/json.h"
#include "projects/safe_file.h"
#include "projects/xdg.h"

namespace ilf::projects {
namespace {

const char* const kListFormat = "illuminatedfocus-recent";
constexpr std::size_t kMostOfList = std::size_t{1} << 20;

fs::path listFile() { return stateDir() / "recent.json"; }

fs::path settled(const fs::path& path) {
    std::error_code ignored;
    return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
}

Result<void> write(const std::vector<RecentProject>& projects) {
    Json json;
    json.set("format", std::string(kListFormat));
    json.set("version", 1);
    std::vector<Json> list;
    for (const RecentProject& project : projects) {
        Json item;
        item.set("path", project.path.string());
        item.set("name", project.name);
        list.push_back(item);
    }
    json.set("projects", list);
    return makeFolders(stateDir()).and_then([&] { return writeAtomically(listFile(), json.text()); });
}

std::vector<RecentProject> without(std::vector<RecentProject> projects, const fs::path& path) {
    std::erase_if(projects, [&](const RecentProject& project) { return project.path == path; });
    return projects;
}

}  // namespace

std::vector<RecentProject> recentProjects() {
    std::vector<RecentProject> projects;
    const auto json = readWhole(listFile(), kMostOfList).and_then([](const std::string& text) {
        return Json::parse(text, "recent.json");
    });
    if (!json || json->word("format") != kListFormat) return projects;
    for (const Json& item : json->objects("projects")) {
        const fs::path path = item.word("path");
        std::error_code ignored;
        if (!path.empty()) projects.push_back({path, item.word("name"), !fs::exists(path, ignored)});
    }
    return projects;
}

Result<void> rememberProject(const fs::path& path, const std::string& name) {
    std::vector<RecentProject> projects = without(recentProjects(), settled(path));
    projects.insert(projects.begin(), {settled(path), name, false});
    projects.resize(std::min(projects.size(), kMostRecent));
    return write(projects);
}

Result<void> forgetProject(const fs::path& path) { return write(without(recentProjects(), settled(path))); }

}  // namespace ilf::projects
