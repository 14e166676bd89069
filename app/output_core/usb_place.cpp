#include "app/output_core/usb_place.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <utility>
#include <vector>

#include "app/output_core/events.h"
#include "devices/tape/usb_tape.h"

namespace ilf::app {
namespace {

std::string listed(const std::vector<std::string>& paths) {
    std::string text;
    for (const auto& path : paths)
        text += (text.empty() ? "" : ", ") + path;
    return text;
}

/// "1-2-20261123-195501-4711.tape": port, time (UTC) and process.
std::filesystem::path tapeName(const devices::UsbIdentity& device) {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char time[32];
    std::strftime(time, sizeof time, "%Y%m%d-%H%M%S", &utc);
    return device.path + "-" + time + "-" + std::to_string(getpid()) + ".tape";
}

}  // namespace

Result<std::string> placeOf(const std::string& name, const std::string& place, const std::vector<std::string>& found) {
    if (std::find(found.begin(), found.end(), place) != found.end()) return place;
    if (!place.empty())
        return fail(Fault::notFound, "No " + name + " is plugged in at USB " + place + ", where the rig has it" +
                                         (found.empty() ? ": plug it in there and switch it on."
                                                        : "; there is one at " + listed(found) +
                                                              ": move its cable, or correct the rig."));
    if (found.empty()) return fail(Fault::notFound, "No " + name + " is plugged in: plug it in and switch it on.");
    if (found.size() > 1)
        return fail(Fault::device, "There are " + std::to_string(found.size()) + " devices of kind " + name +
                                       " (at USB " + listed(found) + "), and the rig does not say which: name its " +
                                       "place in the rig's file.");
    return found.front();
}

Result<std::unique_ptr<devices::UsbLink>> UsbPlaces::link(const UsbKind& kind, const std::string& place,
                                                          int interfaceNumber) {
    if (!bus_) {
        auto bus = devices::UsbBus::open();
        if (!bus) return tl::unexpected(bus.error());
        bus_ = *std::move(bus);
    }
    bus_->changes();  // so that what came and went is known
    const auto all = bus_->devices(std::array{kind.model});
    if (!all) return tl::unexpected(all.error());
    std::vector<std::string> paths;
    for (const auto& one : *all)
        paths.push_back(one.path);
    return placeOf(kind.name, place, paths).and_then([&](const std::string& path) {
        return bus_->link(path, interfaceNumber).map([&](std::unique_ptr<devices::UsbLink> link) {
            return taped(std::move(link));
        });
    });
}

/// One tape for all openings of a device. A show goes on without one that cannot be written.
std::unique_ptr<devices::UsbLink> UsbPlaces::taped(std::unique_ptr<devices::UsbLink> link) {
    if (tapes_.empty()) return link;
    const auto [known, first] = recorders_.try_emplace(link->identity().path);
    if (first) {
        const auto file = tapes_ / tapeName(link->identity());
        auto recorder = devices::TapeRecorder::into(file, devices::Clock::steady());
        note(recorder ? event::kTape : event::kNoTape, recorder ? file.string() : recorder.error().what);
        if (recorder) known->second = *std::move(recorder);
    }
    if (!known->second) return link;
    return std::make_unique<devices::RecordingLink>(std::move(link), known->second, devices::Streamed::leftOut);
}

}  // namespace ilf::app
