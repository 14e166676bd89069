#include "devices/survey/survey.h"

#include <algorithm>
#include <cstdio>

#include "devices/camera/list.h"
#include "devices/dlpc350/lightcrafter.h"
#include "devices/serial/serial_port.h"
#include "devices/survey/ask_device.h"
#include "devices/survey/known_devices.h"
#include "devices/survey/udev_rules.h"
#include "devices/usb/usb_words.h"

namespace ilf::devices {
namespace {

namespace fs = std::filesystem;

std::string numbersOf(const UsbIdentity& device) {
    char numbers[16];
    std::snprintf(numbers, sizeof numbers, "%04x:%04x", device.vendor, device.product);
    return numbers;
}

std::vector<UsbModel> knownModels() {
    std::vector<UsbModel> models;
    for (const KnownDevice& known : kKnownDevices)
        models.push_back(known.model);
    return models;
}

const KnownDevice& knownAs(const UsbIdentity& device) {
    return *std::find_if(kKnownDevices.begin(), kKnownDevices.end(), [&](const KnownDevice& known) {
        return known.model == UsbModel{device.vendor, device.product};
    });
}

bool heldByOneOf(const std::vector<int>& processes, const Attached& device) {
    return std::any_of(processes.begin(), processes.end(), [&](int process) {
        const std::string end = "(process " + std::to_string(process) + ")";
        return std::any_of(device.holders.begin(), device.holders.end(),
                           [&](const std::string& holder) { return holder.ends_with(end); });
    });
}

std::string listed(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : ", ") + name;
    return all;
}

void troubled(Attached& device, Readiness state, std::string trouble) {
    device.state = state;
    device.troubles.push_back(std::move(trouble));
}

/// What can be known of a device without opening it. True: it may be asked.
bool judgedFromOutside(Attached& device, const SurveyOptions& options, const std::string& mayHelp) {
    device.holders = programsHolding(device.node);
    if (heldByOneOf(options.core, device)) {
        device.state = Readiness::inOurUse;
        device.remarks.emplace_back("The output core plays on it, so it was left alone. How it is doing stands in the "
                                    "studio.");
    } else if (!mayOpen(device.node)) {
        std::error_code none;
        if (!fs::exists(device.node, none))
            troubled(device, Readiness::gone, "It was unplugged, or is being plugged in, just now.");
        else
            troubled(device, Readiness::noPermission, "You may not open " + device.node + ". " + mayHelp);
    } else if (!device.holders.empty() && device.kind != DeviceKind::camera) {
        troubled(device, Readiness::busy,
                 "It is in use by " + listed(device.holders) + ". Close that, then run doctor again.");
    } else if (options.ask == Ask::nothing) {
        device.state = Readiness::notAsked;
    } else if (options.ask == Ask::whenNoCore && !options.core.empty()) {
        device.state = Readiness::notAsked;
        device.remarks.emplace_back("An output core runs, so it was not asked how it is. --ask does that; patterns "
                                    "that a projector shows are disturbed for a moment.");
    } else {
        return true;
    }
    return false;
}

/// The system takes a moment to forget a device, and a bus that is open does not see it go by itself.
bool goneNow(const UsbIdentity& identity, const Clock& clock) {
    constexpr int kLooks = 5;
    constexpr std::chrono::milliseconds kPause{50};
    const std::vector<UsbModel> models = {{identity.vendor, identity.product}};
    for (int looks = 0; looks < kLooks; ++looks) {
        if (looks > 0) clock.wait(kPause);
        const auto bus = UsbBus::open();
        const auto now = bus ? (*bus)->devices(models) : tl::unexpected(bus.error());
        if (now && std::none_of(now->begin(), now->end(),
                                [&](const UsbIdentity& other) { return other.path == identity.path; }))
            return true;
    }
    return false;
}

/// Asking failed. What is no longer listed has been unplugged, whatever the failed call said.
void failed(Attached& device, Readiness state, const Error& error, const UsbIdentity& identity, const Clock& clock) {
    if (goneNow(identity, clock))
        troubled(device, Readiness::gone, "It was unplugged while it was looked at.");
    else
        troubled(device, state, error.what);
}

void lookAtUsb(Attached& device, const UsbIdentity& identity, UsbBus& bus, const SurveyOptions& options) {
    if (!judgedFromOutside(device, options, "Run: " + installCommand() + ", then unplug it and plug it in again."))
        return;
    auto link = bus.link(identity.path, dlpc350::LightCrafter::kInterface);
    if (!link) return failed(device, Readiness::busy, link.error(), identity, options.clock);
    const auto told = device.kind == DeviceKind::projector ? askLightCrafter(device, *std::move(link), options.clock)
                                                           : askConverter(device, **link);
    if (!told) failed(device, Readiness::silent, told.error(), identity, options.clock);
}

void lookAtSerial(Attached& device, const UsbIdentity& identity, const SurveyOptions& options) {
    if (device.node.empty())
        return troubled(device, Readiness::silent,
                        "It has no serial port yet. Wait a second and run doctor again; if it stays so, the kernel's "
                        "driver is missing: sudo modprobe cdc_acm");
    if (!judgedFromOutside(device, options,
                           "Run: " + installCommand() +
                               ", then unplug it and plug it in again; or join the group dialout (" +
                               joinCommand("dialout") + ") and log in again."))
        return;
    const auto port = openSerialPort(device.node);
    if (!port) return failed(device, Readiness::busy, port.error(), identity, options.clock);
    const auto told = askLensDriver(device, **port, options.clock);
    if (!told) failed(device, Readiness::silent, told.error(), identity, options.clock);
}

Attached lookedAt(const UsbIdentity& identity, UsbBus& bus, const SurveyOptions& options) {
    const KnownDevice& known = knownAs(identity);
    Attached device;
    device.kind = known.kind;
    device.name = known.name;
    device.where = identity.path;
    device.usb = numbersOf(identity);
    device.product = identity.productName;
    device.serial = identity.serial;
    device.firmware = usbReleaseOf(identity, options.places);
    device.node =
        (known.serial ? serialPortOf(identity, options.places) : usbNodeOf(identity, options.places)).string();
    if (!known.driven) {
        device.state = Readiness::unsupported;
        device.remarks.emplace_back("This version has no driver for it, and leaves it alone.");
    } else if (known.serial) {
        lookAtSerial(device, identity, options);
    } else {
        lookAtUsb(device, identity, bus, options);
    }
    return device;
}

Attached lookedAt(const CameraEntry& camera, const SurveyOptions& options) {
    Attached device;
    device.kind = DeviceKind::camera;
    device.name = camera.name;
    device.where = camera.id;
    device.node = camera.device.string();
    // Cameras are judged from outside only: opening one switches its light on.
    SurveyOptions outside = options;
    outside.ask = Ask::evenWithCore;
    if (judgedFromOutside(device, outside, "Join the group video (" + joinCommand("video") + ") and log in again."))
        device.state = Readiness::ready;
    if (device.state == Readiness::ready && !device.holders.empty())
        device.remarks.push_back("It is open in " + listed(device.holders) + "; only one program gets its pictures.");
    if (camera.byPort)
        device.remarks.emplace_back("It has no serial number, so a project remembers the port it is plugged into.");
    return device;
}

}  // namespace

