// What a digital micromirror shows of an RGB picture: which bits are which pattern, and the light of each pixel.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace ilf::devices::emulators {

/// A picture on the video input, 8 bits for each of red, green and blue, row by row.
struct VideoFrame {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  ///< 3 * width * height
};
using FramePtr = std::shared_ptr<const VideoFrame>;

/// The mirrors: 912 columns, 1140 rows (devices.md 1.8).
inline constexpr int kMirrorColumns = 912, kMirrorRows = 1140;

/// Which of the 24 planes (0-7 green, 8-15 red, 16-23 blue, each from its lowest bit) is the lowest bit of pattern
/// `number` at `depth` bits; the others follow it upwards. None: there is no such pattern (devices.md 1.5, transcribed
/// from TI's tables by users; never verified on a projector).
std::optional<int> lowestPlane(int depth, int number);
/// How many patterns of `depth` bits a frame holds; 0 where there is no such depth.
int patternCount(int depth);

/// How a slot's pixels come about from the picture in the frame buffer.
struct MirrorSettings {
    bool flipColumns = false, flipRows = false;
    bool swapsChannels = false;  ///< red and green are exchanged
    bool operator==(const MirrorSettings&) const = default;
};

/// One exposure: steady light of the LEDs from `start_ns` to `end_ns`, shared out among the mirrors.
struct LightSlot {
    std::int64_t start_ns = 0, end_ns = 0;
    int pattern = 0;  ///< a pattern number; 24 black, 25 at depth 1 white
    int depth = 8;    ///< bits
    bool inverted = false;
    std::uint8_t leds = 7;  ///< bit 0 red, 1 green, 2 blue; 0: dark
    bool video = false;     ///< video mode: the frame as a picture, grey of its three colours
    bool drawn = false;     ///< in video mode: a picture of the board's own, at its own pace
    double gamma = 1.0;     ///< of video mode
    MirrorSettings mirrors;
    FramePtr frame;  ///< none: black
    std::uint64_t frameNumber = 0;

    /// The largest code.
    int full() const { return (1 << depth) - 1; }
    /// Per mirror 0..full(): the slot's bit planes as a number. Light is proportional to it; a slot without LEDs is 0.
    std::vector<std::uint8_t> codes() const;
    int codeAt(int column, int row) const;
    /// Per mirror 0..255: codes() / full() as 8 bits of linear light.
    std::vector<std::uint8_t> light() const;
};

}  // namespace ilf::devices::emulators
