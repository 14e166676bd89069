// What came and went on the bus since somebody last asked, from whatever thread it is told.
#pragma once

#include <deque>
#include <mutex>
#include <utility>
#include <vector>

#include "devices/usb/usb_bus.h"

namespace ilf::devices {

/// Keeps the newest, at most `kMost`: where nobody asks, what is plugged in now can be listed.
class UsbNews {
public:
    static constexpr std::size_t kMost = 256;

    void add(UsbChange change) {
        const std::scoped_lock lock(mutex_);
        if (changes_.size() == kMost) changes_.pop_front();
        changes_.push_back(std::move(change));
    }
    std::vector<UsbChange> taken() {
        const std::scoped_lock lock(mutex_);
        const auto all = std::exchange(changes_, {});
        return {all.begin(), all.end()};
    }

private:
    std::mutex mutex_;
    std::deque<UsbChange> changes_;
};

}  // namespace ilf::devices
