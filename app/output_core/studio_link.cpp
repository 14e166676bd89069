#include "app/output_core/studio_link.h"

#include <utility>

#include "app/output_core/events.h"
#include "devices/link/program_update.h"
#include "devices/link/runtime_directory.h"

namespace ilf::app {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kPublish{100};
// A studio says hello every 100 ms; one that stopped in a debugger may come back.
constexpr milliseconds kForget{3000};

}  // namespace

StudioLink::StudioLink(std::unique_ptr<devices::Server> server, Player& player)
    : server_(std::move(server)), player_(player) {}

void StudioLink::turn(int playerDescriptor, int stopDescriptor) {
    server_->wait(milliseconds(50), {playerDescriptor, stopDescriptor});
    while (const auto incoming = server_->receive())
        handle(*incoming);
    if (auto status = player_.newStatus()) {
        if (status->faults != status_.faults) note(event::kFault, status->fault);
        if (status->light != status_.light)
            note(status->light == devices::LightMode::slotted ? event::kLightSlotted : event::kLightSteady);
        status_ = *std::move(status);
        publish();
    } else if (Clock::now() - published_ > kPublish) {
        publish();
    }
}

void StudioLink::publish() {
    const auto now = Clock::now();
    published_ = now;
    std::erase_if(studios_, [&](const auto& studio) { return now - studio.second > kForget; });
    if (status_.pid == 0) return;  // the player has not said anything yet
    for (const auto& [client, heard] : studios_)
        server_->send(client, {0, status_});
}

void StudioLink::handle(const devices::Server::Incoming& incoming) {
    const bool isNew = studios_.insert_or_assign(incoming.client, Clock::now()).second;
    if (!incoming.message) {
        note(event::kBadMessage, incoming.message.error().what);
        server_->send(incoming.client, {0, devices::Refused{incoming.message.error(), true}});
        return;
    }
    const auto& body = incoming.message->body;
    if (const auto* update = std::get_if<devices::ProgramUpdate>(&body)) {
        take(incoming.client, *update);
    } else if (std::holds_alternative<devices::SafeLight>(body)) {
        note(event::kSafeLightAsked);
        player_.safeLight();
    } else if (const auto* hello = std::get_if<devices::Hello>(&body)) {
        if (isNew) note(event::kStudioConnected, hello->role);
        if (isNew && status_.pid != 0) server_->send(incoming.client, {0, status_});
    } else {
        const Error error{Fault::unsupported, "The output core does not know this message."};
        server_->send(incoming.client, {0, devices::Refused{error, false}});
    }
}

void StudioLink::take(const std::string& client, const devices::ProgramUpdate& update) {
    const std::int64_t received_ns = devices::monotonicNs();
    const auto refuse = [&](const Error& error, bool sendWhole) {
        note(event::kUpdateRefused, std::to_string(update.revision) + ": " + error.what);
        server_->send(client, {0, devices::Refused{error, sendWhole}});
    };
    auto program = devices::assembled(update, lastHash_ != 0 ? &last_ : nullptr, lastHash_);
    // With a base, what arrived wrong may arrive right as a whole; a whole that is wrong stays wrong.
    if (!program) return refuse(program.error(), update.base.has_value());
    if (const auto fine = checked(*program); !fine) return refuse(fine.error(), false);
    last_ = *program;
    lastHash_ = update.hash;
    server_->send(client, {0, devices::Ack{update.revision, update.hash}});
    player_.play({*std::move(program), update.revision, update.hash, update.why, update.hold, received_ns});
}

}  // namespace ilf::app
