#include "devices/osc/pose_message.h"

#include <lo/lo.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

namespace ilf::devices {

namespace {

constexpr int kDeepest = 8;
constexpr std::size_t kHeader = 16;          // "#bundle\0" and a time tag
constexpr double kNtpOfUnix = 2208988800.0;  // seconds from 1900 to 1970
/// A tag farther from now than this is another clock's, not a time.
constexpr double kOldest_s = 1.0;

using Message = std::unique_ptr<std::remove_pointer_t<lo_message>, decltype(&lo_message_free)>;

std::uint32_t word(std::span<const std::byte> at) {
    std::uint32_t v = 0;
    for (std::size_t i = 0; i < 4; ++i)
        v = v << 8U | static_cast<std::uint32_t>(at[i]);
    return v;
}

Error bad(const std::string& what) { return {Fault::badFile, "An OSC message was ignored: " + what + "."}; }

template <class T>
double numberAt(const void* at) {
    T value{};
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
}

/// liblo's arguments lie on multiples of four bytes, too narrow for its lo_arg: they are copied, never pointed into.
std::optional<double> number(char type, const void* at) {
    switch (type) {
    case LO_INT32:
        return numberAt<std::int32_t>(at);
    case LO_INT64:
        return numberAt<std::int64_t>(at);
    case LO_FLOAT:
        return numberAt<float>(at);
    case LO_DOUBLE:
        return numberAt<double>(at);
    default:
        return std::nullopt;
    }
}

bool isPose(std::string_view address) {
    constexpr std::string_view kPrefix = "/pose/";
    if (!address.starts_with(kPrefix)) return false;
    address.remove_prefix(kPrefix.size());
    unsigned n = 0;
    const auto [end, fault] = std::from_chars(address.data(), address.data() + address.size(), n);
    return fault == std::errc{} && end == address.data() + address.size() && n <= 65535;
}

/// A printable part of an address that anyone may have sent.
std::string spoken(std::string_view address) {
    std::string plain(address.substr(0, 40));
    std::ranges::replace_if(plain, [](char c) { return c < ' ' || c > '~'; }, '?');
    return plain;
}

/// The address if the bytes begin with one: a NUL-terminated, padded string.
std::optional<std::string_view> addressOf(std::span<const std::byte> bytes) {
    const auto end = std::ranges::find(bytes, std::byte{0});
    if (bytes.empty() || bytes[0] != std::byte{'/'} || end == bytes.end()) return std::nullopt;
    return std::string_view(reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(end - bytes.begin()));
}

class Reader {
public:
    explicit Reader(double unixNow) : unixNow_(unixNow) {}

    Result<void> read(std::span<const std::byte> bytes, int depth) {
        static constexpr std::string_view kBundle{"#bundle\0", 8};
        const bool bundle = bytes.size() >= kHeader && std::memcmp(bytes.data(), kBundle.data(), 8) == 0;
        return bundle ? readBundle(bytes, depth) : readMessage(bytes);
    }
    OscSays says;

private:
    Result<void> readBundle(std::span<const std::byte> bytes, int depth) {
        if (depth >= kDeepest) return tl::unexpected(bad("bundles in bundles are too deep"));
        const std::uint32_t seconds = word(bytes.subspan(8)), fraction = word(bytes.subspan(12));
        const auto outer = ago_;
        if (seconds != 0) {  // 0 and 1/2^32 s: immediately
            const double at = seconds + fraction / 4294967296.0 - kNtpOfUnix;
            const double ago = unixNow_ - at;
            ago_ = ago >= 0.0 && ago <= kOldest_s ? std::optional(ago) : std::nullopt;
        }
        for (auto rest = bytes.subspan(kHeader); !rest.empty();) {
            if (rest.size() < 4) return tl::unexpected(bad("its bundle is cut short"));
            const std::size_t length = word(rest);
            if (length > rest.size() - 4 || length % 4 != 0) return tl::unexpected(bad("its bundle is cut short"));
            if (auto ok = read(rest.subspan(4, length), depth + 1); !ok) return ok;
            rest = rest.subspan(4 + length);
        }
        ago_ = outer;
        return {};
    }

    Result<void> readMessage(std::span<const std::byte> bytes) {
        const auto address = addressOf(bytes);
        if (!address) return tl::unexpected(bad("these bytes are no OSC"));
        if (!isPose(*address)) {
            says.unknown.push_back(spoken(*address));
            return {};
        }
        // liblo checks padding, types and lengths; it swaps in place, so it gets a copy.
        std::vector<std::byte> copy(bytes.begin(), bytes.end());
        int fault = 0;
        const Message message(lo_message_deserialise(copy.data(), copy.size(), &fault), &lo_message_free);
        const std::string name(*address);
        if (!message) return tl::unexpected(bad(name + " is cut short or not padded as OSC asks"));
        const int count = lo_message_get_argc(message.get());
        const char* types = lo_message_get_types(message.get());
        lo_arg** args = lo_message_get_argv(message.get());
        if (count < 2 || count > 5 || types == nullptr || args == nullptr) {
            return tl::unexpected(bad(name + " has " + std::to_string(count) +
                                      " arguments; send x y, then z, rotation and confidence if they are known"));
        }
        double v[5] = {0.0, 0.0, 0.0, 0.0, 1.0};
        for (int i = 0; i < count; ++i) {
            const auto value = number(types[i], args[i]);
            if (!value || !std::isfinite(*value))
                return tl::unexpected(bad(name + " has an argument that is no number; send floats"));
            v[i] = *value;
        }
        if (std::abs(v[0] - 0.5) > 1.5 || std::abs(v[1] - 0.5) > 1.5)
            return tl::unexpected(
                bad(name + " lies far outside the picture; x and y are 0 to 1 of its width and height"));
        if (count > 2 && (v[2] < 0.0 || v[2] > 1000.0))
            return tl::unexpected(bad(name + " has a z that is not 0 to 1000 m"));
        if (v[4] < 0.0 || v[4] > 1.0) return tl::unexpected(bad(name + " has a confidence that is not 0 to 1"));
        OscPose pose{name, v[0], v[1], std::nullopt, std::fmod(v[3], 360.0), v[4], ago_};
        if (count > 2) pose.z_m = v[2];
        says.poses.push_back(std::move(pose));
        return {};
    }

    double unixNow_;
    std::optional<double> ago_;
};

}  // namespace

Result<OscSays> poseMessage(std::span<const std::byte> datagram, double unixNow) {
    Reader reader(unixNow);
    if (datagram.size() % 4 != 0 || datagram.empty()) return tl::unexpected(bad("these bytes are no OSC"));
    if (auto ok = reader.read(datagram, 0); !ok) return tl::unexpected(ok.error());
    return std::move(reader.says);
}

}  // namespace ilf::devices
