#include "devices/lens_driver/lens_driver.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace ilf::devices {

using lens_driver::Command;
using lens_driver::Frame;
using lens_driver::Mode;

namespace {

// Answers come within a few milliseconds; the rest is for a busy host.
constexpr Milliseconds kAnswer{200};
constexpr Milliseconds kSend{100};
constexpr Milliseconds kQuiet{20};
constexpr std::size_t kChunk = 256;
// Bytes of noise in front of an answer after which the line is given up.
constexpr std::size_t kMostNoise = 4096;

std::string milliamperes(Ampere current) {
    return std::to_string(static_cast<int>(std::lround(current.si() * 1e3))) + " mA";
}

std::string hertz(Hertz frequency) {
    return std::to_string(static_cast<long>(std::lround(frequency.si() * 1e3))) + " mHz";
}

std::string celsius(double value) { return std::to_string(static_cast<int>(std::lround(value))) + " degrees C"; }

std::string hundredths(Dioptre power) {
    const auto text = std::to_string(std::round(power.si() * 100.0) / 100.0);
    return text.substr(0, text.find('.') + 3) + " D";
}

}  // namespace

Result<void> checkedForShow(const Waveform& wave) {
    if (wave.still()) return {};
    return fail(
        Fault::unsupported,
        "The lens driver's own sine runs free on its own crystal and cannot be locked to the projector, so within "
        "seconds the wrong slot would be sharp: use it for bench tests and static powers, and play shows through "
        "the DAC (USB-1208FS-Plus).");
}

LensDriver::LensDriver(std::unique_ptr<SerialLink> link, LensSetup setup, Clock clock)
    : link_(std::move(link)), setup_(std::move(setup)), clock_(std::move(clock)) {}

Result<std::unique_ptr<LensDriver>> LensDriver::open(std::unique_ptr<SerialLink> link, LensSetup setup, Clock clock) {
    std::unique_ptr<LensDriver> driver(new LensDriver(std::move(link), std::move(setup), std::move(clock)));
    if (auto ready = driver->opened(); !ready) return tl::unexpected(std::move(ready.error()));
    return driver;
}

LensDriver::~LensDriver() {
    if (handshake_) rest();
}

Result<void> LensDriver::shakenHands() {
    discarded(Milliseconds(0));
    const std::string_view start = lens_driver::kStart;
    const Bytes bytes(start.begin(), start.end());
    if (auto sent = link_->send(bytes, kSend); !sent) return sent;
    std::string got;
    const auto until = clock_.now() + kAnswer;
    // What else the driver was saying may come before its "Ready".
    while (got.find(lens_driver::kReady) == std::string::npos) {
        const auto left = std::chrono::ceil<Milliseconds>(until - clock_.now());
        if (left.count() <= 0 || got.size() > kMostNoise)
            return fail(Fault::device,
                        "What is on " + link_->name() +
                            " does not answer like a lens driver 4. Choose another port, or plug the lens "
                            "driver in again.");
        const auto more = link_->receive(kChunk, left);
        if (!more) return tl::unexpected(more.error());
        got.append(more->begin(), more->end());
    }
    return {};
}

