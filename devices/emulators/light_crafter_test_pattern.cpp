// What the board shows without any video: its test patterns (devices.md 1.3: 1A/00, 12/03, 12/04; which number is which
// pattern, and that colours have 10 bits in the order red, green, blue: comments of TI's dlpc350_api.cpp).
#include <algorithm>

#include "devices/emulators/light_crafter.h"

namespace ilf::devices::emulators {

namespace {

constexpr std::int64_t kOwnFrame_ns = 16'666'667;  // its own pace is not documented where we read
constexpr std::int64_t kForgets_ns = 1'000'000'000;

}  // namespace

/// Only the solid field's pixels are known. Where lines, fields, ramps and bars lie is not; they are not uniform, and
/// that is all these say.
FramePtr EmulatedLightCrafter::testPicture() const {
    const Bytes& colours = registers_.at(0x1204);
    const auto eightBits = [&](std::size_t which) {
        const int value = (colours[2 * which] | colours[2 * which + 1] << 8) & 0x3FF;
        return static_cast<std::uint8_t>(value >> 2);
    };
    const int pattern = byteOf(0x1203);
    VideoFrame picture{kMirrorColumns, kMirrorRows, {}};
    picture.rgb.reserve(std::size_t{3} * kMirrorColumns * kMirrorRows);
    for (int row = 0; row < kMirrorRows; ++row)
        for (int column = 0; column < kMirrorColumns; ++column) {
            const bool twoColours = pattern >= 3 && pattern <= 7;
            const bool background = twoColours && (column / 16 + row / 16) % 2 == 1;
            for (std::size_t colour = 0; colour < 3; ++colour) {
                const int value = eightBits(background ? colour + 3 : colour);
                const bool ramp = pattern != 0 && !twoColours;
                picture.rgb.push_back(static_cast<std::uint8_t>(ramp ? value * column / kMirrorColumns : value));
            }
        }
    return std::make_shared<const VideoFrame>(std::move(picture));
}

void EmulatedLightCrafter::draw(std::int64_t now_ns) {
    if (!draws(now_ns)) return endDrawing(now_ns);
    if (!drawn_) {
        drawn_ = testPicture();
        drawnUntil_ns_ = now_ns;
    }
    // Light nobody asked for is forgotten.
    while (drawnUntil_ns_ < now_ns - kForgets_ns)
        drawnUntil_ns_ += kOwnFrame_ns;
    while (drawnUntil_ns_ + kOwnFrame_ns <= now_ns) {
        LightSlot slot = videoSlot(drawnUntil_ns_, drawnUntil_ns_ + kOwnFrame_ns, drawn_);
        slot.drawn = true;
        drawnUntil_ns_ = slot.end_ns;
        emit(std::move(slot));
    }
}

void EmulatedLightCrafter::endDrawing(std::int64_t now_ns) {
    if (!drawn_) return;
    LightSlot slot = videoSlot(drawnUntil_ns_, std::min(now_ns, drawnUntil_ns_ + kOwnFrame_ns), drawn_);
    slot.drawn = true;
    drawn_ = nullptr;
    emit(std::move(slot));
}

/// What came in is gone with it, and has to be locked on anew.
void EmulatedLightCrafter::inputChanged(std::int64_t now_ns) {
    arriving_ = arrived_ = shown_ = nullptr;
    lastSync_ns_.reset();
    videoFrom_ns_.reset();
    pluggedAt_ns_ = now_ns;
}

}  // namespace ilf::devices::emulators
