#include "app/emulated_scenes.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "devices/emulated_scene/built_in.h"
#include "devices/emulated_scene/scene_wish.h"
#include "devices/link/runtime_directory.h"
#include "projects/depth_file.h"
#include "projects/gltf_file.h"

namespace ilf::app {

Result<devices::scene::SceneFile> sceneFile(const std::filesystem::path& path) {
    using devices::scene::SceneFile;
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".glb" || ending == ".gltf")
        return projects::readGltf(path).map([](const projects::GltfScene& scene) { return SceneFile(scene.solid); });
    // Its size is known once it is read: first for any focal length, which is as good as none.
    projects::DepthReading reading;
    reading.focalPixels = 1.0;
    return projects::readDepth(path, reading).map([](projects::DepthFile file) {
        const auto lens = devices::scene::builtInCamera();
        Pinhole& camera = file.measured.camera;
        const double scale = static_cast<double>(camera.size.width) / lens.size.width;
        camera = {camera.size,
                  scale * lens.focalX,
                  scale * lens.focalY,
                  scale * lens.centreX,
                  camera.size.height * lens.centreY / lens.size.height,
                  lens.bend};
        return SceneFile(Box(std::move(file.measured)));
    });
}

void readEmulatedScenes() { devices::scene::readScenesWith(sceneFile); }

Result<void> wishedOfCamera(const std::string& words) {
    if (words.empty()) return {};
    const auto wish = devices::sceneWishFrom(words);
    if (!wish) return tl::unexpected(wish.error());
    if (!wish->scene.empty()) {
        if (const auto read = devices::scene::sceneThings(wish->scene, wish->scale); !read)
            return tl::unexpected(read.error());
    }
    const auto directory = devices::runtimeDirectory();
    return devices::prepareRuntimeDirectory(directory).and_then(
        [&] { return devices::saveSceneWish(directory, *wish); });
}

}  // namespace ilf::app
