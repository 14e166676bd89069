#include "projects/wearer_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/document/edit.h"
#include "projects/calibration_json.h"
#include "projects/file_tree.h"
#include "projects/map_file.h"
#include "projects/safe_file.h"
#include "projects/wearer_rig_json.h"

namespace ilf::projects {
namespace {

constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20;
const char* const kWearerFormat = "illuminatedfocus-wearer";
const char* const kRigFormat = "illuminatedfocus-rig";
const std::vector<std::string> kProjectorKinds{"high-speed", "lightcrafter-4500"};
const std::vector<std::string> kPresets{"one-arcmin", "depth-of-field", "landolt", "typed"};

Json written(const LensAxis& axis, Json json) {
    json.set("right_m", axis.right.si());
    json.set("down_m", axis.down.si());
    return json;
}

LensAxis axisFrom(JsonReader reader) {
    return {Metre::fromSi(reader.number("right_m")), Metre::fromSi(reader.number("down_m"))};
}

Json written(const CameraObserver& camera, Json json) {
    json.set("focal_length_m", camera.focalLength.si());
    json.set("f_number", camera.fNumber);
    json.set("focus_distance_m", camera.focusDistance.si());
    json.set("pixel_pitch_m", camera.pixelPitch.si());
    return json;
}

CameraObserver cameraFrom(JsonReader reader) {
    return {Metre::fromSi(reader.number("focal_length_m")), reader.number("f_number"),
            Metre::fromSi(reader.number("focus_distance_m")), Metre::fromSi(reader.number("pixel_pitch_m"))};
}

/// Red, green and blue, to a millionth: so a file read and written again says the same.
std::vector<double> nanometres(const std::array<Metre, 3>& wavelengths) {
    std::vector<double> nm;
    for (const Metre& length : wavelengths)
        nm.push_back(std::round(length.si() * 1e15) / 1e6);
    return nm;
}

/// The value, unless reading it or checking its numbers found something wrong.
template <class T>
Result<T> judged(T value, const JsonReader& reader, const std::string& file) {
    if (reader.problem()) return tl::unexpected(*reader.problem());
    if (const auto good = checked(value); !good) return fail(Fault::badFile, file + ": " + good.error().what);
    return value;
}

Result<Json> readJson(const fs::path& path) {
    return readWhole(path, kMaxJsonBytes).and_then([&](const std::string& text) {
        return Json::parse(text, spoken(path));
    });
}

/// Keys of the file that is about to be replaced; a damaged or foreign file has none worth keeping.
Json keysOf(const fs::path& path, const char* format) {
    const auto json = readJson(path);
    return json && json->word("format") == format ? *json : Json();
}

const std::string kMapEnding = ".map.exr";

/// FNV-1a, 64 bits: tells two maps of one rig apart.
std::string fingerprint(const std::string& bytes) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : bytes)
        hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    std::string hex(16, '0');
    for (std::size_t i = 16; i-- > 0; hash >>= 4)
        hex[i] = "0123456789abcdef"[hash & 15];
    return hex;
}

}  // namespace

MapFacts factsOf(const Registration& registration) {
    MapFacts facts{{"taken", registration.taken},
                   {"device", registration.camera.device},
                   {"projector", registration.projectorName},
                   {"provenance", registration.provenance},
                   {"rms_px", std::to_string(registration.rms_px)}};
    for (auto& [key, value] : facts)
        value.resize(std::min(value.size(), std::size_t{500}));
    return facts;
}

Json written(const Wearer& wearer, Json json) {
    json.set("format", std::string(kWearerFormat));
    json.set("version", kWearerVersion);
    json.set("name", wearer.name);
    json.set("pupil_m", wearer.pupil.si());
    json.set("lens_to_pupil_m", wearer.lensToPupil.si());
    json.set("eye_power_D", wearer.eyePower.si());
    json.set("ametropia_D", wearer.ametropia.si());
    json.set("age_years", wearer.ageYears);
    if (wearer.measuredAccommodation) {
        json.set("measured_accommodation_D", wearer.measuredAccommodation->si());
    } else {
        json.erase("measured_accommodation_D");
    }
    Json confusion = json.object("circle_of_confusion");
    confusion.set("preset", kPresets[static_cast<std::size_t>(wearer.confusion.preset)]);
    confusion.set("diameter_m", wearer.confusion.diameter.si());
    json.set("circle_of_confusion", confusion);
    json.set("lens_aperture_m", wearer.lensAperture.si());
    Json axes = json.object("lens_axes");
    axes.set("left", written(wearer.axes[0], axes.object("left")));
    axes.set("right", written(wearer.axes[1], axes.object("right")));
    json.set("lens_axes", axes);
    if (wearer.camera) {
        json.set("observer_camera", written(*wearer.camera, json.object("observer_camera")));
    } else {
        json.erase("observer_camera");
    }
    return json;
}

