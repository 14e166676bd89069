// What a stage knows of one of its devices, for its line on the device panel.
#pragma once

#include <string>
#include <utility>

#include "core/base/result.h"
#include "devices/stage.h"

namespace ilf::devices {

class KnownDevice {
public:
    KnownDevice(std::string what, std::string usualName) : what_(std::move(what)), name_(std::move(usualName)) {}

    /// It answers, under this name. What it did wrong stays said until `cleared`.
    void answered(const std::string& name);
    /// It cannot be found, opened or spoken to.
    tl::unexpected<Error> lost(Error error);
    /// It is not there.
    tl::unexpected<Error> missing(Error error);
    /// It answers, and does something else than it was told.
    tl::unexpected<Error> wrong(Error error);
    void cleared();
    /// `does`: the sentence for when nothing is wrong.
    DeviceLine line(const std::string& does) const;
    const std::string& name() const { return name_; }

private:
    std::string what_, name_, trouble_;
    DeviceHealth health_ = DeviceHealth::absent;
    bool ever_ = false;
};

}  // namespace ilf::devices
