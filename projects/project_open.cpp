#include <utility>

#include "core/document/edit.h"
#include "projects/file_tree.h"
#include "projects/map_file.h"
#include "projects/project_extras.h"
#include "projects/project_file.h"
#include "projects/project_json.h"
#include "projects/safe_file.h"
#include "projects/wearer_rig_json.h"

namespace ilf::projects {
namespace {

const char* const kProjectJson = "project.json";

std::string sizeWords(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

/// A JSON file of the tree.
Result<Json> readJson(const FileTree& tree, const std::string& name) {
    return tree.read(name).and_then([&](const std::string& text) { return Json::parse(text, tree.spokenName(name)); });
}

/// Reads one project, step by step.
class Opening {
public:
    explicit Opening(const FileTree& tree) : tree_(tree) {}

    Result<OpenedProject> run() {
        return readText()
            .and_then([&] { return readPixels(); })
            .and_then([&] { return readPeople(); })
            .and_then([&] { return findDistances(); })
            .and_then([&] { return checkNumbers(); })
            .map([&] {
                return OpenedProject{document(), ProjectExtras(std::make_shared<ProjectExtras::State>(state_))};
            });
    }

    ProjectExtras::State& state() { return state_; }

private:
    Document& document() { return text_.document; }

    Result<void> readText() {
        auto json = readJson(tree_, kProjectJson);
        if (!json) return tl::unexpected(json.error());
        auto text = projectFrom(*json, tree_.spokenName(kProjectJson));
        if (!text) return tl::unexpected(text.error());
        state_.project = *std::move(json);
        text_ = *std::move(text);
        return {};
    }

    Result<void> readPixels() {
        if (!text_.names.picture.empty()) {
            if (auto read = readScenePicture(); !read) return read;
        }
        for (std::size_t i = 0; i < document().regions.size(); ++i) {
            if (auto read = readMaskOf(i); !read) return read;
        }
        return readDepth();
    }

    Result<void> readScenePicture() {
        const std::string& name = text_.names.picture;
        auto bytes = tree_.read(name);
        if (!bytes) return tl::unexpected(bytes.error());
        auto file = decodePicture(Box<std::string>(*std::move(bytes)), tree_.spokenName(name));
        if (!file) return tl::unexpected(file.error());
        state_.originals.push_back({file->picture, file->bytes, file->extension});
        document().scene.picture = Box<Picture>(std::move(file->picture));
        return {};
    }

    Result<void> readMaskOf(std::size_t index) {
        const std::string& name = text_.names.masks[index];
        Region region = *document().regions[index];
        const Size size = document().scene.size();
        if (name.empty()) {
            region.mask = Mask(size);
        } else {
            auto bytes = tree_.read(name);
            if (!bytes) return tl::unexpected(bytes.error());
            const auto image = decodeMask(*bytes, tree_.spokenName(name));
            if (!image) return tl::unexpected(image.error());
            if (image->size() != size) return wrongSize(name, "the mask of \"" + region.name + "\"", image->size());
            region.mask = toTiles(*image);
            state_.masks.push_back({region.id, region.mask, Box<std::string>(*std::move(bytes))});
        }
        document().regions[index] = Box<Region>(std::move(region));
        return {};
    }

    /// A file of depth, and what it is kept as for the next save.
    Result<DepthMap> readDepthFile(const std::string& name, Metre step, EncodedDepth& kept) {
        auto bytes = tree_.read(name);
        if (!bytes) return tl::unexpected(bytes.error());
        auto depth = decodedDepth(*bytes, tree_.spokenName(name), step);
        if (!depth) return depth;
        if (depth->metres.size() != document().scene.size()) {
            return tl::unexpected(wrongSize(name, "the depth map", depth->metres.size()).error());
        }
        kept = {*depth, Box<std::string>(*std::move(bytes)), std::filesystem::path(name).extension().string()};
        return depth;
    }

    Result<void> readDepth() {
        if (!text_.names.depth.empty()) {
            auto depth = readDepthFile(text_.names.depth, text_.depthStep, state_.depth);
            if (!depth) return tl::unexpected(depth.error());
            document().scene.depth = Box<DepthMap>(*std::move(depth));
        }
        if (!text_.names.measured.empty()) {
            auto depth = readDepthFile(text_.names.measured, text_.measured.step, state_.measured);
            if (!depth) return tl::unexpected(depth.error());
            text_.measured.metres = std::move(depth->metres);
            text_.measured.sigma = std::move(depth->sigma);
        }
        return {};
    }

    /// Distances from what was measured, once it is known who looks.
    Result<void> findDistances() {
        const auto refused = [&](const Error& error) {
            return fail(Fault::badFile, tree_.spokenName(kProjectJson) + ": " + error.what);
        };
        auto placed = edited(document(), SetViewerPose{document().scene.viewer});
        if (!placed) return refused(placed.error());
        if (text_.measured.metres.empty()) return {};
        auto found = edited(document(), SetMeasuredDepth{Box<MeasuredDepth>(text_.measured)});
        if (!found) return refused(found.error());
        document() = *std::move(found);
        return {};
    }

    Result<void> readPeople() {
        const std::string& wearerName = text_.names.wearer;
        if (!wearerName.empty()) {
            auto json = readJson(tree_, wearerName);
            if (!json) return tl::unexpected(json.error());
            auto wearer = wearerFrom(*json, tree_.spokenName(wearerName));
            if (!wearer) return tl::unexpected(wearer.error());
            document().wearer = *std::move(wearer);
            state_.wearer = *std::move(json);
        }
        const std::string& rigName = text_.names.rig;
        if (!rigName.empty()) {
            auto json = readJson(tree_, rigName);
            if (!json) return tl::unexpected(json.error());
            const MapReader inTree = [&](const std::string& name) -> Result<Box<DenseMap>> {
                auto bytes = tree_.read(name);
                if (!bytes) return tl::unexpected(bytes.error());
                auto file = decodeMap(*bytes, tree_.spokenName(name));
                if (!file) return tl::unexpected(file.error());
                state_.map = {Box<DenseMap>(std::move(file->map)), Box<std::string>(*std::move(bytes))};
                return state_.map.map;
            };
            auto rig = rigFrom(*json, tree_.spokenName(rigName), inTree);
            if (!rig) return tl::unexpected(rig.error());
            document().rig = *std::move(rig);
            state_.rig = *std::move(json);
        }
        return {};
    }

    /// A file holds what an operator could have typed: every number goes through the edit that would set it.
    Result<void> checkNumbers() {
        const std::string file = tree_.spokenName(kProjectJson);
        const auto refused = [&](const Error& error) { return fail(Fault::badFile, file + ": " + error.what); };
        const auto possible = [&](const Edit& edit) -> Result<void> {
            const auto next = edited(document(), edit);
            return next ? Result<void>() : Result<void>(refused(next.error()));
        };
        auto well = possible(SetSeam{document().seam}).and_then([&] { return possible(SetAlpha{document().alpha}); });
        if (!well) return well;
        // A picture without a scale gets the default field of view, as a new one does.
        if (document().scene.scale.focalPixels == 0.0) {
            document().scene.scale = newDocument(document().scene).scene.scale;
        } else if (auto scale = possible(SetPixelScale{document().scene.scale}); !scale) {
            return scale;
        }
        std::vector<const Region*> regions{&*document().background};
        for (const auto& region : document().regions)
            regions.push_back(&*region);
        for (const Region* region : regions) {
            if (auto good = checked(region->distance, "the distance of \"" + region->name + "\""); !good) {
                return refused(good.error());
            }
            if (region->follow) {
                if (auto good = checked(*region->follow, document().scene.size()); !good) {
                    return refused({Fault::outOfRange, "region \"" + region->name + "\": " + good.error().what});
                }
            }
            if (!region->strength) continue;
            // Through the background of an empty document: a region that is locked refuses edits.
            Document probe = newDocument({});
            const auto next = edited(probe, SetStrength{kBackgroundId, region->strength});
            if (!next) return refused({Fault::outOfRange, "region \"" + region->name + "\": " + next.error().what});
        }
        return {};
    }

    Result<void> wrongSize(const std::string& name, const std::string& what, Size size) {
        return fail(Fault::badFile, tree_.spokenName(name) + ", " + what + ", has " + sizeWords(size) +
                                        " pixels, but the picture has " + sizeWords(document().scene.size()) +
                                        ". Restore the file, or take a backup.");
    }

    const FileTree& tree_;
    ProjectExtras::State state_;
    ProjectText text_;
};

}  // namespace

Result<OpenedProject> openProject(const fs::path& path) {
    fs::path root = path.has_filename() ? path : path.parent_path();
    if (root.filename() == kProjectJson) root = root.parent_path().empty() ? fs::path(".") : root.parent_path();
    auto tree = openTree(root, kProjectJson);
    if (!tree) {
        const std::vector<fs::path> backups = backupsOf(root);
        if (backups.empty()) return tl::unexpected(tree.error());
        return fail(tree.error().fault, tree.error().what + " Its newest backup is " + spoken(backups.front()) + ".");
    }
    Opening opening(**tree);
    std::error_code ignored;
    opening.state().origin = fs::weakly_canonical(root, ignored);
    return opening.run();
}

}  // namespace ilf::projects
