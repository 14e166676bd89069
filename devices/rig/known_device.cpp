#include "devices/rig/known_device.h"

namespace ilf::devices {

void KnownDevice::answered(const std::string& name) {
    ever_ = true;
    name_ = name;
    if (health_ != DeviceHealth::wrongMode) cleared();
}

tl::unexpected<Error> KnownDevice::lost(Error error) {
    if (error.fault == Fault::notFound) return missing(std::move(error));
    health_ = DeviceHealth::silent;
    trouble_ = error.what;
    return tl::unexpected<Error>(std::move(error));
}

tl::unexpected<Error> KnownDevice::missing(Error error) {
    health_ = ever_ ? DeviceHealth::unplugged : DeviceHealth::absent;
    trouble_ = error.what;
    return tl::unexpected<Error>(std::move(error));
}

tl::unexpected<Error> KnownDevice::wrong(Error error) {
    health_ = DeviceHealth::wrongMode;
    trouble_ = error.what;
    return tl::unexpected<Error>(std::move(error));
}

void KnownDevice::cleared() {
    health_ = DeviceHealth::well;
    trouble_.clear();
}

DeviceLine KnownDevice::line(const std::string& does) const {
    if (!trouble_.empty()) return {what_, health_, name_, trouble_};
    return {what_, health_, name_, health_ == DeviceHealth::absent ? "It was not looked for yet." : does};
}

}  // namespace ilf::devices