Result<void> LensDriver::opened() {
    if (auto hands = shakenHands(); !hands) return hands;
    handshake_ = true;
    const auto read = [&](const Command& command, auto decode, auto take) -> Result<void> {
        return asked(command, kAnswer).and_then(decode).map(take);
    };
    Ampere most;
    int low = 0, high = 0;
    using namespace lens_driver;
    auto all = read(readFirmwareType(), firmwareTypeFrom, [&](char type) { facts_.firmwareType = type; })
                   .and_then([&] { return read(readVersion(), versionFrom, [&](Version v) { facts_.version = v; }); })
                   .and_then([&] {
                       return read(readLensSerial(), lensSerialFrom,
                                   [&](std::string serial) { facts_.lensSerial = std::move(serial); });
                   })
                   .and_then([&] { return read(readMaxCurrent(), maxCurrentFrom, [&](Ampere a) { most = a; }); })
                   .and_then([&] { return read(readUpperLimit(), codeFrom, [&](int code) { high = code; }); })
                   .and_then([&] { return read(readLowerLimit(), codeFrom, [&](int code) { low = code; }); })
                   .and_then([&] { return switched(Mode::current); })
                   .and_then([&] { return sendCurrent(Ampere()); });
    if (!all) return all;
    const auto limits = currentLimits(setup_.protection, most, currentOf(low, most), currentOf(high, most));
    if (!(limits.low <= limits.high))
        return fail(Fault::unsafe,
                    "The current limits of the " + setup_.name + " leave no current at all (" +
                        milliamperes(limits.low) + " to " + milliamperes(limits.high) +
                        "). Check the limits in the rig, and those in the driver with Optotune's software.");
    facts_.most = most;
    facts_.limits = limits;
    findPowers();
    if (auto well = heartbeat(); !well) return tl::unexpected(well.error());
    if (auto rested = rest(); !rested) {
        fault_ = rested.error();
        return rested;
    }
    return {};
}

/// Asks for focal power mode; a refusal only means that the lens rests by current.
void LensDriver::findPowers() {
    using namespace lens_driver;
    if (!setup_.restPower || facts_.lensSerial.empty() || !powerCode(*setup_.restPower, facts_.firmwareType)) return;
    const auto limits = asked(setTemperatureLimits(setup_.coldest_C, setup_.warmest_C), kAnswer);
    if (!limits) return;
    mode_.reset();
    const auto range = asked(setMode(Mode::focalPower), kAnswer).and_then([&](const Bytes& data) {
        return powerRangeFrom(data, facts_.firmwareType);
    });
    if (range && range->low <= *setup_.restPower && *setup_.restPower <= range->high) facts_.powers = *range;
    // It goes to rest once its temperature and status are known.
    if (switched(Mode::current)) sendCurrent(Ampere());
}

Result<void> LensDriver::usable() const {
    if (!fault_) return {};
    return fail(Fault::device,
                "The " + setup_.name +
                    " is at rest after a fault. Connect its driver again. The fault was: " + fault_->what);
}

Result<Ampere> LensDriver::holdCurrent(Ampere current) {
    if (auto ok = usable(); !ok) return tl::unexpected(ok.error());
    if (!isFinite(current)) return fail(Fault::outOfRange, "A lens current must be a number.");
    if (mode_ != Mode::current) {
        if (auto mode = switched(Mode::current); !mode) return faulted(mode.error());
    }
    const auto set = sendCurrent(current).and_then([&] { return heartbeat(); });
    if (!set) return fault_ ? tl::unexpected(set.error()) : faulted(set.error());
    return lens_driver::currentOf(code_, facts_.most);
}

Result<void> LensDriver::holdPower(Dioptre power) {
    if (auto ok = usable(); !ok) return ok;
    if (!facts_.powers)
        return fail(Fault::unsupported,
                    "The " + setup_.name +
                        " takes no focal powers: its driver's firmware or its memory does not allow "
                        "them, or its rig names no resting power. Give it a calibration instead.");
    if (!(facts_.powers->low <= power && power <= facts_.powers->high))
        return fail(Fault::outOfRange, "The " + setup_.name + " reaches " + hundredths(facts_.powers->low) + " to " +
                                           hundredths(facts_.powers->high) + " and cannot hold " + hundredths(power) +
                                           ".");
    if (mode_ != Mode::focalPower) {
        if (auto mode = switched(Mode::focalPower); !mode) return faulted(mode.error());
    }
    const auto set = sendPower(power).and_then([&] { return heartbeat(); });
    if (!set) return fault_ ? tl::unexpected(set.error()) : faulted(set.error());
    return {};
}

