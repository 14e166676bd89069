#include "tests/devices/endtoend/bench.h"

#include <algorithm>

#include "tests/devices/programs.h"

namespace ilf::devices::test {

using emulators::UsbAnswer;

Bench::Bench(std::int64_t start_ns, Locked lockedBy)
    : locked(lockedBy ? std::move(lockedBy) : [](const std::function<void()>& work) { work(); }), now_ns_(start_ns),
      nextSync_ns_(start_ns + kFrame_ns) {
    locked([&] { board.plugVideo({912, 1140, 60.0}, now_ns_); });
}

void Bench::advance(std::int64_t by_ns) {
    constexpr std::int64_t kStep_ns = 2'000'000;
    const std::int64_t until_ns = now_ns_ + by_ns;
    while (now_ns_ < until_ns) {
        now_ns_ = std::min({until_ns, nextSync_ns_, meanwhile ? now_ns_ + kStep_ns : until_ns});
        if (now_ns_ == nextSync_ns_) {
            locked([&] { board.verticalSync(frame_, now_ns_); });
            nextSync_ns_ += kFrame_ns;
        }
        if (meanwhile) meanwhile();
    }
}

Clock Bench::clock() {
    return {[this] { return std::chrono::nanoseconds(now_ns_); },
            [this](std::chrono::nanoseconds time) { advance(time.count()); }};
}

void Bench::present(const dlpc350::VideoPicture& picture) {
    frame_ = std::make_shared<const emulators::VideoFrame>(
        emulators::VideoFrame{picture.size.width, picture.size.height, picture.rgb});
}

std::vector<emulators::LightSlot> Bench::takeLight() {
    std::vector<emulators::LightSlot> light;
    locked([&] { light = board.takeLight(now_ns_); });
    return light;
}

std::vector<SlotLight> Bench::newestSweep() {
    advance(nextSync_ns_ - now_ns_);
    const std::int64_t end_ns = now_ns_, start_ns = end_ns - kFrame_ns;
    std::vector<SlotLight> sweep;
    for (const auto& slot : takeLight())
        if (slot.start_ns >= start_ns && slot.start_ns < end_ns) sweep.push_back(taken(slot, start_ns));
    return sweep;
}

SlotLight taken(const emulators::LightSlot& slot, std::int64_t sweepStart_ns) {
    const auto seconds = [](std::int64_t time_ns) { return Second::fromSi(1e-9 * static_cast<double>(time_ns)); };
    return {{{emulators::kMirrorColumns, emulators::kMirrorRows}, 1, slot.light()},
            seconds(slot.start_ns - sweepStart_ns),
            seconds(slot.end_ns - slot.start_ns),
            slot.leds};
}

std::vector<SlotLight> intendedSweep(const Program& program, int depth) {
    std::vector<SlotLight> sweep;
    const Second length = 1.0 / program.slotRate;
    for (const LightImage& image : dlpc350::intendedLight(program, depth))
        sweep.push_back({toImage(image), static_cast<double>(sweep.size()) * length, length});
    return sweep;
}

Program sweepOf(int slots, std::uint32_t seed) {
    Program program = ilf::test::program(seed, 2.27_D, dlpc350::kRaster);
    program.slotRate = static_cast<double>(slots) * 60.0_Hz;
    program.images.clear();
    program.imageOfSlot.clear();
    for (int i = 0; i < slots; ++i) {
        const bool dark = i % 6 == 5;
        program.imageOfSlot.push_back(dark ? Program::kDark : static_cast<int>(program.images.size()));
        if (!dark) program.images.push_back(ilf::test::picture(dlpc350::kRaster, seed + static_cast<std::uint32_t>(i)));
    }
    return program;
}

Result<void> DirectLink::answered(UsbAnswer answer) {
    gone_ = gone_ || answer == UsbAnswer::gone;
    if (gone_) return fail(Fault::device, "DLPC350 at 1-2 is gone. Plug it in again.");
    if (answer == UsbAnswer::stall) return fail(Fault::device, "DLPC350 at 1-2 stalled.");
    return {};
}

Result<void> DirectLink::send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds) {
    if (gone_) return answered(UsbAnswer::gone);
    bench_->advance(1'000'000);
    return answered(bench_->board.out(to.address, data, bench_->now_ns()).answer);
}

Result<Bytes> DirectLink::receive(Endpoint from, std::size_t most, Milliseconds limit) {
    if (gone_) return tl::unexpected(answered(UsbAnswer::gone).error());
    Bytes room(most);
    const auto transfer = bench_->board.in(from.address, room, bench_->now_ns());
    if (transfer.answer == UsbAnswer::busy) {
        bench_->advance(std::chrono::nanoseconds(limit).count());
        return fail(Fault::device, "DLPC350 at 1-2 did not answer in time.");
    }
    if (const auto ok = answered(transfer.answer); !ok) return tl::unexpected(ok.error());
    room.resize(transfer.bytes);
    return room;
}

Result<void> DirectLink::clearHalt(Endpoint endpoint) {
    if (gone_) return answered(UsbAnswer::gone);
    bench_->board.clearHalt(endpoint.address, bench_->now_ns());
    return {};
}

}  // namespace ilf::devices::test
