// The core's end of the link: takes programs from studios, checks them, gives them to the player, says the status.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>

#include "app/output_core/player.h"
#include "devices/link/channel.h"

namespace ilf::app {

/// Used by one thread. A studio that goes away changes nothing.
class StudioLink {
public:
    StudioLink(std::unique_ptr<devices::Server> server, Player& player);

    /// Waits for messages, the player or `stopDescriptor`, and deals with what came.
    void turn(int playerDescriptor, int stopDescriptor);
    /// As the player gave it last.
    const devices::Status& status() const { return status_; }

private:
    using Clock = std::chrono::steady_clock;
    void handle(const devices::Server::Incoming& incoming);
    void take(const std::string& client, const devices::ProgramUpdate& update);
    void publish();

    std::unique_ptr<devices::Server> server_;
    Player& player_;
    devices::Status status_;
    std::map<std::string, Clock::time_point> studios_;  ///< when each was last heard of
    Clock::time_point published_;
    Program last_;  ///< the base of the next update
    std::uint64_t lastHash_ = 0;
};

}  // namespace ilf::app
