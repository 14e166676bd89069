// How an order reaches lens and projector and when: over a socket with the real clock, or by a call with a virtual one.
#pragma once

#include <cstdint>
#include <utility>

#include "devices/link/messages.h"

namespace ilf::devices {

class DevicePort {
public:
    virtual ~DevicePort() = default;

    /// The devices' answer; it may be Refused. An error means that there was none.
    virtual Result<Body> call(const Body& request) = 0;
    virtual std::int64_t nowNs() = 0;
    virtual void waitUntil(std::int64_t time_ns) = 0;
};

/// Asks for an answer of type `Answer`; anything else is an error.
template <class Answer>
Result<Answer> ask(DevicePort& port, const Body& request) {
    auto answer = port.call(request);
    if (!answer) return tl::unexpected(answer.error());
    if (auto* good = std::get_if<Answer>(&*answer)) return std::move(*good);
    if (const auto* refused = std::get_if<Refused>(&*answer)) return tl::unexpected(refused->error);
    return fail(Fault::device, "Lens and projector answered something else than they were asked.");
}

}  // namespace ilf::devices
