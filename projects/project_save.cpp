#include <signal.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <set>
#include <utility>

#include "projects/file_tree.h"
#include "projects/map_file.h"
#include "projects/project_extras.h"
#include "projects/project_file.h"
#include "projects/project_json.h"
#include "projects/safe_file.h"
#include "projects/wearer_rig_json.h"

namespace ilf::projects {
namespace {

constexpr std::size_t kBackups = 5;
const std::string kMapName = "rig-map.exr";
/// Pictures kept byte for byte: the current one and those undo may bring back.
constexpr std::size_t kOriginals = 4;

/// An id as a file name that every file system takes and that differs from others also where case does not count:
/// everything but small letters, digits, '-' and '_' becomes %xx.
std::string fileNameOf(const RegionId& id) {
    std::string name;
    for (const char c : id) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (byte >= 'a' && byte <= 'z') || (byte >= '0' && byte <= '9') || byte == '-' || byte == '_';
        if (plain) {
            name.push_back(c);
        } else {
            std::array<char, 4> code{};
            std::snprintf(code.data(), code.size(), "%%%02x", byte);
            name += code.data();
        }
    }
    return name;
}

/// File names have at most 255 bytes; ids that would be longer are numbered instead ('#' is in no other name).
std::string maskName(const RegionId& id, std::size_t index) {
    const std::string name = fileNameOf(id);
    return "masks/" + (name.size() > 200 ? "#" + std::to_string(index) : name) + ".png";
}

Box<std::string> boxed(std::string text) { return Box<std::string>(std::move(text)); }

/// The files of one version of a project, and the extras that go with them.
class Composing {
public:
    Composing(const Document& document, const ProjectExtras::State& before) : document_(document), state_(before) {}

    Result<void> run() {
        if (auto added =
                addPicture().and_then([&] { return addMasks(); }).and_then([&] { return addDepth(); }).and_then([&] {
                    return addMap();
                });
            !added) {
            return added;
        }
        names_.wearer = "wearer.json";
        names_.rig = "rig.json";
        state_.project = written(document_, names_, state_.project);
        state_.wearer = written(document_.wearer, state_.wearer);
        state_.rig = written(document_.rig, state_.rig, mapName_);
        add("project.json", boxed(state_.project.text()));
        add(names_.wearer, boxed(state_.wearer.text()));
        add(names_.rig, boxed(state_.rig.text()));
        return readsBack();
    }

    std::vector<TreeFile> files() const { return files_; }
    ProjectExtras::State& state() { return state_; }

private:
    void add(const std::string& name, Box<std::string> bytes) { files_.push_back({name, std::move(bytes)}); }

    Result<void> addPicture() {
        if (!document_.scene.picture) return {};
        const Picture& picture = *document_.scene.picture;
        auto original = std::find_if(state_.originals.begin(), state_.originals.end(),
                                     [&](const auto& known) { return known.picture.same(picture); });
        if (original == state_.originals.end()) {
            auto bytes = encodePicture(picture);
            if (!bytes) return tl::unexpected(bytes.error());
            state_.originals.insert(state_.originals.begin(), {picture, boxed(*std::move(bytes)), ".png"});
            state_.originals.resize(std::min(state_.originals.size(), kOriginals));
            original = state_.originals.begin();
        }
        names_.picture = "picture" + original->extension;
        add(names_.picture, original->bytes);
        return {};
    }

    Result<void> addMasks() {
        std::vector<ProjectExtras::State::EncodedMask> masks;
        for (std::size_t i = 0; i < document_.regions.size(); ++i) {
            const Region& region = *document_.regions[i];
            names_.masks.emplace_back();
            if (region.mask.empty()) continue;
            names_.masks.back() = maskName(region.id, i);
            const auto known = std::find_if(state_.masks.begin(), state_.masks.end(), [&](const auto& encoded) {
                return encoded.region == region.id && encoded.mask == region.mask;
            });
            if (known != state_.masks.end()) {
                masks.push_back(*known);
            } else {
                auto bytes = encodePng(toImage(region.mask));
                if (!bytes) return tl::unexpected(bytes.error());
                masks.push_back({region.id, region.mask, boxed(*std::move(bytes))});
            }
            add(names_.masks.back(), masks.back().bytes);
        }
        state_.masks = std::move(masks);
        return {};
    }

    /// Distances that follow from what was measured are worked out anew when the project is opened.
    Result<void> addDepth() {
        const Scene& scene = document_.scene;
        const auto addAs = [&](const char* name, const DepthMap& depth, EncodedDepth& kept) -> Result<std::string> {
            auto encoded = encodedDepth(depth, kept);
            if (!encoded) return tl::unexpected(encoded.error());
            kept = *std::move(encoded);
            const std::string file = name + kept.extension;
            add(file, kept.bytes);
            return file;
        };
        if (scene.measured) {
            const MeasuredDepth& m = *scene.measured;
            auto file = addAs("measured-depth", {m.metres, m.sigma, m.step}, state_.measured);
            if (!file) return tl::unexpected(file.error());
            names_.measured = *file;
        } else if (scene.depth && !scene.depth->metres.empty()) {
            auto file = addAs("depth", *scene.depth, state_.depth);
            if (!file) return tl::unexpected(file.error());
            names_.depth = *file;
        }
        return {};
    }

