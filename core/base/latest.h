// A letterbox for one value between two threads: the reader always gets the newest.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace ilf {

/// `put` never blocks on the reader and replaces a value nobody took; `take` waits for one.
/// Old values are dropped on purpose: nobody wants yesterday's brush position.
template <class T>
class Latest {
public:
    void put(T value) {
        {
            const std::scoped_lock lock(mutex_);
            value_ = std::move(value);
        }
        arrived_.notify_one();
    }
    /// Waits for a value; nothing once a stop is asked for.
    std::optional<T> take(std::stop_token stop) {
        std::unique_lock lock(mutex_);
        if (!arrived_.wait(lock, stop, [&] { return value_.has_value(); })) return std::nullopt;
        return std::exchange(value_, std::nullopt);
    }
    /// True while a value waits: what a long computation asks to see whether its result is still wanted.
    bool waiting() const {
        const std::scoped_lock lock(mutex_);
        return value_.has_value();
    }
    /// Waits for a value at most this long.
    std::optional<T> takeWithin(std::stop_token stop, std::chrono::nanoseconds time) {
        std::unique_lock lock(mutex_);
        if (!arrived_.wait_for(lock, stop, time, [&] { return value_.has_value(); })) return std::nullopt;
        return std::exchange(value_, std::nullopt);
    }
    std::optional<T> tryTake() {
        const std::scoped_lock lock(mutex_);
        return std::exchange(value_, std::nullopt);
    }

private:
    mutable std::mutex mutex_;
    std::condition_variable_any arrived_;
    std::optional<T> value_;
};

}  // namespace ilf