Result<std::vector<Attached>> survey(const SurveyOptions& options) {
    const auto bus = UsbBus::open();
    if (!bus) return tl::unexpected(bus.error());
    const auto found = (*bus)->devices(knownModels());
    if (!found) return tl::unexpected(found.error());
    std::vector<Attached> all;
    for (const UsbIdentity& identity : *found)
        all.push_back(lookedAt(identity, **bus, options));
    std::stable_sort(all.begin(), all.end(), [](const Attached& a, const Attached& b) { return a.kind < b.kind; });
    for (const CameraEntry& camera : listCameras(options.places / "dev/v4l"))
        if (!camera.device.empty()) all.push_back(lookedAt(camera, options));
    return all;
}

std::string word(DeviceKind kind) {
    switch (kind) {
    case DeviceKind::projector:
        return "projector";
    case DeviceKind::converter:
        return "converter";
    case DeviceKind::lensDriver:
        return "lens driver";
    case DeviceKind::camera:
        break;
    }
    return "camera";
}

std::string word(Readiness state) {
    switch (state) {
    case Readiness::ready:
        return "ready";
    case Readiness::notAsked:
        return "not-asked";
    case Readiness::inOurUse:
        return "in-our-use";
    case Readiness::noPermission:
        return "no-permission";
    case Readiness::busy:
        return "busy";
    case Readiness::silent:
        return "silent";
    case Readiness::trouble:
        return "trouble";
    case Readiness::unsupported:
        return "unsupported";
    case Readiness::gone:
        break;
    }
    return "gone";
}

bool unusable(Readiness state) {
    return state == Readiness::noPermission || state == Readiness::busy || state == Readiness::silent ||
           state == Readiness::trouble;
}

}  // namespace ilf::devices
