#include "devices/link/core_link.h"

#include <algorithm>
#include <utility>

#include "devices/link/program_update.h"

namespace ilf::devices {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kHello{100};
// A core says something every 100 ms; this long without a word and it is gone.
constexpr milliseconds kSilence{500};
// An update is acknowledged on arrival; by then it was lost with the core that should have read it.
constexpr milliseconds kAckTime{1000};

}  // namespace

CoreLink::CoreLink(const std::filesystem::path& runtimeDirectory) : client_(coreAddress(runtimeDirectory)) {}

Result<void> CoreLink::send(const Program& program, std::uint64_t revision, Why why, std::uint64_t hold) {
    if (!status_.connected)
        return fail(Fault::device,
                    "The output core is not connected, so nothing was sent; press TAKE when it is back.");
    Update next{program, contentHash(program), revision, why, hold};
    // A dab right behind a take that still waits replaces its program, not the operator's wish to play.
    if (waiting_ && waiting_->why == Why::take && why == Why::live) {
        next.why = Why::take;
        next.hold = waiting_->hold;
    }
    if (waiting_) drop();
    waiting_ = std::move(next);
    transmit(Clock::now());
    return {};
}

Result<void> CoreLink::safeLight() {
    if (waiting_) drop();
    waiting_.reset();
    if (client_.send({0, SafeLight{}})) return {};
    return fail(Fault::device, "The output core is not connected. Its supervisor sees to safe light when it is dead; "
                               "to be sure, switch the projector off and on.");
}

void CoreLink::drop() {
    ++dropped_;
    ++status_.droppedUpdates;
}

void CoreLink::transmit(Clock::time_point now) {
    if (underWay_ || !waiting_ || !status_.connected) return;
    auto update =
        difference(waiting_->program, waiting_->hash, base_ ? &base_->program : nullptr, base_ ? base_->hash : 0);
    update.revision = waiting_->revision;
    update.why = waiting_->why;
    update.hold = waiting_->hold;
    if (!client_.send({0, std::move(update)})) return;
    underWay_ = std::exchange(waiting_, std::nullopt);
    sent_ = now;
}

void CoreLink::putBack() {
    base_.reset();
    if (!underWay_) return;
    if (waiting_)
        drop();
    else
        waiting_ = std::move(underWay_);
    underWay_.reset();
}

void CoreLink::sayHello(Clock::time_point now) {
    if (now - helloed_ < kHello) return;
    helloed_ = now;
    client_.send({0, Hello{"studio"}});
}

bool CoreLink::heard(const Message& message, Clock::time_point now) {
    heard_ = now;
    if (const auto* status = std::get_if<Status>(&message.body)) {
        if (status->pid != status_.pid) putBack();  // another core: it holds nothing of ours
        status_ = *status;
        status_.connected = true;
        status_.droppedUpdates += dropped_;
        if (!refusal_.empty()) status_.lastRefusal = refusal_;
        return true;
    }
    if (const auto* ack = std::get_if<Ack>(&message.body)) {
        if (underWay_ && underWay_->hash == ack->hash) {
            base_ = std::exchange(underWay_, std::nullopt);
            refusal_.clear();
        }
        return false;
    }
    if (const auto* refused = std::get_if<Refused>(&message.body)) {
        if (refused->sendWhole) {
            putBack();
            return false;
        }
        underWay_.reset();
        refusal_ = status_.lastRefusal = refused->error.what;
        return true;
    }
    return false;
}

std::optional<Status> CoreLink::poll(milliseconds timeout) {
    const auto deadline = Clock::now() + timeout;
    while (true) {
        const auto now = Clock::now();
        sayHello(now);
        if (status_.connected && now - heard_ > kSilence) {
            status_.connected = false;
            putBack();
            return status_;
        }
        if (underWay_ && now - sent_ > kAckTime) putBack();
        transmit(now);
        const auto left = std::chrono::ceil<milliseconds>(std::min(deadline, helloed_ + kHello) - now);
        const auto received = client_.receive(std::max(left, milliseconds(0)));
        if (received && *received && heard(**received, Clock::now())) {
            // Newer ones may wait behind it.
            while (const auto next = client_.receive(milliseconds(0)))
                if (*next) heard(**next, Clock::now());
            transmit(Clock::now());
            return status_;
        }
        if (!received && Clock::now() >= deadline) return std::nullopt;
    }
}

}  // namespace ilf::devices