Result<void> LensDriver::sineForBench(Hertz frequency, Ampere low, Ampere high) {
    if (auto ok = usable(); !ok) return ok;
    if (!(frequency >= 0.2_Hz && frequency <= 500.0_Hz))
        return fail(Fault::outOfRange, "A lens driver's sine has 0.2 to 500 Hz.");
    if (!(low <= high)) return fail(Fault::outOfRange, "A sine's lower current must not be above its upper one.");
    frequency_ = Hertz::fromSi(std::round(frequency.si() * 1e3) / 1e3);
    // Swing and frequency first: the sine must never run with what was left over from another time.
    const auto set = told(lens_driver::setUpperSwing(codeFor(high)))
                         .and_then([&] { return told(lens_driver::setLowerSwing(codeFor(low))); })
                         .and_then([&] {
                             const auto milliHertz = static_cast<std::uint32_t>(std::lround(frequency_.si() * 1e3));
                             return told(lens_driver::setFrequency(milliHertz));
                         })
                         .and_then([&] { return switched(Mode::sine); })
                         .and_then([&] { return heartbeat(); });
    if (!set) return fault_ ? tl::unexpected(set.error()) : faulted(set.error());
    return {};
}

Result<LensDriverState> LensDriver::heartbeat() {
    if (auto ok = usable(); !ok) return tl::unexpected(ok.error());
    auto state = readBack();
    if (!state) return faulted(state.error());
    return state;
}

Result<LensDriverState> LensDriver::readBack() {
    using namespace lens_driver;
    LensDriverState state;
    const auto mode = asked(readMode(), kAnswer).and_then(modeFrom);
    if (!mode) return tl::unexpected(mode.error());
    if (*mode != mode_)
        return fail(Fault::device, "The driver of the " + setup_.name + " is in the mode \"" +
                                       std::string(word(*mode)) + "\" instead of \"" +
                                       std::string(mode_ ? word(*mode_) : "?") +
                                       "\": another program or a restart changed it. Connect it again.");
    state.mode = *mode;
    const auto code = asked(readCurrent(), kAnswer).and_then(codeFrom);
    if (!code) return tl::unexpected(code.error());
    state.current = currentOf(*code, facts_.most);
    // Drivers that scale by 4096 may answer with a neighbouring code.
    if (mode_ == Mode::current && std::abs(*code - code_) > 1)
        return fail(Fault::device, "The driver of the " + setup_.name + " says that " + milliamperes(state.current) +
                                       " flow instead of " + milliamperes(currentOf(code_, facts_.most)) +
                                       ". Connect it again; if this comes back, check lens and cable.");
    if (!allowed(state.current))
        return fail(Fault::unsafe, "The driver of the " + setup_.name + " drives " + milliamperes(state.current) +
                                       ", more than the rig allows. Choose a smaller power, or check the rig's limit.");
    if (mode_ == Mode::sine) {
        const auto frequency = asked(readFrequency(), kAnswer).and_then(frequencyFrom);
        if (!frequency) return tl::unexpected(frequency.error());
        if (abs(*frequency - frequency_) > Hertz::fromSi(0.0015))
            return fail(Fault::device, "The driver of the " + setup_.name + " sweeps at " + hertz(*frequency) +
                                           " instead of " + hertz(frequency_) + ". Connect it again.");
    }
    const auto temperature = asked(readTemperature(), kAnswer).and_then(temperatureFrom);
    if (!temperature) return tl::unexpected(temperature.error());
    state.temperature_C = *temperature;
    if (*temperature > setup_.protection.stopAbove_C)
        return fail(Fault::unsafe, "The " + setup_.name + " has " + celsius(*temperature) + ", more than the " +
                                       celsius(setup_.protection.stopAbove_C) +
                                       " its rig allows. Let it cool down, and use a smaller sweep.");
    const auto status = asked(readStatus(), kAnswer).and_then(statusFrom);
    if (!status) return tl::unexpected(status.error());
    state.status = *status;
    if (status->hardware || status->incompatible)
        return fail(Fault::device, "The driver of the " + setup_.name + " is not well: " + words(*status).front() +
                                       ". Check the lens and its cable.");
    if (*temperature > setup_.protection.warnAbove_C)
        state.warnings.push_back("the " + setup_.name + " is warm: " + celsius(*temperature));
    // Without focal powers, what they would need is no news.
    if (mode_ == Mode::focalPower) {
        for (auto& clause : words(*status))
            state.warnings.push_back(std::move(clause));
    }
    return state;
}