Result<Wearer> wearerFrom(const Json& json, const std::string& file) {
    if (auto known = checkedFormat(json, file, kWearerFormat, kWearerVersion, "wearer file"); !known) {
        return tl::unexpected(known.error());
    }
    JsonReader reader(json, file);
    Wearer wearer;
    wearer.name = reader.word("name");
    wearer.pupil = Metre::fromSi(reader.number("pupil_m"));
    wearer.lensToPupil = Metre::fromSi(reader.number("lens_to_pupil_m"));
    wearer.eyePower = Dioptre::fromSi(reader.number("eye_power_D"));
    wearer.ametropia = Dioptre::fromSi(reader.number("ametropia_D"));
    wearer.ageYears = reader.number("age_years");
    if (const auto measured = reader.optionalNumber("measured_accommodation_D")) {
        wearer.measuredAccommodation = Dioptre::fromSi(*measured);
    }
    JsonReader confusion = reader.object("circle_of_confusion");
    wearer.confusion.preset = static_cast<CircleOfConfusion::Preset>(confusion.choice("preset", kPresets));
    wearer.confusion.diameter = Metre::fromSi(confusion.number("diameter_m", 0.0));
    wearer.lensAperture = Metre::fromSi(reader.number("lens_aperture_m"));
    JsonReader axes = reader.object("lens_axes");
    wearer.axes = {axisFrom(axes.object("left")), axisFrom(axes.object("right"))};
    if (reader.has("observer_camera")) wearer.camera = cameraFrom(reader.object("observer_camera"));
    return judged(std::move(wearer), reader, file);
}

Json written(const Rig& rig, Json json, const std::string& mapName) {
    json.set("format", std::string(kRigFormat));
    json.set("version", kRigVersion);
    json.set("name", rig.name);
    Json projector = json.object("projector");
    projector.set("width_px", rig.projector.width);
    projector.set("height_px", rig.projector.height);
    json.set("projector", projector);
    json.set("sweep_rate_Hz", rig.sweepRate.si());
    json.set("slot_rate_Hz", rig.slotRate.si());
    json.set("projector_delay_s", rig.projectorDelay.si());
    json.set("lens_min_D", rig.lensMin.si());
    json.set("lens_max_D", rig.lensMax.si());
    json.set("projector_kind", kProjectorKinds[static_cast<std::size_t>(rig.kind)]);
    json.set("bits", rig.bits);
    json.set("fastest_slot_rate_Hz", rig.fastest.si());
    json.set("waves", std::string(word(rig.waves)));
    json.set("lens", rig.lens);
    json.set("power_budget_D", rig.powerBudget.si());
    json.set("blur_budget_share", rig.blurShare);
    Json room = json.object("room");
    room.set("projector_lm", rig.room.projector_lm);
    room.set("lit_area_m2", rig.room.litArea_m2);
    room.set("ambient_lx", rig.room.ambient_lx);
    json.set("room", room);
    if (rig.primaries) {
        json.set("primaries_nm", nanometres(*rig.primaries));
    } else {
        json.erase("primaries_nm");
    }
    if (rig.registration) {
        const auto& m = rig.registration->map.nearest().m;
        json.set("projector_from_camera", std::vector<double>(m.begin(), m.end()));
        json.set("registration", written(*rig.registration, json.object("registration"), mapName));
    } else {
        json.erase("projector_from_camera");
        json.erase("registration");
    }
    if (rig.calibration) {
        json.set("calibration", written(*rig.calibration, json.object("calibration")));
    } else {
        json.erase("calibration");
    }
    if (rig.devices) {
        json.set("devices", written(*rig.devices, json.object("devices")));
    } else {
        json.erase("devices");
    }
    json.set("provenance", rig.provenance);
    return json;
}

