#include "devices/dlpc350/messages.h"

#include <algorithm>
#include <cassert>
#include <string>

namespace ilf::devices::dlpc350 {
namespace {

constexpr std::uint8_t kRead = 0x80, kReplyWanted = 0x40, kRefused = 0x20;

std::vector<Packet> packed(std::uint8_t flags, Command command, std::uint8_t sequence, Data payload) {
    assert(payload.size() <= kMostPayloadBytes);
    const std::size_t length = 2 + payload.size();
    std::vector<std::uint8_t> bytes{
        flags,        sequence,    static_cast<std::uint8_t>(length & 0xFF), static_cast<std::uint8_t>(length >> 8),
        command.cmd3, command.cmd2};
    bytes.insert(bytes.end(), payload.begin(), payload.end());

    std::vector<Packet> packets;
    for (std::size_t sent = 0; sent < bytes.size(); sent += kPacketBytes) {
        Packet packet{};
        const std::size_t part = std::min(kPacketBytes, bytes.size() - sent);
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(sent), part, packet.begin());
        packets.push_back(packet);
    }
    return packets;
}

}  // namespace

std::vector<Packet> writeMessage(Command command, std::uint8_t sequence, Data payload) {
    return packed(kReplyWanted, command, sequence, payload);
}

Packet readMessage(Command command, std::uint8_t sequence) {
    return packed(kRead | kReplyWanted, command, sequence, {}).front();
}

Result<Reply> Reply::begun(Data packet) {
    if (packet.size() < kHeaderBytes)
        return fail(Fault::badFile,
                    "A reply of " + std::to_string(packet.size()) + " bytes is too short for a header.");
    Reply reply;
    reply.flagged_ = (packet[0] & kRefused) != 0;
    reply.toRead_ = (packet[0] & kRead) != 0;
    reply.sequence_ = packet[1];
    reply.length_ = static_cast<std::size_t>(packet[2] | (packet[3] << 8));
    if (reply.length_ > kMostMessageBytes)
        return fail(Fault::badFile, "A reply says it has " + std::to_string(reply.length_) + " bytes; the most is " +
                                        std::to_string(kMostMessageBytes) + ".");
    if (reply.flagged_) return reply;
    if (const auto added = reply.add(packet.subspan(kHeaderBytes)); !added) return tl::unexpected(added.error());
    return reply;
}

Result<void> Reply::add(Data packet) {
    const std::size_t wanted = std::min(length_ - data_.size(), kPacketBytes - (data_.empty() ? kHeaderBytes : 0));
    if (packet.size() < wanted)
        return fail(Fault::badFile, "A reply was cut short: " + std::to_string(data_.size() + packet.size()) + " of " +
                                        std::to_string(length_) + " bytes came.");
    data_.insert(data_.end(), packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(wanted));
    return {};
}

bool Reply::echoes(Command command) const {
    return data_.size() < 2 || (data_[0] == command.cmd3 && data_[1] == command.cmd2);
}

}  // namespace ilf::devices::dlpc350
