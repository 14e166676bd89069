// Messages of the DLPC350 as the 64-byte packets that carry them, without any cable.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace ilf::devices::dlpc350 {

// A message is a header of four bytes, two command bytes and a payload; all numbers are little endian.
//
//     0     flags: bit 7 read, bit 6 a reply is wanted, bit 5 refused (replies), bits 2:0 destination (0: projector)
//     1     sequence, echoed by the reply
//     2, 3  length: command bytes and payload; in a reply to a read, its data
//     4, 5  command: CMD3, then CMD2
//     6 ... payload (a reply to a read has its data from 4 on)
//
// What does not fit into the first packet follows in packets without header. Example, start of patterns with sequence
// 7:
//
//     40 07 03 00 24 1A 02 00 ... 00
//
// Known from: TI's LightCrafter 4500 GUI 4.0.0 (dlpc350_api.cpp), which was read; community drivers agree.
// Not known: the length of the acknowledgement of a write; none is asked for here.

using Data = std::span<const std::uint8_t>;

inline constexpr std::size_t kPacketBytes = 64;
inline constexpr std::size_t kHeaderBytes = 4;
/// Command bytes and payload (HID_MESSAGE_MAX_SIZE of TI's code).
inline constexpr std::size_t kMostMessageBytes = 512;
inline constexpr std::size_t kMostPayloadBytes = kMostMessageBytes - 2;

using Packet = std::array<std::uint8_t, kPacketBytes>;

/// A command by its two bytes, and what operators read of it.
struct Command {
    std::uint8_t cmd2 = 0, cmd3 = 0;
    const char* name = "";
};

/// A command that changes something and is acknowledged. `payload`: at most kMostPayloadBytes.
std::vector<Packet> writeMessage(Command command, std::uint8_t sequence, Data payload);
/// A command that asks for something.
Packet readMessage(Command command, std::uint8_t sequence);

/// A reply as its packets come in. Hostile bytes give an error (Fault::badFile), never a read past their end.
class Reply {
public:
    /// From a reply's first packet.
    static Result<Reply> begun(Data packet);
    /// The next packet of a reply that is not whole.
    Result<void> add(Data packet);

    /// Bit 5, or a reply to a read without data.
    bool refused() const { return flagged_ || length_ == 0; }
    /// Bit 5 alone: of acknowledgements nothing else is known.
    bool refusedWrite() const { return flagged_; }
    /// To a read (bit 7): its data may go on in further packets.
    bool toRead() const { return toRead_; }
    std::uint8_t sequence() const { return sequence_; }
    bool whole() const { return flagged_ || data_.size() == length_; }
    Data data() const { return data_; }
    /// Whether an acknowledgement names `command`; one too short to name any does.
    bool echoes(Command command) const;

private:
    bool flagged_ = false, toRead_ = false;
    std::uint8_t sequence_ = 0;
    std::size_t length_ = 0;
    std::vector<std::uint8_t> data_;
};

}  // namespace ilf::devices::dlpc350
