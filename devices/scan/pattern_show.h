// Whoever shows one picture in all slots with the lens at rest, for a camera to take.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/image.h"
#include "core/base/quantity.h"
#include "core/base/result.h"

namespace ilf::devices {

/// Called from one thread.
class PatternShow {
public:
    virtual ~PatternShow() = default;

    /// Shows `picture` (one channel, linear light, of the size `projector` says) until the next one. Returns after its
    /// first light, with the time of that on the clock of `steadyNow`.
    virtual Result<Second> show(const Image<std::uint8_t>& picture) = 0;
    /// Steady uniform white light, lens at rest.
    virtual void safe() noexcept = 0;

    virtual Size projector() const = 0;
    /// Light is the same over each of these and only over whole ones.
    virtual Second sweep() const = 0;
};

}  // namespace ilf::devices
