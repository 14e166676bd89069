// The studio's camera: a live device or a video file, its newest frame, and whether it still moves.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/document/document.h"
#include "ui/view.h"

namespace ilf::app {

class CameraPort {
public:
    explicit CameraPort(std::function<void()>) {}
    void close() {}
    bool streaming() const { return false; }
    bool live() const { return false; }
    bool collect() { return false; }
    Image<std::uint8_t> frame() const { return {}; }
    std::vector<std::string> takeSentences() { return {}; }
    Result<void> toggleLock() { return {}; }
    void toggleLive() {}
    Result<void> openVideo(const std::string&) { return {}; }
    Result<void> openLive(const std::string&) { return fail(Fault::device, "none"); }
    void seek(double) {}
    Result<Scene> grabbed() { return fail(Fault::device, "none"); }
    ui::CameraStatus status() const { return {}; }
    std::vector<std::string> ids() const { return {}; }
};

}  // namespace ilf::app
