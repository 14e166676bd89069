#include "app/headless/gltf_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <vector>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "app/words.h"
#include "core/solid/draw.h"
#include "core/solid/extent.h"
#include "core/solid/pose.h"
#include "projects/depth_file.h"
#include "projects/gltf_file.h"
#include "projects/pictures.h"
#include "projects/safe_file.h"

namespace ilf::app {

namespace {

using Json = nlohmann::ordered_json;
using projects::GltfCamera;
using projects::GltfScene;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Where a camera stands and the direction it looks in, in the scene.
std::pair<std::array<double, 3>, std::array<double, 3>> standing(const Pose<CameraSpace, ModelSpace>& pose) {
    const auto back = pose.inverted();
    return {back.translation, {back.rotation[2], back.rotation[5], back.rotation[8]}};
}

std::size_t vertexCount(const Solid& solid) {
    std::size_t count = 0;
    for (const Box<Mesh>& mesh : solid.meshes)
        count += mesh->positions.size();
    return count;
}

void printJson(const std::string& file, const GltfScene& scene) {
    const Solid& solid = *scene.solid;
    Json json;
    json["file"] = file;
    json["generator"] = scene.generator;
    json["triangles"] = triangleCount(solid);
    json["vertices"] = vertexCount(solid);
    const auto extent = extentOf(solid);
    json["bbox_min"] = extent ? Json(extent->least) : Json();
    json["bbox_max"] = extent ? Json(extent->most) : Json();
    json["problems"] = scene.problems;
    json["meshes"] = Json::array();
    for (const Box<Mesh>& mesh : solid.meshes)
        json["meshes"].push_back({{"name", mesh->name},
                                  {"triangles", mesh->triangles.size()},
                                  {"vertices", mesh->positions.size()},
                                  {"material", mesh->material < 0 ? Json() : Json(mesh->material)}});
    json["materials"] = Json::array();
    for (const Box<Material>& material : solid.materials) {
        const Size texture = material->texture.size();
        json["materials"].push_back(
            {{"colour", material->colour},
             {"texture", material->texture.empty() ? Json() : Json({texture.width, texture.height})},
             {"double_sided", material->doubleSided}});
    }
    json["cameras"] = Json::array();
    for (const GltfCamera& camera : scene.cameras) {
        const auto [at, towards] = standing(camera.cameraFromModel);
        Json one{{"name", camera.name}, {"kind", camera.orthographic ? "orthographic" : "perspective"}};
        if (!camera.orthographic) one["yfov_deg"] = camera.yfov / kDegree;
        if (camera.aspectRatio) one["aspect_ratio"] = *camera.aspectRatio;
        one["position"] = at;
        one["looks_along"] = towards;
        json["cameras"].push_back(std::move(one));
    }
    std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

std::string triple(const std::array<float, 3>& v) {
    std::ostringstream text;
    text << v[0] << ", " << v[1] << ", " << v[2];
    return text.str();
}

void printText(const std::string& file, const GltfScene& scene) {
    const Solid& solid = *scene.solid;
    std::cout << file << ": " << triangleCount(solid) << " triangles, " << vertexCount(solid) << " vertices, "
              << solid.meshes.size() << " meshes, " << solid.materials.size() << " materials\n";
    if (const auto extent = extentOf(solid)) {
        std::cout << "box: " << triple(extent->least) << " to " << triple(extent->most) << " m ("
                  << extent->most[0] - extent->least[0] << " x " << extent->most[1] - extent->least[1] << " x "
                  << extent->most[2] - extent->least[2] << " m)\n";
    } else {
        std::cout << "box: none, the scene has no vertices\n";
    }
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        const GltfCamera& camera = scene.cameras[i];
        const auto [at, towards] = standing(camera.cameraFromModel);
        std::cout << "camera " << i << ": " << (camera.name.empty() ? "without a name" : camera.name) << ", ";
        if (camera.orthographic) {
            std::cout << "orthographic";
        } else {
            std::cout << camera.yfov / kDegree << " degrees high";
        }
        std::cout << ", at " << at[0] << ", " << at[1] << ", " << at[2] << " m\n";
    }
    for (const std::string& problem : scene.problems)
        std::cout << "problem: " << problem << '\n';
}

/// Numbers separated by commas, all of the text; nothing where it is something else.
std::optional<std::vector<double>> numbersIn(const std::string& text) {
    std::vector<double> numbers;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, ',');) {
        const auto first = part.find_first_not_of(" \t\r"), last = part.find_last_not_of(" \t\r");
        const auto number = first == std::string::npos
                                ? std::nullopt
                                : wholeNumber(std::string_view(part).substr(first, last - first + 1));
        if (!number) return std::nullopt;
        numbers.push_back(*number);
    }
    return numbers;
}

