// Notices a call into a plugin that does not come back, from a thread of its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "core/base/quantity.h"

namespace ilf::devices {

/// What to do about a call that never returns. Nothing in this process can end it, nor reach the projector past it: a
/// player logs the sentence and ends itself (`std::_Exit`), so that its supervisor starts another in steady white.
struct HangingCall {
    std::function<void(const std::string& sentence)> noticed;  ///< on another thread; empty: nobody watches
    Second patience = 5.0_s;                                   ///< beyond what the call may take
};

class CallWatch {
public:
    explicit CallWatch(HangingCall hanging);

    /// One call at a time.
    void began(std::string sentence, Second longest);
    void ended();

private:
    void watch(const std::stop_token& stop);

    HangingCall hanging_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::string sentence_;
    std::optional<std::chrono::steady_clock::time_point> deadline_;  ///< none: no call is under way
    std::jthread thread_;                                            ///< last: it uses all the others
};

}  // namespace ilf::devices
