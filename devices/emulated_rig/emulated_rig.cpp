#include "devices/emulated_rig/emulated_rig.h"

#include "devices/emulators/usb_host.h"
#include "devices/link/runtime_directory.h"

namespace ilf::devices {

Result<void> serveEmulatedRig(const std::filesystem::path& runtimeDirectory, LensPreset /*lens*/,
                              int /*stopDescriptor*/, const std::function<void(const std::string&)>& /*said*/) {
    auto lock = FileLock::tryTake(devicesLock(runtimeDirectory));
    if (!lock) return tl::unexpected(lock.error());
    if (!*lock) return fail(Fault::device, "Devices run in this runtime directory already.");
    auto bus = emulators::UsbHost::started();
    if (!bus) return tl::unexpected(bus.error());
    return fail(Fault::unsupported, "The emulated rig has a bus and nothing on it yet.");
}

}  // namespace ilf::devices