std::optional<Size> sizeFrom(const std::string& text) {
    Size size;
    char end = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &end) != 2) return std::nullopt;
    if (size.width < 1 || size.height < 1 || size.width > kLargestDrawn || size.height > kLargestDrawn ||
        std::int64_t{size.width} * size.height > projects::kMaxPixels)
        return std::nullopt;
    return size;
}

Result<std::vector<PosePair>> readPairs(const std::string& file) {
    const auto text = projects::readWhole(file, 1 << 20);
    if (!text) return tl::unexpected(text.error());
    std::vector<PosePair> pairs;
    std::istringstream in(*text);
    int number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        if (line.empty() || line[0] == '#' || line.find_first_not_of(" \t\r") == std::string::npos) continue;
        const auto values = numbersIn(line);
        if (!values || values->size() != 5) {
            if (number == 1) continue;  // names of the columns
            return fail(Fault::badFile, projects::spoken(file) + ", line " + std::to_string(number) +
                                            ": write x,y,z,u,v: a point of the scene in metres and its pixel.");
        }
        const auto& v = *values;
        pairs.push_back({{v[0], v[1], v[2]}, {v[3], v[4]}});
    }
    return pairs;
}

struct View {
    Pinhole camera;
    Pose<CameraSpace, ModelSpace> pose;
    std::string spoken;
};

/// From the front, to the right and above, so that the whole box is in view.
Result<View> wholeView(const Solid& solid, const Pinhole& camera) {
    const auto extent = extentOf(solid);
    if (!extent) return fail(Fault::outOfRange, solid.source + " has nothing to draw.");
    std::array<double, 3> middle{};
    double radius = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        middle[i] = 0.5 * (static_cast<double>(extent->least[i]) + static_cast<double>(extent->most[i]));
        radius =
            std::hypot(radius, 0.5 * (static_cast<double>(extent->most[i]) - static_cast<double>(extent->least[i])));
    }
    radius = std::max(radius, 1e-3);
    const double slope = std::min(0.5 * camera.size.width / camera.fx, 0.5 * camera.size.height / camera.fy);
    const double away = radius / std::sin(std::atan(slope));
    const Point3<ModelSpace> target{middle[0], middle[1], middle[2]};
    const Point3<ModelSpace> eye{target.x + 0.48 * away, target.y + 0.36 * away, target.z + 0.8 * away};
    return View{camera, lookingAt(eye, target), "all in view"};
}

Result<View> viewOf(const GltfScene& scene, const GltfDepthOptions& options, Size size) {
    const double focal =
        options.focal_px > 0.0 ? options.focal_px : 0.5 * size.height / std::tan(0.5 * options.fov_deg * kDegree);
    const Pinhole camera = plainPinhole(size, focal);
    if (options.camera >= 0) {
        const std::size_t count = scene.cameras.size();
        if (static_cast<std::size_t>(options.camera) >= count)
            return fail(Fault::notFound, "There is no camera " + std::to_string(options.camera) + ": " +
                                             scene.solid->source +
                                             (count == 0 ? " has none. Use --pose or --pairs."
                                                         : " has " + std::to_string(count) + ", counted from 0."));
        const GltfCamera& own = scene.cameras[static_cast<std::size_t>(options.camera)];
        if (own.orthographic)
            return fail(Fault::unsupported, "Camera " + std::to_string(options.camera) +
                                                " is orthographic, which no real camera is. Use --pose or --pairs.");
        return View{own.pinhole(size), own.cameraFromModel, "camera " + std::to_string(options.camera)};
    }
    if (!options.pose.empty()) {
        const auto v = numbersIn(options.pose);
        if (!v || v->size() != 6 || std::hypot((*v)[0] - (*v)[3], (*v)[1] - (*v)[4], (*v)[2] - (*v)[5]) < 1e-9)
            return fail(Fault::outOfRange, "\"" + options.pose +
                                               "\" is no pose: write X,Y,Z,TX,TY,TZ, where the camera is and another "
                                               "point that it looks at, in metres.");
        return View{camera, lookingAt({(*v)[0], (*v)[1], (*v)[2]}, {(*v)[3], (*v)[4], (*v)[5]}), "typed pose"};
    }
    if (!options.pairs.empty()) {
        const auto pairs = readPairs(options.pairs);
        if (!pairs) return tl::unexpected(pairs.error());
        const auto found = poseFromPairs(*pairs, camera);
        if (!found) return tl::unexpected(found.error());
        std::ostringstream said;
        said << "pose from " << pairs->size() << " pairs, rms " << found->rms_px << " px, worst "
             << found->residuals_px[found->worst] << " px (pair " << found->worst + 1 << ")";
        if (found->rival_px)
            said << "; another pose fits nearly as well (" << *found->rival_px << " px): add a point off the plane";
        return View{camera, found->cameraFromModel, said.str()};
    }
    return wholeView(*scene.solid, camera);
}

