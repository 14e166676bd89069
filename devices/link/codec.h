// Messages to bytes and back (FlatBuffers), believing nothing that arrives.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "devices/link/messages.h"

namespace ilf::devices {

std::vector<std::byte> encoded(const Message& message);

/// Refuses (Fault::badFile) bytes that are truncated, are not a message, or hold numbers that no message of ours can:
/// the offsets are checked by the FlatBuffers verifier, then sizes, indices and enumerations by us.
Result<Message> decoded(std::span<const std::byte> bytes);

/// Beyond these a message is a mistake, not a program: an 8K projector, 256 slots of their own image.
inline constexpr int kMaxSide = 8192;
inline constexpr int kMaxImages = 256;
inline constexpr int kMaxSlots = 1024;
inline constexpr int kMaxHarmonics = 64;  ///< of a lens wave, the mean included
/// Tiles of all images of one program together: 1 GB of light.
inline constexpr int kMaxTiles = 262144;

}  // namespace ilf::devices
