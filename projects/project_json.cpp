#include "projects/project_json.h"

#include <set>
#include <utility>

#include "projects/follow_json.h"
#include "projects/pinhole_json.h"
#include "projects/registration_json.h"

namespace ilf::projects {
namespace {

const char* const kFormat = "illuminatedfocus-project";
const std::vector<std::string> kLooks{"focus", "blur", "neutral"};
const std::vector<std::string> kBlendings{"none", "linear-object", "linear-perceived", "closed-form"};
const std::vector<std::string> kScaleSources{"assumed", "exif", "typed", "calibrated"};
const std::vector<std::string> kDistanceKinds{"constant", "plane", "depth-map"};

template <class Enum>
const std::string& wordOf(const std::vector<std::string>& words, Enum value) {
    return words[static_cast<std::size_t>(value)];
}

/// A key keeps its place in the file while it has a value.
void setOrErase(Json& json, const char* key, const std::string& value) {
    if (value.empty()) {
        json.erase(key);
    } else {
        json.set(key, value);
    }
}

Json written(const ConstantDistance& constant, Json json) {
    json.erase("anchors");
    json.set("value_m", constant.value.si());
    json.set("tolerance_m", constant.tolerance.si());
    return json;
}

Json written(const PlaneDistance& plane, Json json) {
    json.erase("value_m");
    json.set("tolerance_m", plane.tolerance.si());
    std::vector<Json> anchors = json.objects("anchors");
    anchors.resize(plane.anchors.size());
    for (std::size_t i = 0; i < anchors.size(); ++i) {
        anchors[i].set("x_px", plane.anchors[i].at.x);
        anchors[i].set("y_px", plane.anchors[i].at.y);
        anchors[i].set("distance_m", plane.anchors[i].distance.si());
    }
    json.set("anchors", anchors);
    return json;
}

Json written(const FromDepthMap& map, Json json) {
    json.erase("value_m");
    json.erase("anchors");
    json.set("tolerance_m", map.tolerance.si());
    return json;
}

Json written(const Distance& distance, Json json) {
    json.set("kind", kDistanceKinds[distance.index()]);
    return std::visit([&](const auto& kind) { return written(kind, json); }, distance);
}

Distance distanceFrom(JsonReader reader) {
    switch (reader.choice("kind", kDistanceKinds)) {
    case 0:
        return ConstantDistance{Metre::fromSi(reader.number("value_m")),
                                Metre::fromSi(reader.number("tolerance_m", 0.0))};
    case 1: {
        PlaneDistance plane;
        std::vector<JsonReader> anchors = reader.objects("anchors");
        if (anchors.size() != plane.anchors.size()) {
            reader.complain("anchors", "must be a list of three points of the plane.");
            return plane;
        }
        for (std::size_t i = 0; i < anchors.size(); ++i) {
            plane.anchors[i].at = {anchors[i].number("x_px"), anchors[i].number("y_px")};
            plane.anchors[i].distance = Metre::fromSi(anchors[i].number("distance_m"));
        }
        plane.tolerance = Metre::fromSi(reader.number("tolerance_m", 0.0));
        return plane;
    }
    default:
        return FromDepthMap{Metre::fromSi(reader.number("tolerance_m", 0.0))};
    }
}

/// What regions and the background have in common.
void setSurface(Json& json, const Region& region) {
    json.set("name", region.name);
    json.set("look", wordOf(kLooks, region.look));
    if (region.strength) {
        json.set("strength_D", region.strength->si());
    } else {
        json.erase("strength_D");
    }
    json.set("distance", written(region.distance, json.object("distance")));
}

Json written(const Region& region, const std::string& mask, Json json) {
    json.set("id", region.id);
    setSurface(json, region);
    setOrErase(json, "mask", mask);
    if (!region.outline) {
        json.erase("outline_px");
    } else {
        std::vector<std::pair<double, double>> vertices;
        for (const auto& vertex : region.outline->vertices)
            vertices.emplace_back(vertex.x, vertex.y);
        json.setPairs("outline_px", vertices);
    }
    if (region.follow) {
        json.set("follow", written(*region.follow, json.object("follow")));
    } else {
        json.erase("follow");
    }
    json.set("visible", region.visible);
    json.set("locked", region.locked);
    json.set("solo", region.solo);
    return json;
}

Region surfaceFrom(JsonReader& reader, const RegionId& id) {
    Region region;
    region.id = id;
    region.name = reader.word("name", id);
    region.look = static_cast<Look>(reader.choice("look", kLooks));
    if (const auto strength = reader.optionalNumber("strength_D")) region.strength = Dioptre::fromSi(*strength);
    region.distance = distanceFrom(reader.object("distance"));
    region.visible = reader.flag("visible", true);
    region.locked = reader.flag("locked", false);
    region.solo = reader.flag("solo", false);
    return region;
}

Region regionFrom(JsonReader& reader) {
    Region region = surfaceFrom(reader, reader.word("id"));
    if (reader.has("outline_px")) {
        region.outline.emplace();
        for (const auto& [x, y] : reader.pairs("outline_px"))
            region.outline->vertices.push_back({x, y});
    }
    if (reader.has("follow")) region.follow = followFrom(reader.object("follow"));
    return region;
}

/// What a measured depth is, besides its pixels.
Json described(const MeasuredDepth& measured, Json json) {
    json.set("source", measured.source);
    json.set("provenance", measured.provenance);
    json.set("camera_px", written(measured.camera, "", json.object("camera_px")));
    return json;
}

MeasuredDepth describedBy(JsonReader& reader) {
    MeasuredDepth measured;
    measured.source = reader.word("source", "");
    measured.provenance = reader.word("provenance", "");
    measured.camera = pinholeFrom(reader.object("camera_px"), "");
    return measured;
}

Json written(const ViewerPose& viewer, Json before) {
    Json json = written(viewer.viewerFromCamera, std::move(before));
    json.set("sigma_m", viewer.sigma.si());
    json.set("source", viewer.source);
    return json;
}

ViewerPose viewerFrom(JsonReader reader) {
    ViewerPose viewer;
    viewer.viewerFromCamera = poseFrom<ViewerSpace, CameraSpace>(reader);
    viewer.sigma = Metre::fromSi(reader.number("sigma_m", 0.0));
    viewer.source = reader.word("source", "typed");
    return viewer;
}

Json written(const Scene& scene, const ProjectNames& names, Json json) {
    setOrErase(json, "picture", names.picture);
    json.set("source", scene.source);
    json.set("focal_px", scene.scale.focalPixels);
    json.set("focal_source", wordOf(kScaleSources, scene.scale.source));
    const auto setDepth = [&](const char* key, const std::string& file, Metre step) {
        if (file.empty()) return json.erase(key);
        Json depth = json.object(key);
        depth.set("file", file);
        if (step > 0.0_m) {
            depth.set("metres_per_unit", step.si());
        } else {
            depth.erase("metres_per_unit");
        }
        json.set(key, depth);
    };
    setDepth("depth", names.depth, scene.depth ? scene.depth->step : 0.0_m);
    setDepth("measured_depth", names.measured, scene.measured ? scene.measured->step : 0.0_m);
    if (!names.measured.empty()) json.set("measured_depth", described(*scene.measured, json.object("measured_depth")));
    if (scene.viewer == ViewerPose{}) {
        json.erase("viewer");
    } else {
        json.set("viewer", written(scene.viewer, json.object("viewer")));
    }
    if (scene.camera == CameraMode{}) {
        json.erase("camera");
    } else {
        json.set("camera", written(scene.camera, json.object("camera")));
    }
    return json;
}

void readScene(JsonReader reader, ProjectText& project) {
    Scene& scene = project.document.scene;
    project.names.picture = reader.word("picture", "");
    scene.source = reader.word("source", "");
    scene.scale.focalPixels = reader.number("focal_px", 0.0);
    if (reader.has("focal_source")) {
        scene.scale.source = static_cast<PixelScale::Source>(reader.choice("focal_source", kScaleSources));
    }
    if (reader.has("viewer")) scene.viewer = viewerFrom(reader.object("viewer"));
    if (reader.has("camera")) scene.camera = cameraModeFrom(reader.object("camera"));
    const auto stepOf = [](JsonReader& depth) {
        const Metre step = Metre::fromSi(depth.number("metres_per_unit", 0.0));
        if (depth.has("metres_per_unit") && !(step > 0.0_m)) depth.complain("metres_per_unit", "must be more than 0.");
        return step;
    };
    if (reader.has("depth")) {
        JsonReader depth = reader.object("depth");
        project.names.depth = depth.word("file");
        project.depthStep = stepOf(depth);
    }
    if (reader.has("measured_depth")) {
        JsonReader measured = reader.object("measured_depth");
        project.names.measured = measured.word("file");
        project.measured = describedBy(measured);
        project.measured.step = stepOf(measured);
    }
}

}  // namespace

Json written(const Document& document, const ProjectNames& names, Json json) {
    json.set("format", std::string(kFormat));
    json.set("version", kProjectVersion);
    json.set("name", document.name);
    json.set("scene", written(document.scene, names, json.object("scene")));
    const std::vector<Json> regionsBefore = json.objects("regions");
    std::vector<Json> regions;
    for (std::size_t i = 0; i < document.regions.size(); ++i) {
        const Region& region = *document.regions[i];
        Json before;
        for (const Json& candidate : regionsBefore) {
            if (candidate.word("id") == region.id) before = candidate;
        }
        regions.push_back(written(region, names.masks[i], before));
    }
    json.set("regions", regions);
    if (document.background) {
        const Region& region = *document.background;
        Json background = json.object("background");
        setSurface(background, region);
        background.set("visible", region.visible);
        background.set("locked", region.locked);
        background.set("solo", region.solo);
        json.set("background", background);
    }
    Json seam = json.object("seam");
    seam.set("blending", wordOf(kBlendings, document.seam.blending));
    seam.set("feather_m", document.seam.feather.si());
    json.set("seam", seam);
    json.set("alpha_D", document.alpha.si());
    json.set("wearer", names.wearer);
    json.set("rig", names.rig);
    return json;
}

Result<ProjectText> projectFrom(const Json& json, const std::string& file) {
    if (auto known = checkedFormat(json, file, kFormat, kProjectVersion, "project"); !known) {
        return tl::unexpected(known.error());
    }
    ProjectText project;
    Document& document = project.document;
    JsonReader reader(json, file);
    document.name = reader.word("name", document.name);
    readScene(reader.object("scene"), project);
    std::set<RegionId> ids{kBackgroundId};
    for (JsonReader& region : reader.objects("regions")) {
        document.regions.emplace_back(regionFrom(region));
        project.names.masks.push_back(region.word("mask", ""));
        const RegionId& id = document.regions.back()->id;
        if (!region.problem() && (id.empty() || !ids.insert(id).second)) {
            region.complain("id", "must be unlike all others, but is \"" + id + "\".");
        }
    }
    JsonReader background = reader.object("background");
    document.background = Box<Region>(surfaceFrom(background, kBackgroundId));
    if (reader.has("seam")) {
        JsonReader seam = reader.object("seam");
        document.seam.blending = static_cast<Blending>(seam.choice("blending", kBlendings));
        document.seam.feather = Metre::fromSi(seam.number("feather_m"));
    }
    document.alpha = Dioptre::fromSi(reader.number("alpha_D", document.alpha.si()));
    project.names.wearer = reader.word("wearer", "");
    project.names.rig = reader.word("rig", "");
    if (reader.problem()) return tl::unexpected(*reader.problem());
    return project;
}

std::set<std::string> filesNamedIn(const Json& json) {
    const Json scene = json.object("scene");
    std::set<std::string> names{"project.json",
                                json.word("wearer"),
                                json.word("rig"),
                                scene.word("picture"),
                                scene.object("depth").word("file"),
                                scene.object("measured_depth").word("file")};
    for (const Json& region : json.objects("regions"))
        names.insert(region.word("mask"));
    names.erase("");
    return names;
}

}  // namespace ilf::projects