Result<void> written(const GltfDepthOptions& options, const MeasuredDepth& measured) {
    if (std::filesystem::path(options.out).extension() != ".png") return projects::writeDepth(options.out, measured);
    const auto bytes = projects::encodeDepthPng(measured.metres, Metre::fromSi(1e-3 * options.step_mm));
    if (!bytes) return tl::unexpected(bytes.error());
    return projects::writeAtomically(options.out, *bytes);
}

}  // namespace

int gltfInfoCommand(const std::string& file, bool json) {
    const auto scene = projects::readGltf(file);
    if (!scene) {
        if (json) {
            const Json told{{"file", file}, {"refused", true}, {"problems", {scene.error().what}}};
            std::cout << told.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
        }
        return refused("gltf", scene.error());
    }
    (json ? printJson : printText)(file, *scene);
    return kDone;
}

int gltfDepthCommand(const GltfDepthOptions& options) {
    const auto size = sizeFrom(options.size);
    const int views = (options.camera >= 0 ? 1 : 0) + (options.pose.empty() ? 0 : 1) + (options.pairs.empty() ? 0 : 1);
    if (!size || views > 1) {
        std::cerr << "illuminatedfocus gltf: "
                  << (size ? "name one of --camera, --pose and --pairs.\n"
                           : "\"" + options.size + "\" is no size: write 1280x1024, up to 100 megapixels.\n");
        return kUsage;
    }
    const auto scene = projects::readGltf(options.file, {!options.colour.empty()});
    if (!scene) return refused("gltf", scene.error());
    const auto view = viewOf(*scene, options, *size);
    if (!view) return refused("gltf", view.error());
    DrawnSolid picture;
    if (options.colour.empty()) {
        picture.depth = drawnDepth(*scene->solid, view->camera, view->pose);
    } else {
        picture = drawn(*scene->solid, view->camera, view->pose);
    }
    float nearest = 0.0F, farthest = 0.0F;
    std::size_t covered = 0;
    for (const float z : picture.depth.pixels()) {
        if (!(z > 0.0F)) continue;
        nearest = covered == 0 ? z : std::min(nearest, z);
        farthest = std::max(farthest, z);
        ++covered;
    }
    MeasuredDepth measured;
    measured.metres = picture.depth;
    measured.camera = view->camera;
    measured.source = scene->solid->source;
    measured.provenance = "computed";
    if (const auto good = written(options, measured); !good) return refused("gltf", good.error());
    if (!options.colour.empty()) {
        if (const auto good = projects::writePng(options.colour, picture.colour); !good)
            return refused("gltf", good.error());
    }
    std::cout << options.out << ": " << view->spoken << "; ";
    if (covered == 0) {
        std::cout << "nothing in view\n";
        return kDone;
    }
    std::cout << nearest << " to " << farthest << " m, "
              << 100.0 * static_cast<double>(covered) / static_cast<double>(picture.depth.pixels().size())
              << " % of the picture";
    if (std::filesystem::path(options.out).extension() == ".png") {
        std::cout << "; one step is " << options.step_mm << " mm, 0 is a hole";
        if (farthest > 65.535 * options.step_mm)
            std::cout << "; what is beyond " << 65.535 * options.step_mm << " m is a hole: choose a larger --step";
    }
    std::cout << '\n';
    return kDone;
}

}  // namespace ilf::app
