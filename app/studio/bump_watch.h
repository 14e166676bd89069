// Looks once a second whether the camera still stands where it was registered, on a thread of its own.
#pragma once

#include <functional>
#include <optional>
#include <thread>

#include "core/base/image.h"
#include "core/base/latest.h"
#include "core/registration/bump.h"

namespace ilf::app {

/// All functions are for one thread and never wait.
class BumpWatch {
public:
    /// `onNews` is called from the thread when `tryTake` has something.
    explicit BumpWatch(std::function<void()> onNews);
    BumpWatch(const BumpWatch&) = delete;
    BumpWatch& operator=(const BumpWatch&) = delete;

    /// The scene's picture, under whose light the camera was registered, and a frame of that camera now. The newest
    /// pair is compared; a reference that was seen before is not looked at anew.
    void compare(const Box<Picture>& reference, const Image<std::uint8_t>& frame) { pairs_.put({reference, frame}); }
    /// What the last comparison found; nothing where the reference tells too little, or sizes differ.
    std::optional<BumpReport> tryTake() { return reports_.tryTake(); }

private:
    struct Pair {
        Box<Picture> reference;
        Image<std::uint8_t> frame;
    };
    void run(const std::stop_token& stop);

    std::function<void()> onNews_;
    Latest<Pair> pairs_;
    Latest<BumpReport> reports_;
    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