Result<Rig> rigFrom(const Json& json, const std::string& file, const MapReader& maps) {
    if (auto known = checkedFormat(json, file, kRigFormat, kRigVersion, "rig file"); !known) {
        return tl::unexpected(known.error());
    }
    JsonReader reader(json, file);
    Rig rig;
    rig.name = reader.word("name");
    JsonReader projector = reader.object("projector");
    rig.projector = {projector.whole("width_px"), projector.whole("height_px")};
    rig.sweepRate = Hertz::fromSi(reader.number("sweep_rate_Hz"));
    rig.slotRate = Hertz::fromSi(reader.number("slot_rate_Hz"));
    rig.projectorDelay = Second::fromSi(reader.number("projector_delay_s"));
    rig.lensMin = Dioptre::fromSi(reader.number("lens_min_D"));
    rig.lensMax = Dioptre::fromSi(reader.number("lens_max_D"));
    // Rigs saved before there was a choice have none of these.
    if (reader.has("projector_kind")) {
        rig.kind = static_cast<ProjectorKind>(reader.choice("projector_kind", kProjectorKinds));
    }
    rig.bits = reader.has("bits") ? reader.whole("bits") : rig.bits;
    const Hertz fastest = std::max(rig.fastest, rig.slotRate);
    rig.fastest = Hertz::fromSi(reader.number("fastest_slot_rate_Hz", fastest.si()));
    const auto waves = waveModeFromWord(reader.word("waves", std::string(word(rig.waves))));
    if (!waves) reader.complain("waves", "must be ideal-sine, paper, slot-aware, continuous or shaped");
    rig.waves = waves.value_or(rig.waves);
    rig.lens = reader.word("lens", rig.lens);
    rig.powerBudget = Dioptre::fromSi(reader.number("power_budget_D", rig.powerBudget.si()));
    rig.blurShare = reader.number("blur_budget_share", rig.blurShare);
    if (reader.has("room")) {
        JsonReader room = reader.object("room");
        rig.room = {room.number("projector_lm"), room.number("lit_area_m2"), room.number("ambient_lx")};
    }
    if (reader.has("primaries_nm")) {
        const std::vector<double> nm = reader.numbers("primaries_nm", 3);
        rig.primaries = {Metre::fromSi(nm[0] / 1e9), Metre::fromSi(nm[1] / 1e9), Metre::fromSi(nm[2] / 1e9)};
    }
    if (reader.has("projector_from_camera")) {
        const std::vector<double> m = reader.numbers("projector_from_camera", 9);
        Homography<ProjectorFrame, CameraFrame> plane;
        std::copy(m.begin(), m.end(), plane.m.begin());
        rig.registration = registered(plane);
        // Rigs of version 1 have no more than that.
        if (reader.has("registration") && !reader.problem()) {
            auto registration = registrationFrom(reader.object("registration"), plane, maps);
            if (!registration) return tl::unexpected(registration.error());
            rig.registration = *std::move(registration);
        }
    }
    if (reader.has("calibration")) {
        JsonReader calibration = reader.object("calibration");
        rig.calibration = Box<ProcamCalibration>(procamCalibrationFrom(calibration));
    }
    if (reader.has("devices")) rig.devices = rigDevicesFrom(reader.object("devices"));
    rig.provenance = reader.word("provenance");
    return judged(std::move(rig), reader, file);
}

Result<Wearer> readWearer(const fs::path& path) {
    return readJson(path).and_then([&](const Json& json) { return wearerFrom(json, spoken(path)); });
}
Result<Rig> readRig(const fs::path& path) {
    const MapReader beside = [&](const std::string& name) {
        return readMap(path.parent_path() / name).map([](MapFile file) { return Box<DenseMap>(std::move(file.map)); });
    };
    return readJson(path).and_then([&](const Json& json) { return rigFrom(json, spoken(path), beside); });
}
Result<void> writeWearer(const fs::path& path, const Wearer& wearer) {
    return writeAtomically(path, written(wearer, keysOf(path, kWearerFormat)).text());
}
Result<void> writeRig(const fs::path& path, const Rig& rig) {
    const Json before = keysOf(path, kRigFormat);
    const std::string mapBefore = before.object("registration").word("map"), own = path.stem().string() + "-";
    std::string map;
    if (rig.registration && rig.registration->map.dense()) {
        const auto bytes = encodeMap(*rig.registration->map.dense(), factsOf(*rig.registration), MapFormat::exr);
        if (!bytes) return tl::unexpected(bytes.error());
        map = own + fingerprint(*bytes) + kMapEnding;
        if (auto saved = writeAtomically(path.parent_path() / map, *bytes); !saved) return saved;
    }
    if (auto saved = writeAtomically(path, written(rig, before, map).text()); !saved) return saved;
    const bool ours = mapBefore.starts_with(own) && mapBefore.ends_with(kMapEnding) && staysInside(mapBefore);
    if (ours && mapBefore != map) removeQuietly(path.parent_path() / mapBefore);
    return {};
}

}  // namespace ilf::projects
