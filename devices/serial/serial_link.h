// An open serial line as a driver sees it: bytes out, and bytes in within a time limit.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace ilf::devices {

using Bytes = std::vector<std::uint8_t>;
using Milliseconds = std::chrono::milliseconds;

/// Calls come from one thread and block at most their time limit. A line that is gone (unplugged, hung up) is an error
/// of every later call.
class SerialLink {
public:
    virtual ~SerialLink() = default;

    /// For messages: "/dev/ttyACM0".
    virtual const std::string& name() const = 0;
    /// All of `data` is handed to the line or there is an error.
    virtual Result<void> send(std::span<const std::uint8_t> data, Milliseconds limit) = 0;
    /// What has arrived, at most `most` bytes; waits for the first. Empty: nothing came within `limit`.
    virtual Result<Bytes> receive(std::size_t most, Milliseconds limit) = 0;
};

}  // namespace ilf::devices
