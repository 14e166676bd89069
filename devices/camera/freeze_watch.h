// Notices a camera that stopped giving new pictures, also when it repeats the last one.
#pragma once

#include <optional>

#include "devices/camera/frame.h"

namespace ilf::devices {

/// A camera counts as frozen from this age of its newest picture on.
inline constexpr Second kFrozenAfter = Second::fromSi(1.0);

/// Pure bookkeeping on the times handed in. A real sensor never gives the same picture twice, since its noise differs.
class FreezeWatch {
public:
    /// The camera was opened.
    explicit FreezeWatch(Second now) : changed_(now) {}
    /// A frame arrived. Compares it with the one before, byte by byte.
    void arrived(const Frame& frame);
    /// Age of the newest picture that differs from the one before.
    Second age(Second now) const { return now - changed_; }
    bool frozen(Second now) const { return age(now) >= kFrozenAfter; }

private:
    Second changed_;
    std::optional<Frame> last_;
};

}  // namespace ilf::devices
