#include "devices/emulators/lens_driver.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

namespace ilf::devices::emulators {

namespace {

constexpr int kFullScale = 4095;  // the vendor's table of commands; its manual says 4096 (devices.md 8, point 4)
constexpr std::int64_t kGivesUp_ns = 200'000'000;  // on half a message; not documented

/// CRC-16/ARC bit by bit: polynomial 8005 reflected, from 0 (devices.md 2.1).
std::uint16_t checksum(std::span<const std::uint8_t> bytes) {
    std::uint16_t crc = 0;
    for (const std::uint8_t byte : bytes) {
        crc = static_cast<std::uint16_t>(crc ^ byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = static_cast<std::uint16_t>((crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U);
    }
    return crc;
}

struct Command {
    std::string_view name;
    std::size_t data;  ///< bytes between the name and the checksum
};
constexpr Command kCommands[] = {
    {"H", 0},    {"F", 0},    {"J", 0},    {"V", 0},    {"X", 0},    {"IR", 8},   {"Aw", 2},    {"Ar", 2},
    {"CwMA", 2}, {"CrMA", 2}, {"CwUA", 2}, {"CwLA", 2}, {"CrUA", 2}, {"CrLA", 2}, {"MwDA", 0},  {"MwSA", 0},
    {"MwTA", 0}, {"MwQA", 0}, {"MwCA", 0}, {"MwAA", 0}, {"MMA", 0},  {"PwFA", 4}, {"PrFA", 4},  {"PwUA", 4},
    {"PwLA", 4}, {"PrUA", 4}, {"PrLA", 4}, {"PwTA", 4}, {"PrTA", 4}, {"PwDA", 4}, {"PrDA", 4},  {"TCA", 0},
    {"Sr", 0},   {"Y", 4},    {"Ow", 2},   {"Or", 2},   {"GAA", 0},  {"QwTA", 0}, {"RESET", 0}, {"Zw", 2},
};

constexpr std::string_view kStart = "Start", kReady = "Ready\r\n";

std::string_view text(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::int16_t signed16(std::span<const std::uint8_t> data, std::size_t offset = 0) {
    return static_cast<std::int16_t>(data[offset] << 8U | data[offset + 1]);
}

struct Reply {
    Bytes bytes;

    explicit Reply(std::string_view name) : bytes(name.begin(), name.end()) {}
    Reply& byte(int value) {
        bytes.push_back(static_cast<std::uint8_t>(value));
        return *this;
    }
    Reply& word(int value) { return byte(value >> 8).byte(value); }
    Bytes sealed() {
        const std::uint16_t crc = checksum(bytes);
        byte(crc).byte(crc >> 8U);  // the checksum alone has its low byte first
        return byte('\r').byte('\n').bytes;
    }
};

/// Static power of the coil at a current and temperature: a rounded polynomial of published measurements of one
/// EL-16-40-TC (scheduling.md 2), good for behaving like a lens and for nothing else.
double staticPower_D(double current_mA, double temperature_C) {
    const double x = current_mA / 100.0;
    const double table = 0.51 + x * (6.88 + x * (-0.315 + x * (-0.441 + x * (0.051 + x * 0.030))));
    return table + (0.034 - 0.012 * x) * (temperature_C - 30.0);
}

}  // namespace

EmulatedLensDriver::EmulatedLensDriver(LensDriverOptions options)
    : options_(options), maximum_(static_cast<std::uint16_t>(std::lround(options.maximum_mA * 100.0))),
      coil_C_(options.ambient_C), ambient_C_(options.ambient_C) {}

void EmulatedLensDriver::powerCycle(std::int64_t now_ns) {
    warm(now_ns);
    buffer_.clear();
    mode_ = Mode::current;
    code_ = upper_ = lower_ = 0;
    frequency_mHz_ = 1000;
    temperatureLimits_.reset();
    unreachable_ = harmed_ = false;
}

SerialAnswer EmulatedLensDriver::receive(std::span<const std::uint8_t> bytes, std::int64_t now_ns) {
    warm(now_ns);
    const std::size_t passing = faults_.passBefore(Mishap::unplug, bytes.size());
    if (now_ns - lastByte_ns_ > kGivesUp_ns) buffer_.clear();
    lastByte_ns_ = now_ns;
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.begin() + std::ptrdiff_t(passing));

    SerialAnswer answer;
    answer.gone = passing < bytes.size();
    while (!buffer_.empty() && !harmed_) {
        const std::string_view received = text(buffer_);
        Bytes reply;
        std::size_t used = buffer_.size();
        if (received.starts_with(kStart)) {
            used = kStart.size();
            code_ = 0;
            mode_ = Mode::current;
            reply.assign(kReady.begin(), kReady.end());
        } else if (const auto* command = std::ranges::find_if(
                       kCommands, [&](const Command& known) { return received.starts_with(known.name); });
                   command != std::end(kCommands)) {
            used = command->name.size() + command->data + 2;
            if (buffer_.size() < used) break;
            const auto message = std::span(buffer_).first(used);
            if (faults_.strikes(Mishap::wrongMode)) mode_ = Mode::current;
            const bool silent = faults_.strikes(Mishap::silence);
            if (silent) {
                // neither obeyed nor answered
            } else if (faults_.strikes(Mishap::nack) || checksum(message) != 0)
                reply = error(1);
            else
                reply = obey(message, now_ns);
        } else {
            const auto begins = [&](std::string_view name) { return name.starts_with(received); };
            if (begins(kStart) || std::ranges::any_of(kCommands, begins, &Command::name)) break;
            reply = error(3);
        }
        buffer_.erase(buffer_.begin(), buffer_.begin() + std::ptrdiff_t(used));
        if (!reply.empty() && faults_.strikes(Mishap::stall)) reply.erase(reply.begin() + 1);
        answer.reply.insert(answer.reply.end(), reply.begin(), reply.end());
    }
    if (harmed_) buffer_.clear();
    if (answer.gone) buffer_.clear();
    return answer;
}

Bytes EmulatedLensDriver::error(int id) const {
    if (options_.oldFirmware) return {'N', '\r', '\n'};
    return Reply("E").byte(id).sealed();
}

// Where devices.md gives no reply, it is what public drivers take the answer for: the letters of the command without
// its w or r, then the value.
Bytes EmulatedLensDriver::obey(std::span<const std::uint8_t> message, std::int64_t now_ns) {
    const auto* command =
        std::ranges::find_if(kCommands, [&](const Command& known) { return text(message).starts_with(known.name); });
    const std::string_view name = command->name;
    const auto data = message.subspan(name.size(), command->data);
    const auto code = [&] { return std::clamp<int>(signed16(data), -kFullScale, kFullScale); };

    if (name == "RESET" || name == "Zw") {
        harmed_ = true;
        return {};
    }
    if (name == "Aw") return code_ = code(), Bytes{};
    if (name == "Ar") return Reply("A").word(code_).sealed();
    if (name == "H") return Reply("H").byte(options_.firmwareType).sealed();
    if (name == "F") return Reply("F").byte(0).sealed();
    if (name == "J") return Reply("J").byte('L').byte('D').byte('4').sealed();
    if (name == "V") return Reply("V").byte(1).byte(8).word(60).word(4512).sealed();
    if (name == "X")
        return Reply(options_.hasLensMemory ? "XANAB0042" : std::string_view("X\0\0\0\0\0\0\0\0", 9)).sealed();
    if (name == "IR") return Reply("IREMULATED").sealed();
    if (name == "MMA") return Reply("MMA").byte(int(mode_)).sealed();
    if (name.starts_with("Mw")) return setMode(message[2], now_ns);
    if (name == "TCA") return Reply("TCA").word(int(std::lround(sensed_C() / 0.0625))).sealed();
    if (name == "Sr") {
        const std::uint32_t word = statusWord();
        return Reply("S").word(int(word >> 16U)).word(int(word & 0xFFFFU)).sealed();
    }
    if (name == "GAA") return Reply("GAA").word(int(std::clamp(analog_V_ / 5.0, 0.0, 1.0) * 1023.0)).sealed();
    if (name == "QwTA") return Reply("QTA").sealed();

    if (name == "CrMA") return Reply("CMA").word(maximum_).sealed();
    if (name == "CrUA") return Reply("CUA").word(upperLimit_).sealed();
    if (name == "CrLA") return Reply("CLA").word(lowerLimit_).sealed();
    if (name.starts_with("Cw")) {
        ++memoryWrites_;
        if (name == "CwUA") return upperLimit_ = code(), Reply("CUA").word(upperLimit_).sealed();
        if (name == "CwLA") return lowerLimit_ = code(), Reply("CLA").word(lowerLimit_).sealed();
        const auto most = static_cast<std::uint16_t>(std::lround(options_.maximum_mA * 100.0));
        maximum_ = std::min(most, static_cast<std::uint16_t>(signed16(data)));
        return Reply("CMA").word(maximum_).sealed();
    }

    if (name == "PwFA") {
        const std::uint32_t wanted =
            std::uint32_t(data[0]) << 24U | std::uint32_t(data[1]) << 16U | std::uint32_t(data[2]) << 8U | data[3];
        const double reached = phase(now_ns);
        frequency_mHz_ = std::clamp<std::uint32_t>(wanted, 200, 2'000'000);
        phaseAtStart_ = options_.phaseJumps ? 0.0 : reached;
        waveFrom_ns_ = now_ns;
        return {};
    }
    if (name == "PrFA")
        return Reply("PFA").word(int(frequency_mHz_ >> 16U)).word(int(frequency_mHz_ & 0xFFFFU)).sealed();
    if (name == "PwUA") return upper_ = code(), Bytes{};
    if (name == "PwLA") return lower_ = code(), Bytes{};
    if (name == "PrUA") return Reply("PUA").word(upper_).sealed();
    if (name == "PrLA") return Reply("PLA").word(lower_).sealed();

    if (!hasFocalPower()) return error(2);
    if (!options_.hasLensMemory) return error(4);
    if (name == "Or") return Reply("Or").word(driftGain_).sealed();
    if (name == "Y") {
        const double power = staticPower_D(codeCurrent_mA(code()), signed16(data, 2) / 256.0);
        return Reply("Y").word(powerCode(power)).sealed();
    }
    if (name == "PwDA") {
        target_D_ = powerOfCode(signed16(data));
        const auto [least, most] = powerRange();
        unreachable_ = target_D_ < least || target_D_ > most;
        return {};
    }
    if (name == "PrDA") return Reply("PDA").word(powerCode(power_D(now_ns))).sealed();
    if (name == "Ow") {
        driftGain_ = static_cast<std::uint16_t>(std::clamp<int>(signed16(data), 0, 500));
        const auto [least, most] = powerRange();
        return Reply("Ow").byte(int(statusWord() & 0xFFU)).word(powerCode(most)).word(powerCode(least)).sealed();
    }
    if (name == "PwTA") {
        if (signed16(data, 0) < signed16(data, 2)) return error(3);
        temperatureLimits_ = {signed16(data, 0), signed16(data, 2)};
    }
    const auto [least, most] = powerRange();  // PwTA, PrTA
    return Reply("PTA").word(powerCode(most)).word(powerCode(least)).sealed();
}

Bytes EmulatedLensDriver::setMode(std::uint8_t letter, std::int64_t now_ns) {
    waveFrom_ns_ = now_ns;
    phaseAtStart_ = 0.0;
    const std::string name = {'M', char(letter), 'A'};
    if (letter != 'C') {
        mode_ = letter == 'D'   ? Mode::current
                : letter == 'S' ? Mode::sine
                : letter == 'T' ? Mode::triangle
                : letter == 'Q' ? Mode::square
                                : Mode::analog;
        return Reply(name).sealed();
    }
    if (!hasFocalPower()) return error(2);
    if (!options_.hasLensMemory) return error(4);
    mode_ = Mode::focalPower;
    const auto [least, most] = powerRange();
    return Reply(name).byte(int(statusWord() & 0xFFU)).word(powerCode(most)).word(powerCode(least)).sealed();
}

double EmulatedLensDriver::codeCurrent_mA(double code) const { return code / kFullScale * options_.maximum_mA; }

double EmulatedLensDriver::limited_mA(double current) const {
    const double most = std::min(maximum_ / 100.0, options_.maximum_mA);
    const double upper = std::min(most, codeCurrent_mA(upperLimit_));
    const double lower = std::max(-most, codeCurrent_mA(lowerLimit_));
    return std::max(std::min(current, upper), lower);
}

/// In periods since the wave began.
double EmulatedLensDriver::phase(std::int64_t time_ns) const {
    const double drift = options_.crystal_ppm - faults_.amount(Mishap::clockDrift);
    const double frequency_Hz = frequency_mHz_ / 1000.0 * (1.0 + drift * 1e-6);
    return phaseAtStart_ + double(time_ns - waveFrom_ns_) * 1e-9 * frequency_Hz;
}

double EmulatedLensDriver::current_mA(std::int64_t time_ns) const {
    if (harmed_) return 0.0;
    const double middle = codeCurrent_mA((upper_ + lower_) / 2.0), swing = codeCurrent_mA((upper_ - lower_) / 2.0);
    const double turns = phase(time_ns), part = turns - std::floor(turns);
    switch (mode_) {
    case Mode::current:
        return limited_mA(codeCurrent_mA(code_));
    case Mode::sine:
        return limited_mA(middle + swing * std::sin(2.0 * std::numbers::pi * part));
    case Mode::triangle: {
        const double up = std::abs(2.0 * std::fmod(part + 0.75, 1.0) - 1.0);
        return limited_mA(middle + swing * (2.0 * up - 1.0));
    }
    case Mode::square:
        return limited_mA(middle + (part < 0.5 ? swing : -swing));
    case Mode::focalPower:
        return currentFor(target_D_);
    case Mode::analog: {
        const double tenBit = std::floor(std::clamp(analog_V_ / 5.0, 0.0, 1.0) * 1023.0);
        return limited_mA(codeCurrent_mA((2.0 * tenBit / 1023.0 - 1.0) * kFullScale));
    }
    }
    return 0.0;
}

double EmulatedLensDriver::power_D(std::int64_t time_ns) const { return staticPower_D(current_mA(time_ns), coil_C_); }

bool EmulatedLensDriver::pinA(std::int64_t time_ns) const {
    const bool waves = mode_ == Mode::sine || mode_ == Mode::triangle || mode_ == Mode::square;
    const double turns = phase(time_ns);
    return waves && turns - std::floor(turns) < 0.5;
}

/// The current that the driver's own calibration expects to give this power at the temperature its sensor tells.
double EmulatedLensDriver::currentFor(double power_D) const {
    const double believed_C = 30.0 + driftGain_ / 100.0 * (sensed_C() - 30.0);
    double low = limited_mA(-options_.maximum_mA), high = limited_mA(options_.maximum_mA);
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2.0;
        (staticPower_D(middle, believed_C) < power_D ? low : high) = middle;
    }
    return (low + high) / 2.0;
}

/// What can be had at every temperature between the limits; at the present one where none were set.
std::array<double, 2> EmulatedLensDriver::powerRange() const {
    const double present = sensed_C();
    const double warmest = temperatureLimits_ ? (*temperatureLimits_)[0] / 16.0 : present;
    const double coldest = temperatureLimits_ ? (*temperatureLimits_)[1] / 16.0 : present;
    const double upper = limited_mA(options_.maximum_mA), lower = limited_mA(-options_.maximum_mA);
    return {std::max(staticPower_D(lower, warmest), staticPower_D(lower, coldest)),
            std::min(staticPower_D(upper, warmest), staticPower_D(upper, coldest))};
}

std::uint16_t EmulatedLensDriver::powerCode(double power_D) const {
    const double shifted = options_.firmwareType == 'A' ? power_D + 5.0 : power_D;
    return static_cast<std::uint16_t>(
        static_cast<std::int16_t>(std::clamp<long>(std::lround(shifted * 200.0), -32768, 32767)));
}

double EmulatedLensDriver::powerOfCode(std::int16_t code) const {
    return code / 200.0 - (options_.firmwareType == 'A' ? 5.0 : 0.0);
}

// devices.md 2.1: of the last byte b1 memory, b2 no temperature limits, b3 power not reachable, b5 temperature outside
// the specification (not given there; 0 to 80 degrees here), b7 outside the user's limits; of the third b0 lens not
// compatible.
std::uint32_t EmulatedLensDriver::statusWord() const {
    const double sensed = sensed_C();
    std::uint32_t word = 0;
    if (!options_.hasLensMemory) word |= 2U | 0x100U;
    if (!temperatureLimits_) word |= 4U;
    if (unreachable_) word |= 8U;
    if (sensed < 0.0 || sensed > 80.0) word |= 32U;
    if (temperatureLimits_ && (sensed * 16.0 > (*temperatureLimits_)[0] || sensed * 16.0 < (*temperatureLimits_)[1]))
        word |= 128U;
    return word;
}

void EmulatedLensDriver::setAmbient(double ambient_C, std::int64_t now_ns) {
    warm(now_ns);
    ambient_C_ = ambient_C;
}

double EmulatedLensDriver::temperature_C(std::int64_t now_ns) {
    warm(now_ns);
    return sensed_C();
}

/// The coil's warmth follows its mean square current: 12.5 ohm, 25 K/W, 180 s (assumed, scheduling.md 2).
void EmulatedLensDriver::warm(std::int64_t now_ns) {
    const double seconds = double(now_ns - warmedTo_ns_) * 1e-9;
    if (seconds <= 0.0) return;
    const double middle = codeCurrent_mA((upper_ + lower_) / 2.0), swing = codeCurrent_mA((upper_ - lower_) / 2.0);
    double square = std::pow(current_mA(now_ns), 2);
    if (mode_ == Mode::sine) square = middle * middle + swing * swing / 2.0;
    if (mode_ == Mode::triangle) square = middle * middle + swing * swing / 3.0;
    if (mode_ == Mode::square) square = middle * middle + swing * swing;
    const double settles_C = ambient_C_ + 25.0 * 12.5 * square * 1e-6;
    coil_C_ = settles_C + (coil_C_ - settles_C) * std::exp(-seconds / 180.0);
    warmedTo_ns_ = now_ns;
}

}  // namespace ilf::devices::emulators
