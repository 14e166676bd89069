#include "devices/simulated/device_client.h"

#include <thread>

#include "devices/link/runtime_directory.h"

namespace ilf::devices {

DeviceClient::DeviceClient(const std::filesystem::path& runtimeDirectory, std::chrono::milliseconds timeout)
    : client_(devicesAddress(runtimeDirectory)), timeout_(timeout) {}

Result<Body> DeviceClient::call(const Body& request) {
    using Clock = std::chrono::steady_clock;
    // The connection stays: answers carry the number of their question, so a late one is passed over, and the devices
    // go on knowing who their player is. ZeroMQ connects again by itself when their process was restarted.
    const auto lost = [&](const char* how) {
        return fail(Fault::device,
                    std::string("The simulated lens and projector ") + how +
                        " in time. The light is steady once they are back; check that their process runs "
                        "and that the machine is not overloaded.");
    };
    // A question is asked twice before the devices count as lost; an order gets that time at once, and a whole program
    // more of it.
    const bool isQuestion = std::holds_alternative<Read>(request) || std::holds_alternative<ReadSlot>(request) ||
                            std::holds_alternative<ReadReceived>(request) ||
                            std::holds_alternative<ReadExposure>(request);
    const auto limit = isQuestion ? timeout_ : (std::holds_alternative<ProgramUpdate>(request) ? 5 : 2) * timeout_;
    const auto deadline = Clock::now() + limit;
    const std::uint64_t id = ++lastId_;
    if (!client_.send({id, request}, timeout_)) return lost("could not be reached");
    while (true) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
        if (left.count() <= 0) return lost("did not answer");
        auto answer = client_.receive(left);
        if (!answer) continue;
        if (!*answer) return tl::unexpected(answer->error());
        if ((*answer)->id == id) return std::move((*answer)->body);
    }
}

std::int64_t DeviceClient::nowNs() { return monotonicNs(); }

void DeviceClient::waitUntil(std::int64_t time_ns) {
    const std::int64_t left = time_ns - monotonicNs();
    if (left > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(left));
}

Result<void> DeviceClient::safeLight() {
    Result<void> done;
    for (int tries = 0; tries < 3; ++tries) {
        const auto steady = ask<Done>(*this, SteadyLight{});
        const auto rest = steady ? ask<Done>(*this, LensToRest{}) : steady;
        if (rest) return {};
        done = tl::unexpected(rest.error());
    }
    return done;
}

}  // namespace ilf::devices
