// Rows of numbers that begin where whole vectors are loaded without straddling two lines of the cache.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace ilf::view {

class AlignedFloats {
public:
    static constexpr std::size_t kAlignment = 64;

    AlignedFloats() = default;
    /// All 0.
    explicit AlignedFloats(std::size_t count) { need(count); }
    bool empty() const { return lines_.empty(); }
    /// At least so many; what is there stays, what is new is 0.
    void need(std::size_t count) {
        const std::size_t lines = (count + kPerLine - 1) / kPerLine;
        if (lines_.size() < lines) lines_.resize(lines);
    }
    float* data() { return lines_.data()->v.data(); }
    const float* data() const { return lines_.data()->v.data(); }

private:
    static constexpr std::size_t kPerLine = kAlignment / sizeof(float);
    struct alignas(kAlignment) Line {
        std::array<float, kPerLine> v{};
    };
    std::vector<Line> lines_;
};

}  // namespace ilf::view
