#include "devices/plugin/loaded_plugin.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "devices/plugin/plugin_words.h"

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kMostPlaces = 16;
constexpr std::size_t kLongestName = 200;  // of a plugin; what is longer is no name

/// The first of `file` and the folders above it that everybody may write. A folder like /tmp, where only a file's owner
/// may replace it (sticky), is none.
std::optional<fs::path> writableByAll(const fs::path& file) {
    for (fs::path at = file;; at = at.parent_path()) {
        const auto may = fs::status(at).permissions();
        const bool sticky = (may & fs::perms::sticky_bit) != fs::perms::none && at != file;
        if ((may & fs::perms::others_write) != fs::perms::none && !sticky) return at;
        if (at == at.parent_path()) return std::nullopt;
    }
}

}  // namespace

Result<ProjectorPlugin> ProjectorPlugin::load(const fs::path& file) try {
    const std::string named = "The projector plugin " + file.string();
    if (!file.is_absolute())
        return fail(Fault::unsafe, named + " is not named by its whole path, and plugins are searched for nowhere; "
                                           "write the path from / on into the rig file.");
    std::error_code trouble;
    const fs::path real = fs::canonical(file, trouble);
    if (trouble || !fs::is_regular_file(real))
        return fail(Fault::notFound, named + " is not there; check the path in the rig file.");
    if (const auto open = writableByAll(real))
        return fail(Fault::unsafe, named + " is not loaded, since everybody may write " + open->string() +
                                       "; take that right away (chmod o-w), or put the plugin elsewhere.");
    // All symbols now, so that what is missing is told here and not in the middle of a show; none for others to find.
    void* library = dlopen(real.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr)
        return fail(Fault::badFile, named + " cannot be loaded (" + pluginText(dlerror(), kLongestName) +
                                        "); install what it needs, or build it for this machine.");
    auto entry = reinterpret_cast<ilf_projector_plugin_entry>(dlsym(library, ILF_PROJECTOR_PLUGIN_ENTRY));
    return from(entry, file.string());
} catch (const fs::filesystem_error& error) {
    return fail(Fault::notFound, "The projector plugin " + file.string() + " cannot be looked at (" +
                                     error.code().message() + "); check the path and its rights.");
}

Result<ProjectorPlugin> ProjectorPlugin::from(ilf_projector_plugin_entry entry, std::string file) {
    const std::string named = "The projector plugin " + file;
    if (entry == nullptr)
        return fail(Fault::badFile, named + " has no " ILF_PROJECTOR_PLUGIN_ENTRY
                                            "(), so it is a library for something else; name another file.");
    const ilf_projector_plugin_v1* table = nullptr;
    try {
        table = entry(ILF_PROJECTOR_PLUGIN_VERSION);
    } catch (...) {
        return fail(Fault::badFile, named + " threw an exception when it was asked what it is; tell its author.");
    }
    if (table == nullptr)
        return fail(Fault::unsupported,
                    named + " does not know version 1 of what plugins are asked; get one that does.");
    if (table->version != ILF_PROJECTOR_PLUGIN_VERSION)
        return fail(Fault::unsupported, named + " is of version " + std::to_string(table->version) +
                                            ", this program asks version 1; get the plugin for this program.");
    if (table->struct_size < sizeof(ilf_projector_plugin_v1))
        return fail(Fault::unsupported, named + " has a table of " + std::to_string(table->struct_size) +
                                            " bytes, not " + std::to_string(sizeof(ilf_projector_plugin_v1)) +
                                            "; build it again with this program's header.");
    const ilf_projector_plugin_v1& t = *table;
    const std::array<std::pair<const char*, bool>, 13> there{{{"name", t.name != nullptr},
                                                              {"plugin_version", t.plugin_version != nullptr},
                                                              {"list", t.list != nullptr},
                                                              {"open", t.open != nullptr},
                                                              {"close", t.close != nullptr},
                                                              {"describe", t.describe != nullptr},
                                                              {"configure", t.configure != nullptr},
                                                              {"upload", t.upload != nullptr},
                                                              {"swap", t.swap != nullptr},
                                                              {"start", t.start != nullptr},
                                                              {"stop", t.stop != nullptr},
                                                              {"steady_white", t.steady_white != nullptr},
                                                              {"status", t.status != nullptr}}};
    for (const auto& [part, present] : there)
        if (!present)
            return fail(Fault::badFile, named + " lacks \"" + part + "\", which every plugin needs; tell its author.");
    ProjectorPlugin plugin;
    std::memcpy(&plugin.calls_, table, sizeof plugin.calls_);  // a copy: it must not change under our feet
    plugin.name_ = pluginText(t.name, kLongestName) + " " + pluginText(t.plugin_version, kLongestName);
    plugin.triedOn_ = pluginText(t.tried_on, kLongestName);
    if (plugin.triedOn_.empty()) plugin.triedOn_ = "no hardware";
    plugin.file_ = std::move(file);
    return plugin;
}

std::string ProjectorPlugin::name() const { return name_ + " (" + fs::path(file_).filename().string() + ")"; }

Result<std::vector<ProjectorPlugin::Place>> ProjectorPlugin::list(const Clock& clock) const {
    constexpr Second kLongest = 10.0_s;
    std::array<ilf_place, kMostPlaces> places{};
    std::uint32_t count = 0;
    ilf_message message{};
    const auto begun = clock.now();
    ilf_code code = ILF_FAILED;
    try {
        code = calls_.list(places.data(), kMostPlaces, &count, &message);
    } catch (...) {
        return fail(Fault::device, name() + " threw an exception when asked for its projectors; tell its author.");
    }
    if (code != ILF_OK) return tl::unexpected(pluginError(name(), "list its projectors", code, message));
    const auto took = Second::fromSi(std::chrono::duration<double>(clock.now() - begun).count());
    if (took > kLongest)
        return fail(Fault::device, name() + " " + tookTooLong("list its projectors", took, kLongest) + ".");
    std::vector<Place> found;
    found.reserve(kMostPlaces);
    for (std::uint32_t i = 0; i < std::min(count, kMostPlaces); ++i)
        found.push_back(
            {pluginText(places[i].id, sizeof places[i].id), pluginText(places[i].name, sizeof places[i].name)});
    return found;
}

}  // namespace ilf::devices
