// What each frame of the window took: our own work stage by stage, and apart from it the swap.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ilf::app {

enum class FrameStage : std::uint8_t {
    input,  ///< events of the display taken in (not the wait for them)
    marks,  ///< scene and region marks brought up to date in their textures
    views,  ///< perceived views and light likewise
    build,  ///< panels and canvas built
    edit,   ///< requests carried out, work posted
    draw,   ///< draw lists handed to GL
    swap,   ///< the buffers swapped: with software GL, where the pixels are filled
};
inline constexpr std::array<const char*, 7> kFrameStages{"input", "marks", "views", "build", "edit", "draw", "swap"};

/// Milliseconds, by FrameStage.
struct FrameTime {
    std::array<double, kFrameStages.size()> wall_ms{};
    std::array<double, kFrameStages.size()> cpu_ms{};  ///< of the window's thread
    bool gesture = false;                              ///< a gesture was going on

    double ownWall_ms() const;  ///< all but the swap
    double ownCpu_ms() const;
};

/// A clock that is told when a stage ends. Window's thread only.
class FrameTimes {
public:
    /// `keeps`: every frame, for `json`; else only the last one.
    explicit FrameTimes(bool keeps) : keeps_(keeps) {}

    /// The frame's first stage begins; with `waited`, in a wait for events, which counts by its processor time alone.
    void begin(bool waited);
    void lap(FrameStage stage);
    void end(bool gesture);

    const FrameTime& last() const { return last_; }
    /// Frames of gestures and all frames: count, then p50, p95 and worst of own work, swap and each stage; and
    /// `counts`.
    std::string json(const std::map<std::string, std::uint64_t>& counts = {}) const;

private:
    bool keeps_ = false, waited_ = false;
    double wall_ms_ = 0.0, cpu_ms_ = 0.0;
    FrameTime now_, last_;
    std::vector<FrameTime> frames_;
};

}  // namespace ilf::app
