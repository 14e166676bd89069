#include "devices/survey/ask_device.h"

#include "core/plan/words.h"
#include "devices/dlpc350/lightcrafter.h"
#include "devices/lens_driver/limits.h"
#include "devices/lens_driver/messages.h"
#include "devices/usb1208/messages.h"

namespace ilf::devices {
namespace {

// Answers come within a few milliseconds; the rest is for a busy host.
constexpr Milliseconds kAnswer{300};
/// Bytes of something else before an answer, after which the line is given up.
constexpr std::size_t kMostNoise = 4096;

void judged(Attached& device) { device.state = device.troubles.empty() ? Readiness::ready : Readiness::trouble; }

std::string modeOf(const dlpc350::Findings& found) {
    if (found.display == dlpc350::Display::pattern) return "pattern mode, patterns " + inWords(found.run);
    if (found.source == dlpc350::Source::testPattern) return "its own test pattern";
    const auto& video = found.video;
    return "video mode, " + (video.locked ? "gets " : std::string()) + inWords(video);
}

tl::unexpected<Error> noAnswer(const SerialLink& link, std::string_view question) {
    return fail(Fault::device, "It did not answer when asked to " + std::string(question) + " on " + link.name() +
                                   ". Unplug it and plug it in again; if that does not help, it is no lens driver 4.");
}

/// One question and its answer. What came unasked is passed over.
Result<Bytes> asked(SerialLink& link, const lens_driver::Command& command, const Clock& clock) {
    if (auto sent = link.send(command.bytes, kAnswer); !sent) return tl::unexpected(sent.error());
    const auto until = clock.now() + kAnswer;
    Bytes received;
    for (std::size_t noise = 0; noise < kMostNoise;) {
        const auto frame = lens_driver::framed(received, command.answer);
        using Kind = lens_driver::Frame::Kind;
        received.erase(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(frame.used));
        if (frame.kind == Kind::answer) return frame.data;
        if (frame.kind == Kind::error || frame.kind == Kind::unknown) {
            const std::string why =
                frame.kind == Kind::unknown ? "its firmware is too old for that" : lens_driver::errorWords(frame.error);
            return fail(Fault::device, "It would not " + std::string(command.name) + ": " + why + ".");
        }
        if (frame.kind == Kind::noise) {
            noise += frame.used;
            continue;
        }
        const auto left = std::chrono::ceil<Milliseconds>(until - clock.now());
        if (left.count() <= 0) break;
        const auto more = link.receive(256, left);
        if (!more) return tl::unexpected(more.error());
        received.insert(received.end(), more->begin(), more->end());
    }
    return noAnswer(link, command.name);
}

std::string inWords(const lens_driver::Version& version, char type) {
    return std::to_string(version.major) + "." + std::to_string(version.minor) + "." + std::to_string(version.build) +
           "." + std::to_string(version.revision) + ", type " + type;
}

void judgeLens(Attached& device, const lens_driver::Status& status, double temperature_C) {
    const std::string temperature = ilf::inWords(temperature_C, 1) + " degrees C";
    const LensProtection caution;
    if (temperature_C >= caution.stopAbove_C)
        device.troubles.push_back("The lens is at " + temperature + ": switch its driver off and let it cool.");
    else
        device.remarks.push_back("The lens is at " + temperature + ".");
    if (status.hardware)
        device.troubles.emplace_back("The driver reports a hardware fault: check the lens's cable, then unplug the "
                                     "driver and plug it in again.");
    if (status.incompatible)
        device.troubles.emplace_back("The driver says that this lens does not go with it: check which lens is "
                                     "connected.");
    if (status.eeprom)
        device.remarks.emplace_back("The lens's memory cannot be read (none is connected, or it has none), so it takes "
                                    "no focal powers.");
}

}  // namespace

Result<void> askLightCrafter(Attached& device, std::unique_ptr<UsbLink> link, const Clock& clock) {
    auto board = dlpc350::LightCrafter::open(std::move(link), clock);
    if (!board) return tl::unexpected(board.error());
    auto found = (*board)->findings();
    if (!found) return tl::unexpected(found.error());
    device.firmware = inWords(found->version.application);
    if (!found->firmwareTag.empty()) device.firmware += " (" + found->firmwareTag + ")";
    device.mode = modeOf(*found);
    device.troubles = std::move(found->troubles);
    device.remarks = std::move(found->remarks);
    if (found->display == dlpc350::Display::pattern)
        device.remarks.emplace_back("In pattern mode it cannot tell what video arrives: that is measured when a show "
                                    "is started.");
    judged(device);
    return {};
}

Result<void> askConverter(Attached& device, UsbLink& link) {
    const auto status = link.controlIn(usb1208::kReadStatus, usb1208::kStatusBytes, kAnswer).and_then([](auto data) {
        return usb1208::statusFrom(data);
    });
    if (!status) return tl::unexpected(status.error());
    device.mode = status->outputRuns ? "outputs sweep" : "outputs stand still";
    if (status->inputRuns) device.mode += ", inputs are read";
    if (status->underrun)
        device.remarks.emplace_back("Its outputs once ran out of samples; the next start clears that.");
    const auto memory = link.controlIn(usb1208::kReadInputCalibration, usb1208::kInputCalibrationBytes, kAnswer);
    if (!memory || !usb1208::inputCalibrationsFrom(*memory).factory)
        device.remarks.emplace_back("It has no factory calibration of its inputs: nominal values are used.");
    judged(device);
    return {};
}

Result<void> askLensDriver(Attached& device, SerialLink& link, const Clock& clock) {
    namespace lens = lens_driver;
    const auto type = asked(link, lens::readFirmwareType(), clock).and_then(lens::firmwareTypeFrom);
    if (!type) return tl::unexpected(type.error());
    const auto version = asked(link, lens::readVersion(), clock).and_then(lens::versionFrom);
    if (!version) return tl::unexpected(version.error());
    device.firmware = inWords(*version, *type);
    const auto mode = asked(link, lens::readMode(), clock).and_then(lens::modeFrom);
    if (!mode) return tl::unexpected(mode.error());
    device.mode = lens::word(*mode);
    const auto serial = asked(link, lens::readLensSerial(), clock).and_then(lens::lensSerialFrom);
    if (serial && !serial->empty()) device.remarks.push_back("The lens connected to it is " + *serial + ".");
    const auto temperature = asked(link, lens::readTemperature(), clock).and_then(lens::temperatureFrom);
    if (!temperature) return tl::unexpected(temperature.error());
    const auto status = asked(link, lens::readStatus(), clock).and_then(lens::statusFrom);
    if (!status) return tl::unexpected(status.error());
    judgeLens(device, *status, *temperature);
    device.remarks.emplace_back("It holds static powers only: shows are played through the USB-1208FS-Plus, since its "
                                "own sine cannot be locked to a projector.");
    judged(device);
    return {};
}

}  // namespace ilf::devices
