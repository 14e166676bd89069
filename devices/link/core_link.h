// The studio's end of the link to the output core: sends programs as differences, keeps the newest status.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "devices/link/channel.h"
#include "devices/link/messages.h"
#include "devices/link/runtime_directory.h"

namespace ilf::devices {

/// Used by one thread, which must call `poll` again and again: it moves everything. Connects by itself, and again after
/// the core or the link died. Nothing here waits longer than the timeout of `poll`.
///
/// One update is under way at a time; while it is, a newer one replaces one that waits (newest wins, the replaced one
/// counts as dropped), so that a fast brush never makes a queue.
class CoreLink {
public:
    explicit CoreLink(const std::filesystem::path& runtimeDirectory = ilf::devices::runtimeDirectory());

    /// Why::take ends the safe light `hold` (Status::hold when the operator pressed TAKE) and no other: one that began
    /// since is not what the operator saw. Why::live is refused by the core while it holds safe light. Refuses when the
    /// core is not connected.
    Result<void> send(const Program& program, std::uint64_t revision, Why why, std::uint64_t hold);
    /// The same for callers who act on the status of this very moment.
    Result<void> send(const Program& program, std::uint64_t revision, Why why) {
        return send(program, revision, why, status_.hold);
    }
    /// Steady white light, lens at rest, until the next take.
    Result<void> safeLight();
    /// Works for at most `timeout`; returns early with what the core said, or when the connection was lost or found.
    std::optional<Status> poll(std::chrono::milliseconds timeout);
    /// The newest; not connected before the first poll that heard of the core.
    const Status& status() const { return status_; }

private:
    using Clock = std::chrono::steady_clock;
    struct Update {
        Program program;
        std::uint64_t hash = 0, revision = 0;
        Why why = Why::live;
        std::uint64_t hold = 0;
    };
    void sayHello(Clock::time_point now);
    void transmit(Clock::time_point now);
    void putBack();
    bool heard(const Message& message, Clock::time_point now);
    void drop();

    Client client_;
    Status status_;
    std::uint64_t dropped_ = 0;
    std::optional<Update> waiting_, underWay_, base_;
    std::string refusal_;
    Clock::time_point sent_, heard_, helloed_;
};

}  // namespace ilf::devices
