#include "devices/simulated/virtual_stage.h"

#include <algorithm>
#include <array>

namespace ilf::devices {
namespace {

const char* orderName(const Body& request) {
    static constexpr std::array kNames{
        "hello", "load",          "ack",           "refused",  "safe light", "status", "wave", "rate",
        "swap",  "steady light",  "lens to rest",  "read",     "slot",       "inject", "done", "slot image",
        "state", "read received", "read exposure", "received", "exposed",    "mishap"};
    static_assert(kNames.size() == std::variant_size_v<Body>);
    return kNames[request.index()];
}

}  // namespace

Result<Body> VirtualPort::call(const Body& request) {
    log.emplace_back(orderName(request));
    if (failsAt && failsAt(request))
        return fail(Fault::device, std::string("The order was lost: ") + orderName(request));
    if (std::holds_alternative<ProgramUpdate>(request)) waitUntil(nowNs_ + std::int64_t(loadTime.in(1.0_s) * 1e9));
    return machine.answered(request, nowNs_);
}

void VirtualPort::waitUntil(std::int64_t time_ns) {
    nowNs_ = std::max(nowNs_, time_ns);
    machine.advance(nowNs_);
}

}  // namespace ilf::devices
