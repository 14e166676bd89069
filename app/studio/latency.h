// How long a stroke took to become light: strokes remembered by revision, answered by what the core says it swapped.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace ilf::app {

/// Times are CLOCK_MONOTONIC nanoseconds, which studio and core share.
class Latency {
public:
    void sent(std::uint64_t revision, std::int64_t stroke_ns) {
        waiting_.push_back({revision, stroke_ns});
        while (waiting_.size() > kRemembered)
            waiting_.pop_front();
    }
    /// The core plays `revision` since `swapped_ns`.
    void played(std::uint64_t revision, std::int64_t swapped_ns) {
        while (!waiting_.empty() && waiting_.front().revision <= revision) {
            if (waiting_.front().revision == revision && swapped_ns > waiting_.front().stroke_ns) {
                last_ms_ = static_cast<double>(swapped_ns - waiting_.front().stroke_ns) / 1e6;
            }
            waiting_.pop_front();
        }
    }
    /// Of the last program that was played; nothing before the first.
    std::optional<double> last_ms() const { return last_ms_; }

private:
    static constexpr std::size_t kRemembered = 256;  // a core that answers nothing must not fill memory
    struct Sent {
        std::uint64_t revision;
        std::int64_t stroke_ns;
    };
    std::deque<Sent> waiting_;
    std::optional<double> last_ms_;
};

}  // namespace ilf::app
