#include "devices/simulated/device_server.h"

#include <poll.h>
#include <unistd.h>

#include "devices/link/channel.h"
#include "devices/link/runtime_directory.h"
#include "devices/simulated/machine.h"

namespace ilf::devices {
namespace {

// A player says something every 100 ms; one that is silent this long is dead, stopped or hung. The light must be safe
// within a second.
constexpr std::int64_t kWatchdogNs = 750'000'000;

bool readable(int fd) {
    pollfd item{fd, POLLIN, 0};
    return poll(&item, 1, 0) > 0;
}

/// Faults a test asked for, counted down with every order that is not a question.
class Faults {
public:
    /// False: it is not of these; lens or projector shall have it.
    bool inject(const InjectFault& fault) {
        using Kind = InjectFault::Kind;
        if (fault.kind == Kind::none) fault_ = fault;
        if (fault.kind != Kind::refuse && fault.kind != Kind::silence && fault.kind != Kind::die) return false;
        fault_ = fault;
        return true;
    }
    InjectFault::Kind next(const Body& request) {
        if (std::holds_alternative<Read>(request) || std::holds_alternative<ReadSlot>(request))
            return fault_.kind == InjectFault::Kind::silence && fault_.afterCalls == 0 ? fault_.kind
                                                                                       : InjectFault::Kind::none;
        if (fault_.kind == InjectFault::Kind::none || fault_.afterCalls-- > 0) return InjectFault::Kind::none;
        fault_.afterCalls = 0;
        const auto kind = fault_.kind;
        if (kind == InjectFault::Kind::refuse) fault_.kind = InjectFault::Kind::none;
        return kind;
    }

private:
    InjectFault fault_;
};

}  // namespace

Result<void> serveDevices(const std::filesystem::path& runtimeDirectory, SimulatedLens lens, int stopDescriptor,
                          const std::function<void(const std::string&)>& said) {
    auto lock = FileLock::tryTake(devicesLock(runtimeDirectory));
    if (!lock) return tl::unexpected(lock.error());
    if (!*lock) return fail(Fault::device, "Simulated devices run in this runtime directory already.");
    auto server = Server::open(devicesAddress(runtimeDirectory));
    if (!server) return tl::unexpected(server.error());

    Machine machine(monotonicNs(), lens);
    machine.setWatchdog(kWatchdogNs);
    Faults faults;
    std::string player;  // who put the slots on show: whose silence means that nobody watches over them
    said("simulated lens (" + std::string(word(lens)) + ") and projector: steady light, lens at rest");
    while (!readable(stopDescriptor)) {
        (*server)->wait(std::chrono::milliseconds(50), {stopDescriptor});
        // All that waits is taken first: after a stall of this process the player's word must count before time does.
        std::vector<Server::Incoming> waiting;
        while (auto incoming = (*server)->receive())
            waiting.push_back(*std::move(incoming));
        for (const auto& [client, received] : waiting)
            if (client == player) machine.playerHeard(monotonicNs());
        for (const auto& [client, received] : waiting) {
            const std::int64_t now = monotonicNs();
            if (!received) {
                said(received.error().what);
                (*server)->send(client, {0, Refused{received.error(), false}});
                continue;
            }
            const Message& message = *received;
            if (const auto* fault = std::get_if<InjectFault>(&message.body)) {
                const bool taken = faults.inject(*fault);
                (*server)->send(client, {message.id, taken ? Body(Done{now}) : machine.answered(*fault, now)});
                continue;
            }
            const auto fault = faults.next(message.body);
            if (fault == InjectFault::Kind::die) _exit(1);
            if (fault == InjectFault::Kind::silence) continue;
            if (fault == InjectFault::Kind::refuse) {
                (*server)->send(client, {message.id, Refused{{Fault::device, "A fault was injected."}, false}});
                continue;
            }
            if (std::holds_alternative<Swap>(message.body)) {
                player = client;
                machine.playerHeard(now);
            }
            Body answer = machine.answered(message.body, now);
            if (auto* state = std::get_if<DeviceState>(&answer)) state->pid = getpid();
            if (const auto* refused = std::get_if<Refused>(&answer)) said("refused: " + refused->error.what);
            (*server)->send(client, {message.id, answer});
        }
        machine.advance(monotonicNs());
    }
    said("switched off");
    return {};
}

}  // namespace ilf::devices