Result<void> LensDriver::drained() {
    Bytes waiting;
    for (;;) {
        const auto more = link_->receive(kChunk, Milliseconds(0));
        if (!more) return tl::unexpected(more.error());
        if (more->empty() || waiting.size() > kMostNoise) break;
        waiting.insert(waiting.end(), more->begin(), more->end());
    }
    lens_driver::View view(waiting);
    while (!view.empty()) {
        const auto frame = lens_driver::framed(view, {});
        if (frame.kind == Frame::Kind::error || frame.kind == Frame::Kind::unknown)
            return tl::unexpected(refusal({"do what it was told before", {}, {}}, frame));
        view = view.subspan(std::max<std::size_t>(frame.used, 1));
    }
    return {};
}

void LensDriver::discarded(Milliseconds quiet) {
    for (std::size_t taken = 0; taken < kMostNoise;) {
        const auto more = link_->receive(kChunk, quiet);
        if (!more || more->empty()) return;
        taken += more->size();
    }
}

Error LensDriver::refusal(const Command& command, const Frame& frame) const {
    const auto why = frame.kind == Frame::Kind::unknown ? std::string("its firmware is too old for that command")
                                                        : lens_driver::errorWords(frame.error);
    return {Fault::unsupported, "The driver of the " + setup_.name + " on " + link_->name() + " would not " +
                                    std::string(command.name) + ": " + why + "."};
}

Result<void> LensDriver::told(const Command& command) { return link_->send(command.bytes, kSend); }

Result<Bytes> LensDriver::asked(const Command& command, Milliseconds limit) {
    if (auto quiet = drained(); !quiet) return tl::unexpected(quiet.error());
    if (auto sent = told(command); !sent) return tl::unexpected(sent.error());
    const auto until = clock_.now() + limit;
    Bytes received;
    for (std::size_t noise = 0; noise < kMostNoise;) {
        const auto frame = lens_driver::framed(received, command.answer);
        received.erase(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(frame.used));
        switch (frame.kind) {
        case Frame::Kind::answer:
            return frame.data;
        case Frame::Kind::noise:
            noise += frame.used;
            continue;
        case Frame::Kind::error:
        case Frame::Kind::unknown:
            // If it was about an earlier command, the answer to this one is still to come and must not be taken for
            // that to the next.
            discarded(kQuiet);
            return tl::unexpected(refusal(command, frame));
        case Frame::Kind::more:
            break;
        }
        const auto left = std::chrono::ceil<Milliseconds>(until - clock_.now());
        if (left.count() <= 0) break;
        const auto more = link_->receive(kChunk, left);
        if (!more) return tl::unexpected(more.error());
        received.insert(received.end(), more->begin(), more->end());
    }
    return fail(Fault::device, "The driver of the " + setup_.name + " on " + link_->name() +
                                   " did not answer when asked to " + std::string(command.name) +
                                   ". Check its USB cable and connect it again.");
}

Result<void> LensDriver::switched(Mode mode) {
    mode_.reset();
    return asked(lens_driver::setMode(mode), kAnswer).map([&](const Bytes&) { mode_ = mode; });
}

int LensDriver::codeFor(Ampere current) const {
    return facts_.most > Ampere() ? lens_driver::codeOf(clamped(current, facts_.limits), facts_.most) : 0;
}

bool LensDriver::allowed(Ampere flowing) const {
    const Ampere step = lens_driver::currentOf(2, facts_.most);
    return flowing <= facts_.limits.high + step && flowing >= facts_.limits.low - step;
}

Result<void> LensDriver::sendCurrent(Ampere current) {
    code_ = codeFor(current);
    return told(lens_driver::setCurrent(code_));
}

Result<void> LensDriver::sendPower(Dioptre power) {
    const auto code = lens_driver::powerCode(power, facts_.firmwareType);
    if (!code) return fail(Fault::unsupported, "The driver of the " + setup_.name + " takes no focal powers.");
    power_ = power;
    return told(lens_driver::setFocalPower(*code));
}

}  // namespace ilf::devices
