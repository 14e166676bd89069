#include "devices/dlpc350/conversation.h"

#include <cstdio>

namespace ilf::devices::dlpc350 {
namespace {

/// A reply that lies ready comes at the next poll of the endpoint; full-speed interrupt endpoints are polled at least
/// every 10 ms as TI's are set up, twice that for slow ones.
constexpr Milliseconds kDrainLimit{20};
/// The board answers one message at a time, so more than a few old replies are not old replies.
constexpr int kMostOldReplies = 64;

std::string commandCode(Command command) {
    char text[16];
    std::snprintf(text, sizeof text, "%02X/%02X", command.cmd2, command.cmd3);
    return text;
}

std::string quotedName(Command command) {
    return std::string("\"") + command.name + "\" (" + commandCode(command) + ")";
}

}  // namespace

Conversation::Conversation(std::unique_ptr<UsbLink> link, Endpoint out, Endpoint in)
    : link_(std::move(link)), out_(out), in_(in), name_("The LightCrafter 4500 at " + link_->identity().path) {}

Result<Conversation> Conversation::over(std::unique_ptr<UsbLink> link) {
    const auto out = link->interruptOut();
    if (!out) return tl::unexpected(out.error());
    const auto in = link->interruptIn();
    if (!in) return tl::unexpected(in.error());
    return Conversation(std::move(link), *out, *in);
}

Result<void> Conversation::tell(Command command, Data payload) {
    if (unsettled_) drained();
    unsettled_ = true;
    const auto packets = writeMessage(command, ++sequence_, payload);
    if (const auto ok = sent(command, packets); !ok) return ok;
    const auto reply = replyTo(command, false);
    if (!reply) return tl::unexpected(reply.error());
    unsettled_ = false;
    if (reply->refusedWrite())
        return fail(Fault::device, name_ + " refused " + quotedName(command) +
                                       ". It takes most settings only while its patterns are stopped; stop and try "
                                       "again, and check its firmware.");
    return {};
}

Result<Bytes> Conversation::ask(Command command) {
    if (unsettled_) drained();
    unsettled_ = true;
    const Packet packet = readMessage(command, ++sequence_);
    if (const auto ok = sent(command, {&packet, 1}); !ok) return tl::unexpected(ok.error());
    const auto reply = replyTo(command, true);
    if (!reply) return tl::unexpected(reply.error());
    unsettled_ = false;
    if (reply->refused())
        return fail(Fault::device, name_ + " refused to tell its " + quotedName(command) + ". Check its firmware.");
    return Bytes(reply->data().begin(), reply->data().end());
}

Result<void> Conversation::sent(Command command, std::span<const Packet> packets) {
    for (const Packet& packet : packets)
        if (const auto ok = link_->send(out_, packet, limit_); !ok) return silent(command, ok.error());
    return {};
}

Result<Reply> Conversation::replyTo(Command command, bool isRead) {
    for (int old = 0; old < kMostOldReplies; ++old) {
        auto reply = nextReply(command, isRead);
        if (!reply) return reply;
        if (reply->sequence() == sequence_ && (isRead || reply->refusedWrite() || reply->echoes(command))) return reply;
    }
    return fail(Fault::device, name_ + " sends only replies to other messages than " + quotedName(command) +
                                   ". Another program may be talking to it: close that, then plug it in again.");
}

Result<Reply> Conversation::nextReply(Command command, bool isRead) {
    const auto first = link_->receive(in_, kPacketBytes, limit_);
    if (!first) return silent(command, first.error());
    auto reply = Reply::begun(*first);
    if (!reply) return tl::unexpected(about(reply.error()));
    // An old reply is read to its end as well, or its later packets would be taken for headers.
    const bool mayGoOn = reply->sequence() == sequence_ ? isRead : reply->toRead();
    while (mayGoOn && !reply->whole()) {
        const auto next = link_->receive(in_, kPacketBytes, limit_);
        if (!next) return silent(command, next.error());
        if (const auto added = reply->add(*next); !added) return tl::unexpected(about(added.error()));
    }
    return reply;
}

void Conversation::drained() {
    if (mayBeHalted_) {
        // Harmless where nothing stalled; where the board is gone, the next message says so.
        (void)link_->clearHalt(out_);
        (void)link_->clearHalt(in_);
        mayBeHalted_ = false;
    }
    for (int i = 0; i < kMostOldReplies; ++i)
        if (!link_->receive(in_, kPacketBytes, kDrainLimit)) return;
}

Error Conversation::about(const Error& error) const {
    return {Fault::device, name_ + ": " + error.what + " Check its firmware, and switch its power off and on."};
}

tl::unexpected<Error> Conversation::silent(Command command, const Error& why) {
    mayBeHalted_ = true;
    return fail(Fault::device, name_ + " did not answer " + quotedName(command) + ": " + why.what +
                                   " If it is plugged in and stays silent, switch its power off and on.");
}

}  // namespace ilf::devices::dlpc350