    /// The rig's scanned map. Encoded once: what is read back is the very numbers that were checked when they came in.
    Result<void> addMap() {
        const Box<Registration>& registration = document_.rig.registration;
        if (!registration || !registration->map.dense()) {
            state_.map = {};
            return {};
        }
        if (!state_.map.map.same(registration->map.dense())) {
            auto bytes = encodeMap(*registration->map.dense(), factsOf(*registration), MapFormat::exr);
            if (!bytes) return tl::unexpected(bytes.error());
            state_.map = {registration->map.dense(), boxed(*std::move(bytes))};
        }
        mapName_ = kMapName;
        add(mapName_, state_.map.bytes);
        return {};
    }

    /// What is about to be written can be read again; found out before the old version is touched.
    Result<void> readsBack() const {
        const std::string file = "the project as it would be saved";
        const auto words = [](const Error& error) {
            return fail(Fault::cannotWrite, error.what + " Nothing was saved; correct it and save again.");
        };
        const auto project = Json::parse(state_.project.text(), file).and_then([&](const Json& json) {
            return projectFrom(json, file);
        });
        if (!project) return words(project.error());
        const auto wearer = wearerFrom(state_.wearer, file);
        if (!wearer) return words(wearer.error());
        const auto rig =
            rigFrom(state_.rig, file, [&](const std::string&) -> Result<Box<DenseMap>> { return state_.map.map; });
        if (!rig) return words(rig.error());
        return {};
    }

    const Document& document_;
    ProjectExtras::State state_;
    ProjectNames names_;
    std::string mapName_;
    std::vector<TreeFile> files_;
};

/// One file of `tree` that is not ours goes along: into the fresh folder, or into the list of files to zip.
Result<void> carryFile(const FileTree& tree, const fs::path& origin, const std::string& name, const fs::path& fresh,
                       std::vector<TreeFile>& files, bool zip) {
    const fs::path to = fresh / name;
    const auto intoFolder = [&](const auto& put) { return makeFolders(to.parent_path()).and_then(put); };
    if (!zip && !tree.zipped()) return intoFolder([&] { return linkTree(origin / name, to); });
    auto bytes = tree.read(name);
    if (!bytes) return tl::unexpected(bytes.error());
    if (!zip) return intoFolder([&] { return writeNew(to, *bytes); });
    files.push_back({name, boxed(*std::move(bytes))});
    return {};
}

/// What lies beside our files in the project at `origin` goes along; hidden files (.git) only when the place is the
/// same.
Result<void> carryOtherFiles(const fs::path& origin, const fs::path& target, const fs::path& fresh,
                             std::vector<TreeFile>& files) {
    std::error_code ignored;
    if (origin.empty() || !fs::exists(origin, ignored)) return {};
    const auto tree = openTree(origin, "project.json");
    if (!tree) return {};  // moved or broken since; what is in memory is saved nevertheless
    std::set<std::string> skipped;
    const auto json = (*tree)->read("project.json").and_then([](const std::string& text) {
        return Json::parse(text, "project.json");
    });
    if (json) skipped = filesNamedIn(*json);
    skipped.insert(kMapName);
    for (const TreeFile& file : files)
        skipped.insert(file.name);
    const bool samePlace = fs::equivalent(origin, target, ignored);
    const bool zip = target.extension() == ".ilf";
    for (const std::string& name : (*tree)->names()) {
        if (!staysInside(name) || skipped.count(name) != 0 || (!samePlace && name.starts_with("."))) continue;
        if (auto carried = carryFile(**tree, origin, name, fresh, files, zip); !carried) return carried;
    }
    return {};
}

Result<void> checkedTarget(const fs::path& target) {
    const std::string extension = target.extension().string();
    if (extension != ".ilfd" && extension != ".ilf") {
        return fail(Fault::cannotWrite,
                    spoken(target) + " needs a name that ends in .ilfd (a folder) or .ilf (one file).");
    }
    std::error_code error;
    if (!fs::exists(target, error)) return {};
    const bool folder = fs::is_directory(target, error);
    if (folder != (extension == ".ilfd")) {
        return fail(Fault::cannotWrite,
                    spoken(target) + (folder ? " is a folder" : " is a file") + " already. Choose another name.");
    }
    if (folder && !fs::is_empty(target, error) && !fs::exists(target / "project.json", error)) {
        return fail(Fault::cannotWrite, spoken(target) + " is a folder with other things in it. Choose another name.");
    }
    return {};
}

fs::path backupFolder(const fs::path& target) {
    fs::path folder = target;
    folder += ".backups";
    return folder;
}

/// "2026-01-31T09-30-00.123456Z": names that sort by time.
std::string stamp(std::chrono::system_clock::time_point time) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count() % 1'000'000;
    std::tm utc{};
    gmtime_r(&seconds, &utc);
    std::array<char, 48> text{};
    const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H-%M-%S", &utc);
    std::snprintf(text.data() + length, text.size() - length, ".%06dZ", static_cast<int>(us));
    return text.data();
}

