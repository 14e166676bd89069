#include "devices/camera/list.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "devices/camera/camera_source.h"

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

/// "usb-046d_HD_Pro_Webcam_C920_5A1B-video-index0" is, for the operator, "046d HD Pro Webcam C920 5A1B".
std::string nameOf(std::string link) {
    if (const auto end = link.rfind("-video-index"); end != std::string::npos) link.resize(end);
    if (link.starts_with("usb-")) link.erase(0, 4);
    std::replace(link.begin(), link.end(), '_', ' ');
    return link;
}

void addFrom(const fs::path& folder, bool byPort, std::set<fs::path>& seen, std::vector<CameraEntry>& cameras) {
    std::error_code error;
    std::vector<CameraEntry> found;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string link = entry.path().filename().string();
        if (!link.ends_with("-video-index0")) continue;  // further nodes give metadata, not pictures
        std::error_code gone;
        const fs::path device = fs::canonical(entry.path(), gone);
        if (gone || seen.count(device) != 0) continue;
        const std::string name = nameOf(link);
        found.push_back({entry.path().string(), byPort ? "Camera at port " + name : name, device, byPort});
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    for (CameraEntry& camera : found) {
        if (seen.insert(camera.device).second) cameras.push_back(std::move(camera));
    }
}

}  // namespace

std::vector<CameraEntry> listCameras(const fs::path& v4l) {
    std::vector<CameraEntry> cameras;
    std::set<fs::path> seen;
    addFrom(v4l / "by-id", false, seen, cameras);
    addFrom(v4l / "by-path", true, seen, cameras);
    cameras.push_back({kSimulatedCameraId, "Simulated camera", {}, false});
    cameras.push_back({kEmulatedCameraId, "Emulated camera (sees the emulated scene)", {}, false});
    return cameras;
}

Result<fs::path> deviceOf(const std::string& id, const fs::path& v4l) {
    std::string others;
    for (const CameraEntry& camera : listCameras(v4l)) {
        if (camera.id == id && !camera.device.empty()) return camera.device;
        if (!camera.device.empty()) others += (others.empty() ? "" : ", ") + camera.name;
    }
    return fail(Fault::notFound, "The camera \"" + nameOf(fs::path(id).filename().string()) + "\" is not plugged in. " +
                                     (others.empty() ? "No other camera is." : "Others are: " + others + "."));
}

}  // namespace ilf::devices
