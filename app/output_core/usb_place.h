// Devices of a rig by where they hang on the USB.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "devices/tape/tape_recorder.h"
#include "devices/usb/usb_bus.h"

namespace ilf::app {

struct UsbKind {
    devices::UsbModel model;
    const char* name;  ///< "LightCrafter 4500"
};

/// The bus, opened when it is first needed. Used by one thread.
class UsbPlaces {
public:
    /// `tapes`: the folder that gets a tape of each device that is opened; empty: none is made.
    explicit UsbPlaces(std::filesystem::path tapes = {}) : tapes_(std::move(tapes)) {}

    /// The device at `place`, or, with an empty one, the only one of its kind. Never another one: which projector is
    /// the room's is the rig's to say.
    Result<std::unique_ptr<devices::UsbLink>> link(const UsbKind& kind, const std::string& place, int interfaceNumber);

private:
    std::unique_ptr<devices::UsbLink> taped(std::unique_ptr<devices::UsbLink> link);

    std::unique_ptr<devices::UsbBus> bus_;
    std::filesystem::path tapes_;
    std::map<std::string, std::shared_ptr<devices::TapeRecorder>> recorders_;  ///< by path; none: it cannot be written
};

/// Where among `found` (the paths of all devices of that kind) the one meant is.
Result<std::string> placeOf(const std::string& name, const std::string& place, const std::vector<std::string>& found);

}  // namespace ilf::app