/// What is at `target` also becomes a backup, complete before it gets its name.
Result<void> backUp(const fs::path& target) {
    std::error_code ignored;
    if (!fs::exists(target, ignored) || (fs::is_directory(target, ignored) && fs::is_empty(target, ignored))) return {};
    const fs::path folder = backupFolder(target);
    if (auto made = makeFolders(folder); !made) return made;
    auto time = std::chrono::system_clock::now();
    const auto named = [&] { return folder / (stamp(time) + target.extension().string()); };
    while (fs::exists(named(), ignored))
        time += std::chrono::microseconds(1);
    const fs::path backup = named();
    const fs::path partial = siblingOf(backup, "new");
    auto done = linkTree(target, partial).and_then([&] { return putInPlace(partial, backup).map([](const auto&) {}); });
    if (!done) removeQuietly(partial);
    return done;
}

void tidy(const fs::path& target) {
    const std::vector<fs::path> backups = backupsOf(target);
    for (std::size_t i = kBackups; i < backups.size(); ++i)
        removeQuietly(backups[i]);
    // What saves that were cut short left behind: hidden siblings that name a process which is no more.
    for (const fs::path& folder : {target.parent_path(), backupFolder(target)}) {
        std::error_code error;
        for (const auto& entry : fs::directory_iterator(folder, error)) {
            const std::string name = entry.path().filename().string();
            const bool ours = name.starts_with("." + target.filename().string() + ".") ||
                              (folder != target.parent_path() && name.starts_with("."));
            std::size_t at = name.rfind(".new-");
            if (at == std::string::npos) at = name.rfind(".old-");
            if (!ours || at == std::string::npos) continue;
            const int pid = std::atoi(name.c_str() + at + 5);
            if (pid > 0 && ::kill(pid, 0) != 0 && errno == ESRCH) removeQuietly(entry.path());
        }
    }
}

}  // namespace

ProjectExtras::ProjectExtras() : state_(std::make_shared<State>()) {}

ProjectExtras ProjectExtras::withOriginal(const PictureFile& file) const {
    State state = *state_;
    state.originals.insert(state.originals.begin(), {file.picture, file.bytes, file.extension});
    state.originals.resize(std::min(state.originals.size(), kOriginals));
    return ProjectExtras(std::make_shared<State>(std::move(state)));
}

Result<ProjectExtras> saveProject(const fs::path& path, const Document& document, const ProjectExtras& extras,
                                  Backups backups, OtherFiles otherFiles) {
    std::error_code ignored;
    const fs::path target =
        fs::weakly_canonical(fs::absolute(path.has_filename() ? path : path.parent_path()), ignored);
    if (auto good = checkedTarget(target); !good) return tl::unexpected(good.error());
    Composing composing(document, extras.state());
    if (auto composed = composing.run(); !composed) return tl::unexpected(composed.error());

    const bool zip = target.extension() == ".ilf";
    const fs::path fresh = siblingOf(target, "new");
    std::vector<TreeFile> files = composing.files();
    fs::path old;
    const auto saved =
        makeFolders(target.parent_path())
            .and_then([&] { return zip ? Result<void>() : writeFolder(fresh, files); })
            .and_then([&] {
                const bool carries = otherFiles == OtherFiles::carry;
                return carries ? carryOtherFiles(extras.state().origin, target, fresh, files) : Result<void>();
            })
            .and_then([&] { return zip ? writeZip(fresh, files) : Result<void>(); })
            .and_then([&] { return backups == Backups::keep ? backUp(target) : Result<void>(); })
            .and_then([&] { return putInPlace(fresh, target).map([&](const fs::path& replaced) { old = replaced; }); });
    if (!saved) {
        removeQuietly(fresh);
        return tl::unexpected(saved.error());
    }
    // From here on the new version is the project; what fails now is only less tidy.
    const auto durable = syncFolder(target.parent_path());
    removeQuietly(old);
    if (backups == Backups::keep) tidy(target);
    if (!durable) {
        return fail(Fault::cannotWrite, spoken(target) + " was saved, but the disk did not confirm it. Save again.");
    }
    // An autosave is a copy beside: what lies with the project stays with the project.
    if (otherFiles == OtherFiles::carry) composing.state().origin = target;
    return ProjectExtras(std::make_shared<ProjectExtras::State>(std::move(composing.state())));
}

std::vector<fs::path> backupsOf(const fs::path& path) {
    std::vector<fs::path> backups;
    std::error_code error;
    const fs::path target = fs::absolute(path.has_filename() ? path : path.parent_path(), error);
    for (const auto& entry : fs::directory_iterator(backupFolder(target), error)) {
        const std::string extension = entry.path().extension().string();
        const bool ours = extension == ".ilfd" || extension == ".ilf";
        if (ours && !entry.path().filename().string().starts_with(".")) backups.push_back(entry.path());
    }
    std::sort(backups.begin(), backups.end(), std::greater<>());
    return backups;
}

}  // namespace ilf::projects
